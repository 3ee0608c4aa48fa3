#include "collision/simd/compiled_robot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include "collision/at.h"
#include "common/random.h"
#include "robot_model/motion_bound.h"

namespace planbench {
namespace {

using kernels::Node;

/// Motion bounds are rounded to single precision and summed there; this much more than covers it.
constexpr double kBoundFactor = 1 + 1e-5;

/// What is tried to prove that two trees never meet.
constexpr int kMaxProofJoints = 3;
constexpr int kMaxProofBoxes = 4000;
/// Node::reach of a ball of balls.
constexpr int kNoReach = -1;
constexpr std::size_t kMaxProofBalls = 64;  ///< Of a tree of meshes.
constexpr int kNumSamples = 64;             ///< Configurations.

/// `around_a` encloses the balls of A.
double LeastDistance(const Ball& around_a, std::span<const Ball> balls_a, const Pose& X_AB,
                     std::span<const Ball> balls_b) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Ball& b : balls_b) {
    const Eigen::Vector3d center = X_AB * b.center;
    if ((around_a.center - center).norm() - around_a.radius - b.radius >= distance) continue;
    for (const Ball& a : balls_a) {
      distance = std::min(distance, (a.center - center).norm() - a.radius - b.radius);
    }
  }
  return distance;
}

/// A rotation that takes z to `axis` (unit).
Eigen::Matrix3d RotationWithZ(const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

void SetRows(const Eigen::Matrix3d& R, float* rows) {
  for (int i = 0; i < 9; ++i) rows[i] = static_cast<float>(R(i / 3, i % 3));
}

void SetVector(const Eigen::Vector3d& v, float* values) {
  for (int i = 0; i < 3; ++i) values[i] = static_cast<float>(v[i]);
}

}  // namespace

CompiledRobot::CompiledRobot(const Robot& robot, const PlanningGroup& group,
                             std::span<const double> base_positions,
                             const std::vector<LinkSphere>& spheres, const RobotMeshes* meshes)
    : model_(&robot.model),
      group_(&group),
      base_positions_(base_positions.begin(), base_positions.end()),
      rigid_bodies_(robot.model, group, base_positions),
      meshes_(meshes) {
  kernel.num_joints = group.space.size();
  kernel.bodies.resize(static_cast<std::size_t>(rigid_bodies_.size()));
  R_CG_.assign(kernel.bodies.size(), Eigen::Matrix3d::Identity());
  for (int i = 1; i < rigid_bodies_.size(); ++i) {
    const RigidBodies::Mobility mobility = rigid_bodies_.MobilityOf(i);
    kernels::Body& body = At(kernel.bodies, i);
    body.parent = rigid_bodies_.Parent(i);
    body.joint = mobility.group_index;
    body.prismatic = mobility.prismatic;
    const Eigen::Matrix3d& R_PC = At(R_CG_, body.parent);  // parent's frames: G to C
    SetVector(R_PC * mobility.X_PG.translation, body.position);
    SetVector(R_PC * mobility.axis_P, body.axis);
    if (mobility.prismatic) {
      body.turns = At(kernel.bodies, body.parent).turns;
      At(R_CG_, i) = R_PC * mobility.X_PG.rotation;
      continue;
    }
    body.turns = true;
    const Eigen::Vector3d axis_G = mobility.X_PG.rotation.transpose() * mobility.axis_P;
    const Eigen::Matrix3d R_GC = RotationWithZ(axis_G);
    SetRows(R_PC * mobility.X_PG.rotation * R_GC, body.rotation);
    At(R_CG_, i) = R_GC.transpose();
  }

  SamplePoses();
  if (meshes_ != nullptr) {
    AddPatches();
  }
  for (int i = 0; i < rigid_bodies_.size(); ++i) {
    std::vector<BallTree> trees;
    std::vector<CompiledTree> parts;
    const auto add = [&](int link, BallTree tree) {
      CompiledTree part;
      part.link = link;
      part.body = i;
      part.reach_W = rigid_bodies_.Reach(0, i, tree.ball());
      trees.push_back(std::move(tree));
      parts.push_back(part);
    };
    for (int link = 0; link < robot.model.num_links(); ++link) {
      if (rigid_bodies_.BodyOf(link) != i) continue;
      if (meshes_ != nullptr) {
        if (const LinkMeshes* of_link = MeshesOf(link)) {
          add(link, of_link->tree.In(rigid_bodies_.X_GL(link)));
        }
        continue;
      }
      std::vector<Ball> balls;
      for (const LinkSphere& sphere : spheres) {
        if (sphere.link != link) continue;
        balls.push_back({rigid_bodies_.X_GL(link) * sphere.p_LS, sphere.radius});
      }
      if (!balls.empty()) add(link, BallTree(std::move(balls)));
    }
    if (parts.empty()) continue;
    // The trees of a body's links are the children of the body's.
    CompiledTree whole = parts.front();
    whole.root = static_cast<int>(kernel.nodes.size());
    kernel.nodes.emplace_back();
    if (parts.size() == 1) {
      parts.front().root = whole.root;
      Emit(trees.front(), whole.link, whole.root);
    } else {
      const BallTree tree(std::move(trees));
      for (std::size_t k = 0; k < parts.size(); ++k) {
        parts[k].root = static_cast<int>(kernel.nodes.size() + k);
      }
      Emit(tree, whole.link, whole.root);
      whole.reach_W = rigid_bodies_.Reach(0, i, tree.ball());
    }
    for (CompiledTree& part : parts) {
      part.reach = AddReachOfTree(part.root);
      if (meshes_ != nullptr) AddInsides(*MeshesOf(part.link), part.root);
    }
    whole.link = -1;
    whole.reach = AddReachOfTree(whole.root);
    bodies.push_back(whole);
    links.insert(links.end(), parts.begin(), parts.end());
  }
  kernel.triangles = triangles_.data();
  kernel.points = points_.data();
  std::sort(links.begin(), links.end(),
            [](const CompiledTree& a, const CompiledTree& b) { return a.link < b.link; });
}

void CompiledRobot::Emit(const BallTree& tree, int link, int index) {
  const int first = static_cast<int>(kernel.nodes.size());
  const int num = static_cast<int>(tree.children().size());
  // Balls of balls enclose the enlarged ones, and what rounding does to both.
  SetBall(tree.ball(), num == 0 ? kRadiusPadding : 2 * kRadiusPadding, link, index);
  At(kernel.nodes, index).first_child = first;
  At(kernel.nodes, index).num_children = num;
  At(kernel.nodes, index).inner =
      static_cast<float>(std::max(0.0, tree.inner() - 2 * kRadiusPadding));
  At(kernel.nodes, index).reach = num == 0 ? AddReach(tree.ball(), link) : kNoReach;
  if (tree.patch() >= 0) {
    At(kernel.nodes, index).patch = tree.patch();
    AddReach(tree.ball(), link, tree.ball().radius);
  }
  if (meshes_ != nullptr) {
    kernel.hulls.resize(kernel.nodes.size());
    const Pose turn{At(R_CG_, rigid_bodies_.BodyOf(link)), Eigen::Vector3d::Zero()};
    At(kernel.hulls, index) = AddHull(tree.hull(), turn);
  }
  kernel.nodes.resize(kernel.nodes.size() + static_cast<std::size_t>(num));
  for (int i = 0; i < num; ++i) Emit(At(tree.children(), i), link, first + i);
}

void CompiledRobot::SetBall(const Ball& ball_G, double padding, int link, int index) {
  Node& node = At(kernel.nodes, index);
  SetVector(At(R_CG_, rigid_bodies_.BodyOf(link)) * ball_G.center, node.center);
  node.radius = static_cast<float>(ball_G.radius + padding);
}

const LinkMeshes* CompiledRobot::MeshesOf(int link) const {
  const auto found = std::find_if(meshes_->links.begin(), meshes_->links.end(),
                                  [&](const LinkMeshes& meshes) { return meshes.link == link; });
  return found == meshes_->links.end() ? nullptr : &*found;
}

Pose CompiledRobot::PoseOfLink(int link) const {
  const Pose turn{At(R_CG_, rigid_bodies_.BodyOf(link)), Eigen::Vector3d::Zero()};
  return turn * rigid_bodies_.X_GL(link);
}

void CompiledRobot::AddPatches() {
  for (const RobotMeshes::Patch& patch : meshes_->patches) {
    const Pose X_CL = PoseOfLink(patch.link);
    kernels::Patch& placed = kernel.patches.emplace_back();
    placed.boxes = MakeBoxGroup();
    placed.num_groups = static_cast<int>(patch.groups.size());
    Eigen::AlignedBox3d all;
    for (std::size_t g = 0; g < patch.groups.size(); ++g) {
      const auto& [triangles, corners_L, hull] = patch.groups[g];
      placed.hulls[g] = AddHull(hull, X_CL);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& corner : corners_L) box.extend(X_CL * corner);
      SetBox(box, 2 * kRadiusPadding, static_cast<int>(triangles_.size()), g, &placed.boxes);
      all.extend(box);
      kernels::TriangleGroup& group = triangles_.emplace_back();
      group.count = static_cast<std::int32_t>(triangles.size());
      for (std::size_t i = 0; i < static_cast<std::size_t>(kernels::kWide); ++i) {
        // The places that are left repeat the first one.
        Corners corners = triangles[i < triangles.size() ? i : 0];
        for (Eigen::Vector3d& corner : corners) corner = X_CL * corner;
        SetTriangle(corners, i, &group);
      }
    }
    SetVector(all.center(), placed.box.center);
    // The rounding of the center, too.
    SetVector(all.sizes() / 2 + Eigen::Vector3d::Constant(3 * kRadiusPadding),
              placed.box.half_size);
    for (const Eigen::Vector3d& point : patch.points) {
      SetVector(X_CL * point, placed.points.emplace_back().data());
    }
  }
}

kernels::NodeHull CompiledRobot::AddHull(const Hull& hull, const Pose& X_C) {
  const auto num = static_cast<std::int32_t>(hull.points.size());
  kernels::NodeHull placed;
  placed.first = static_cast<std::int32_t>(points_.size());
  placed.num = (num + kernels::kWide - 1) / kernels::kWide;
  placed.slack = static_cast<float>(hull.slack + kRadiusPadding);
  for (std::int32_t i = 0; i < placed.num * kernels::kWide; ++i) {
    if (i % kernels::kWide == 0) points_.emplace_back();
    const Eigen::Vector3d p_C = X_C * At(hull.points, std::min(i, num - 1));
    for (int k = 0; k < 3; ++k) {
      points_.back().p[k][i % kernels::kWide] = static_cast<float>(p_C[k]);
    }
  }
  return placed;
}

void CompiledRobot::AddInsides(const LinkMeshes& link, int root) {
  const Pose X_CL = PoseOfLink(link.link);
  const Pose X_LC = X_CL.Inverse();
  Node& node = At(kernel.nodes, root);
  node.first_inside = static_cast<std::int32_t>(kernel.insides.size());
  node.num_insides = static_cast<std::int32_t>(link.closed.size());
  for (const LinkMeshes::Closed& closed : link.closed) {
    kernels::Inside inside{};
    inside.body = rigid_bodies_.BodyOf(link.link);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : closed.vertices) box.extend(X_CL * vertex);
    SetVector(box.min(), inside.low);
    SetVector(box.max(), inside.high);
    inside.extent = static_cast<float>(box.diagonal().norm());
    inside.mesh = closed.mesh.get();
    for (int i = 0; i < 9; ++i) inside.rotation[i] = X_LC.rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) inside.position[i] = X_LC.translation[i];
    kernel.insides.push_back(inside);
  }
}

void CompiledRobot::AddInsideTests(const CompiledTree& of, const CompiledTree& in,
                                   std::vector<kernels::InsideTest>* tests) const {
  const Node& around = At(kernel.nodes, in.root);
  if (around.num_insides == 0) return;
  // What is longer than a ball around the meshes is not inside of them.
  const LinkMeshes& meshes = *MeshesOf(of.link);
  if (meshes.points.size() == 1 && Diameter(meshes.tree.hull().points) > 2 * around.radius) return;
  // One test for all links of a body.
  auto test = std::find_if(tests->begin(), tests->end(), [&](const kernels::InsideTest& other) {
    return other.root_in == in.root && other.body_of == of.body;
  });
  if (test == tests->end()) {
    test = tests->insert(test, {in.root, in.body, of.body, false, {}, {}, 0});
  }
  const Pose X_CL = PoseOfLink(of.link);
  for (const Eigen::Vector3d& point : meshes.points) {
    SetVector(X_CL * point, test->points.emplace_back().data());
  }
  std::vector<Ball> points;
  for (const auto& point : test->points) points.push_back({{point[0], point[1], point[2]}, 0});
  const Ball ball = EnclosingBall(points);
  SetVector(ball.center, test->center);
  test->radius = static_cast<float>(ball.radius + kRadiusPadding);
}

void CompiledRobot::AddDoubtfulInside(const CompiledTree& link, const CompiledTree& ball) {
  if (At(kernel.nodes, link.root).num_insides == 0) return;
  const float* center = At(kernel.nodes, ball.root).center;
  const std::array<float, 3> point = {center[0], center[1], center[2]};
  kernel.inside_tests.push_back({link.root,
                                 link.body,
                                 ball.body,
                                 true,
                                 {point},
                                 {point[0], point[1], point[2]},
                                 kRadiusPadding});
}

int CompiledRobot::AddReach(const Ball& ball_G, int link, double radius) {
  const LinkSphere center{link, rigid_bodies_.X_GL(link).InverseTimes(ball_G.center), radius};
  const MotionBound bound(*model_, *group_, base_positions_, {&center, 1});
  const int offset = static_cast<int>(kernel.reaches.size());
  for (double reach : bound.reach()) {
    kernel.reaches.push_back(static_cast<float>(reach * kBoundFactor));
  }
  return offset;
}

kernels::Reach CompiledRobot::AddReachOfTree(int root) {
  const int offset = static_cast<int>(kernel.reaches.size());
  kernel.reaches.resize(kernel.reaches.size() + ReachSize(), 0.0f);
  for (const int index : NodesBelow(root)) {
    const Node& node = At(kernel.nodes, index);
    if (node.reach == kNoReach) continue;
    for (int k = 0; k < static_cast<int>(ReachSize()); ++k) {
      const bool of_points = k >= kernel.num_joints;
      const int own = of_points && node.patch < 0 ? k - kernel.num_joints : k;
      float& reach = At(kernel.reaches, offset + k);
      reach = std::max(reach, At(kernel.reaches, node.reach + own));
    }
  }
  return ReachAt(offset);
}

kernels::Reach CompiledRobot::ReachAt(int first) const {
  kernels::Reach reach{first, kernel.num_joints, 0, 0};
  for (int k = 0; k < static_cast<int>(ReachSize()); ++k) {
    const float weight = At(kernel.reaches, first + k);
    if (weight == 0) continue;
    if (k < kernel.num_joints) reach.most = std::max(reach.most, weight);
    const int joint = k % kernel.num_joints;
    reach.begin = std::min(reach.begin, joint);
    reach.end = std::max(reach.end, joint + 1);
  }
  reach.begin = std::min(reach.begin, reach.end);
  return reach;
}

std::size_t CompiledRobot::ReachSize() const {
  return static_cast<std::size_t>(meshes_ != nullptr ? 2 * kernel.num_joints : kernel.num_joints);
}

CompiledTree CompiledRobot::AddBall(int link, const Ball& ball_L) {
  CompiledTree tree;
  tree.link = link;
  tree.body = rigid_bodies_.BodyOf(link);
  tree.root = static_cast<int>(kernel.nodes.size());
  const Ball ball_G{rigid_bodies_.X_GL(link) * ball_L.center, ball_L.radius};
  const int reach = AddReach(ball_G, link);
  tree.reach_W = rigid_bodies_.Reach(0, tree.body, ball_G);
  kernel.nodes.emplace_back().reach = reach;
  // Attached objects are told from others by their balls alone, and have no points.
  if (meshes_ != nullptr) {
    kernel.reaches.resize(kernel.reaches.size() + static_cast<std::size_t>(kernel.num_joints));
    kernel.hulls.emplace_back();
  }
  tree.reach = ReachAt(reach);
  SetBall(ball_G, kRadiusPadding, link, tree.root);
  return tree;
}

void CompiledRobot::Truncate(const Extent& extent) {
  kernel.nodes.resize(extent.nodes);
  if (meshes_ != nullptr) kernel.hulls.resize(extent.nodes);
  kernel.reaches.resize(extent.reaches);
  kernel.pairs.resize(extent.pairs);
  kernel.inside_tests.resize(extent.inside_tests);
}

Ball CompiledRobot::BallOf(const Node& node, int body) const {
  const Eigen::Vector3d p_C(node.center[0], node.center[1], node.center[2]);
  return {At(R_CG_, body).transpose() * p_C, node.radius};
}

Ball CompiledRobot::RootBall(const CompiledTree& tree) const {
  return BallOf(At(kernel.nodes, tree.root), tree.body);
}

std::vector<int> CompiledRobot::NodesBelow(int root) const {
  std::vector<int> nodes = {root};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = At(kernel.nodes, nodes[i]);
    for (int k = 0; k < node.num_children; ++k) nodes.push_back(node.first_child + k);
  }
  return nodes;
}

std::vector<Ball> CompiledRobot::BallsOf(const CompiledTree& tree) const {
  std::vector<int> nodes = {tree.root};
  for (std::size_t i = 0; i < nodes.size();) {
    const Node& node = At(kernel.nodes, nodes[i]);
    if (node.num_children == 0 || (meshes_ != nullptr && nodes.size() >= kMaxProofBalls)) {
      ++i;
      continue;
    }
    nodes[i] = node.first_child;
    for (int k = 1; k < node.num_children; ++k) nodes.push_back(node.first_child + k);
  }
  std::vector<Ball> balls;
  for (const int node : nodes) balls.push_back(BallOf(At(kernel.nodes, node), tree.body));
  return balls;
}

bool CompiledRobot::WithinReach(const CompiledTree& carrier, const CompiledTree& moving) const {
  if (!rigid_bodies_.Descends(moving.body, carrier.body)) return true;
  const std::vector<Ball> fixed = BallsOf(carrier);
  for (const Ball& leaf : BallsOf(moving)) {
    const Ball reach = rigid_bodies_.Reach(carrier.body, moving.body, leaf);
    for (const Ball& ball : fixed) {
      if ((ball.center - reach.center).norm() - kRadiusPadding <= ball.radius + reach.radius) {
        return true;
      }
    }
  }
  return false;
}

bool CompiledRobot::ProvenApart(const CompiledTree& a, const CompiledTree& b,
                                std::span<const float> reach) const {
  struct Box {
    std::vector<double> center, half_width;
  };
  Box all{std::vector<double>(reach.size(), 0.0), std::vector<double>(reach.size(), 0.0)};
  int num_joints = 0;
  for (std::size_t j = 0; j < reach.size(); ++j) {
    if (reach[j] == 0) continue;
    ++num_joints;
    const JointSpace::Joint& joint = group_->space.joint(static_cast<int>(j));
    all.center[j] = (joint.lower + joint.upper) / 2;
    all.half_width[j] = (joint.upper - joint.lower) / 2 + JointSpace::kLimitTolerance;
  }
  if (num_joints > kMaxProofJoints) return false;

  const std::vector<Ball> balls_a = BallsOf(a);
  const std::vector<Ball> balls_b = BallsOf(b);
  const Ball around_a = RootBall(a);
  const auto touch = [&](const std::vector<Pose>& X_WG) {
    return RootsTouch(a, b, X_WG) &&
           LeastDistance(around_a, balls_a, At(X_WG, a.body).Inverse() * At(X_WG, b.body),
                         balls_b) <= 0;
  };
  // Most of what does meet is told by the samples, before any box is tried.
  if (std::any_of(samples_.begin(), samples_.end(), touch)) return false;
  std::vector<Pose> X_WG(static_cast<std::size_t>(rigid_bodies_.size()));
  std::vector<Box> open = {all};
  for (int i = 0; i < kMaxProofBoxes && !open.empty(); ++i) {
    const Box box = std::move(open.back());
    open.pop_back();
    rigid_bodies_.ComputePoses(box.center, X_WG);
    const double distance =
        LeastDistance(around_a, balls_a, At(X_WG, a.body).Inverse() * At(X_WG, b.body), balls_b);
    if (distance <= 0) return false;
    double motion = 0;
    std::size_t widest = 0;
    for (std::size_t j = 0; j < reach.size(); ++j) {
      motion += reach[j] * box.half_width[j];
      if (reach[j] * box.half_width[j] > reach[widest] * box.half_width[widest]) widest = j;
    }
    if (motion < distance) continue;
    for (const double side : {-0.5, 0.5}) {
      open.push_back(box);
      open.back().center[widest] += side * box.half_width[widest];
      open.back().half_width[widest] /= 2;
    }
  }
  return open.empty();
}

void CompiledRobot::AddPair(const CompiledTree& a, const CompiledTree& b, bool doubtful) {
  if (!WithinReach(a, b) || !WithinReach(b, a)) return;
  const int offset = static_cast<int>(kernel.reaches.size());
  kernel.reaches.resize(kernel.reaches.size() + ReachSize(), 0.0f);
  // The joints between each and the nearest body that carries both.
  for (const auto& [tree, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const int joint : rigid_bodies_.JointsBelowCommon(tree->body, other->body)) {
      for (int k = joint; k < static_cast<int>(ReachSize()); k += kernel.num_joints) {
        At(kernel.reaches, offset + k) = At(kernel.reaches, tree->reach.first + k);
      }
    }
  }
  const std::size_t num_pairs = kernel.pairs.size();
  const kernels::Reach reach = ReachAt(offset);
  if (doubtful) {
    kernel.pairs.push_back(PairOf(a, b, true, reach));
  } else {
    AddProven(a, b, reach);
  }
  if (kernel.pairs.size() == num_pairs) kernel.reaches.resize(static_cast<std::size_t>(offset));
}

kernels::TreePair CompiledRobot::PairOf(const CompiledTree& a, const CompiledTree& b, bool doubtful,
                                        const kernels::Reach& reach) const {
  const float radius = At(kernel.nodes, a.root).radius + At(kernel.nodes, b.root).radius;
  return {a.root, b.root, a.body, b.body, doubtful, radius, reach};
}

void CompiledRobot::AddProven(const CompiledTree& a, const CompiledTree& b,
                              const kernels::Reach& reach) {
  const auto weights_at = kernel.reaches.begin() + reach.first;
  const std::vector<float> weights(weights_at, weights_at + kernel.num_joints);
  if (ProvenApart(a, b, weights)) return;
  const CompiledTree* split = nullptr;
  if (UsuallyTouch(a, b)) {
    const Node& node_a = At(kernel.nodes, a.root);
    const Node& node_b = At(kernel.nodes, b.root);
    if (node_a.num_children > 0) split = &a;
    if (node_b.num_children > 0 && (split == nullptr || node_b.radius > node_a.radius)) split = &b;
  }
  if (split == nullptr) {
    kernel.pairs.push_back(PairOf(a, b, false, reach));
    return;
  }
  // A test of roots that always touch tells nothing, and some of what is below may be apart for
  // good.
  const int first = At(kernel.nodes, split->root).first_child;
  const int num = At(kernel.nodes, split->root).num_children;
  for (int i = 0; i < num; ++i) {
    CompiledTree child = *split;
    child.root = first + i;
    AddProven(child, split == &a ? b : a, reach);
  }
}

void CompiledRobot::SamplePoses() {
  std::mt19937_64 generator(1);
  std::vector<double> q(static_cast<std::size_t>(group_->space.size()));
  for (int i = 0; i < kNumSamples; ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      const JointSpace::Joint& joint = group_->space.joint(static_cast<int>(j));
      q[j] = joint.lower + UniformFraction(&generator) * (joint.upper - joint.lower);
    }
    rigid_bodies_.ComputePoses(
        q, samples_.emplace_back(static_cast<std::size_t>(rigid_bodies_.size())));
  }
}

bool CompiledRobot::RootsTouch(const CompiledTree& a, const CompiledTree& b,
                               const std::vector<Pose>& X_WG) const {
  const Ball ball_a = RootBall(a);
  const Ball ball_b = RootBall(b);
  return (At(X_WG, a.body) * ball_a.center - At(X_WG, b.body) * ball_b.center).norm() <=
         ball_a.radius + ball_b.radius;
}

bool CompiledRobot::UsuallyTouch(const CompiledTree& a, const CompiledTree& b) const {
  return std::count_if(samples_.begin(), samples_.end(), [&](const std::vector<Pose>& X_WG) {
           return RootsTouch(a, b, X_WG);
         }) > kNumSamples / 2;
}

void CompiledRobot::AddPairs(
    const CompiledTree& body_a, const CompiledTree& body_b,
    const std::function<bool(const CompiledTree&, const CompiledTree&)>& checks, double* distance) {
  const bool same = body_a.body == body_b.body;
  std::vector<const CompiledTree*> links_b;
  for (const CompiledTree& link : links) {
    if (link.body == body_b.body) links_b.push_back(&link);
  }
  bool checks_all = true;
  LinkPairs pairs;
  for (const CompiledTree& a : links) {
    if (a.body != body_a.body) continue;
    std::size_t num_checked = 0;
    for (const CompiledTree* b : links_b) {
      if ((same && b->link <= a.link) || !checks(a, *b)) continue;
      pairs.emplace_back(&a, b);
      ++num_checked;
    }
    if (num_checked < links_b.size()) {
      checks_all = false;
    } else {
      // All of the other body's links: its own tree serves.
      pairs.resize(pairs.size() - num_checked);
      pairs.emplace_back(&a, &body_b);
    }
  }
  if (same) {
    for (const auto& [a, b] : pairs) {
      *distance =
          std::min(*distance, LeastDistance(RootBall(*a), BallsOf(*a), Pose(), BallsOf(*b)));
      if (meshes_ == nullptr) continue;
      standing.pairs.push_back(PairOf(*a, *b, false, a->reach));
      AddInsideTests(*a, *b, &standing.inside_tests);
      AddInsideTests(*b, *a, &standing.inside_tests);
    }
  } else if (checks_all) {
    AddLinkPairs(body_a, body_b, pairs);
  } else {
    for (const auto& pair : pairs) AddLinkPairs(*pair.first, *pair.second, {pair});
  }
}

void CompiledRobot::AddLinkPairs(const CompiledTree& a, const CompiledTree& b,
                                 const LinkPairs& links_of) {
  const std::size_t num_pairs = kernel.pairs.size();
  AddPair(a, b, false);
  if (meshes_ == nullptr) return;
  // Where their surfaces never meet one is in the other always or never.
  auto* tests = kernel.pairs.size() > num_pairs ? &kernel.inside_tests : &standing.inside_tests;
  for (const auto& [link_a, others] : links_of) {
    for (const CompiledTree& link_b : links) {
      const bool is_other =
          others->link < 0 ? link_b.body == others->body : link_b.link == others->link;
      if (!is_other) continue;
      AddInsideTests(*link_a, link_b, tests);
      AddInsideTests(link_b, *link_a, tests);
    }
  }
}

}  // namespace planbench
