#include "collision/simd/compiled_robot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "collision/at.h"
#include "robot_model/motion_bound.h"

namespace planbench {
namespace {

using kernels::Node;

/// Motion bounds are rounded to single precision and summed there; this much more than covers it.
constexpr double kBoundFactor = 1 + 1e-5;

/// Node::reach of a ball of balls.
constexpr int kNoReach = -1;

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
  if (meshes_ != nullptr) AddPatches(meshes_->patches);
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
          parts.back().meshes = of_link;
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
      Emit(trees.front(), whole.link, whole.root, 0);
    } else {
      const BallTree tree(std::move(trees));
      for (std::size_t k = 0; k < parts.size(); ++k) {
        parts[k].root = static_cast<int>(kernel.nodes.size() + k);
      }
      Emit(tree, whole.link, whole.root, 0);
      whole.reach_W = rigid_bodies_.Reach(0, i, tree.ball());
    }
    for (CompiledTree& part : parts) {
      part.reach = AddReachOfTree(part.root);
      if (part.meshes != nullptr) AddInsides(*part.meshes, part.root);
    }
    whole.link = -1;
    whole.meshes = nullptr;
    whole.reach = AddReachOfTree(whole.root);
    bodies.push_back(whole);
    links.insert(links.end(), parts.begin(), parts.end());
  }
  ShareArrays();
  std::sort(links.begin(), links.end(),
            [](const CompiledTree& a, const CompiledTree& b) { return a.link < b.link; });
}

void CompiledRobot::ShareArrays() {
  kernel.triangles = triangles_.data();
  kernel.points = points_.data();
}

double CompiledRobot::PaddingOf(const Ball& ball_G, int body) const {
  const Ball reach_W = rigid_bodies_.Reach(0, body, ball_G);
  return PaddingWithin(reach_W.center.norm() + reach_W.radius);
}

void CompiledRobot::Emit(const BallTree& tree, int link, int index, int first_patch) {
  Emit(tree, link, index, first_patch, PaddingOf(tree.ball(), rigid_bodies_.BodyOf(link)));
}

void CompiledRobot::Emit(const BallTree& tree, int link, int index, int first_patch,
                         double padding) {
  const int first = static_cast<int>(kernel.nodes.size());
  const int num = static_cast<int>(tree.children().size());
  // Balls of balls enclose the enlarged ones, and what rounding does to both.
  SetBall(tree.ball(), num == 0 ? padding : 2 * padding, link, index);
  At(kernel.nodes, index).first_child = first;
  At(kernel.nodes, index).num_children = num;
  At(kernel.nodes, index).inner = static_cast<float>(std::max(0.0, tree.inner() - 2 * padding));
  At(kernel.nodes, index).reach = num == 0 ? AddReach(tree.ball(), link) : kNoReach;
  if (tree.patch() >= 0) {
    At(kernel.nodes, index).patch = first_patch + tree.patch();
    AddReach(tree.ball(), link, tree.ball().radius);
  }
  kernel.hulls.resize(kernel.nodes.size());
  const Pose turn{At(R_CG_, rigid_bodies_.BodyOf(link)), Eigen::Vector3d::Zero()};
  At(kernel.hulls, index) = AddHull(tree.hull(), turn, padding);
  kernel.nodes.resize(kernel.nodes.size() + static_cast<std::size_t>(num));
  for (int i = 0; i < num; ++i) Emit(At(tree.children(), i), link, first + i, first_patch, padding);
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

void CompiledRobot::AddPatches(const std::vector<RobotMeshes::Patch>& patches) {
  for (const RobotMeshes::Patch& patch : patches) {
    const Pose X_CL = PoseOfLink(patch.link);
    kernels::Patch& placed = kernel.patches.emplace_back();
    // Triangles reach beyond the patch, and are rounded where their corners are.
    Ball around{Eigen::Vector3d::Zero(), 0};
    for (const RobotMeshes::Group& group : patch.groups) {
      for (const Corners& corners : group.triangles) {
        for (const Eigen::Vector3d& corner : corners) {
          around.radius = std::max(around.radius, (X_CL * corner).norm());
        }
      }
    }
    const double padding = PaddingOf(around, rigid_bodies_.BodyOf(patch.link));
    placed.padding = static_cast<float>(padding);
    placed.boxes = MakeBoxGroup();
    placed.num_groups = static_cast<int>(patch.groups.size());
    Eigen::AlignedBox3d all;
    for (std::size_t g = 0; g < patch.groups.size(); ++g) {
      const auto& [triangles, corners_L, hull] = patch.groups[g];
      placed.hulls[g] = AddHull(hull, X_CL, padding);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& corner : corners_L) box.extend(X_CL * corner);
      SetBox(box, 2 * padding, static_cast<int>(triangles_.size()), g, &placed.boxes);
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
    SetVector(all.sizes() / 2 + Eigen::Vector3d::Constant(3 * padding), placed.box.half_size);
    for (const Eigen::Vector3d& point : patch.points) {
      SetVector(X_CL * point, placed.points.emplace_back().data());
    }
  }
}

kernels::NodeHull CompiledRobot::AddHull(const Hull& hull, const Pose& X_C, double padding) {
  const auto num = static_cast<std::int32_t>(hull.points.size());
  kernels::NodeHull placed;
  placed.first = static_cast<std::int32_t>(points_.size());
  placed.num = (num + kernels::kWide - 1) / kernels::kWide;
  placed.slack = static_cast<float>(hull.slack + padding);
  placed.padding = static_cast<float>(padding);
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

std::vector<std::array<float, 3>> CompiledRobot::PointsOf(const CompiledTree& tree) const {
  std::vector<std::array<float, 3>> points;
  if (tree.meshes != nullptr) {
    const Pose X_CL = PoseOfLink(tree.link);
    for (const Eigen::Vector3d& point : tree.meshes->points) {
      SetVector(X_CL * point, points.emplace_back().data());
    }
    return points;
  }
  for (const int index : NodesBelow(tree.root)) {
    const Node& node = At(kernel.nodes, index);
    if (node.num_children == 0) std::copy_n(node.center, 3, points.emplace_back().data());
  }
  return points;
}

void CompiledRobot::AddInsideTests(const CompiledTree& of, const CompiledTree& in,
                                   std::vector<kernels::InsideTest>* tests) const {
  const Node& around = At(kernel.nodes, in.root);
  if (around.num_insides == 0) return;
  // What is longer than a ball around the meshes is not inside of them.
  if (of.meshes != nullptr && of.meshes->points.size() == 1 &&
      Diameter(of.meshes->tree.hull().points) > 2 * around.radius) {
    return;
  }
  // One test for all links of a body.
  auto test = std::find_if(tests->begin(), tests->end(), [&](const kernels::InsideTest& other) {
    return other.root_in == in.root && other.body_of == of.body && other.doubtful == of.doubtful;
  });
  if (test == tests->end()) {
    test = tests->insert(test, {in.root, in.body, of.body, of.doubtful, {}, {}, 0});
  }
  const auto more = PointsOf(of);
  test->points.insert(test->points.end(), more.begin(), more.end());
  std::vector<Ball> points;
  for (const auto& point : test->points) points.push_back({{point[0], point[1], point[2]}, 0});
  const Ball ball = EnclosingBall(points);
  SetVector(ball.center, test->center);
  test->radius = static_cast<float>(ball.radius + PaddingOf(ball, of.body));
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

CompiledTree CompiledRobot::AddTree(int link, const BallTree& tree_L) {
  CompiledTree tree = EmitAttached(link, tree_L, 0);
  tree.doubtful = true;
  return tree;
}

CompiledTree CompiledRobot::AddTree(const RobotMeshes& meshes) {
  const LinkMeshes& shapes = meshes.links.front();
  const auto first_patch = static_cast<int>(kernel.patches.size());
  AddPatches(meshes.patches);
  CompiledTree tree = EmitAttached(shapes.link, shapes.tree, first_patch);
  tree.meshes = &shapes;
  AddInsides(shapes, tree.root);
  ShareArrays();
  return tree;
}

CompiledTree CompiledRobot::EmitAttached(int link, const BallTree& tree_L, int first_patch) {
  CompiledTree tree;
  tree.link = link;
  tree.body = rigid_bodies_.BodyOf(link);
  tree.root = static_cast<int>(kernel.nodes.size());
  kernel.nodes.emplace_back();
  const BallTree tree_G = tree_L.In(rigid_bodies_.X_GL(link));
  Emit(tree_G, link, tree.root, first_patch);
  tree.reach_W = rigid_bodies_.Reach(0, tree.body, tree_G.ball());
  tree.reach = AddReachOfTree(tree.root);
  return tree;
}

void CompiledRobot::Truncate(const Extent& extent) {
  kernel.nodes.resize(extent.nodes);
  kernel.hulls.resize(extent.nodes);
  kernel.reaches.resize(extent.reaches);
  kernel.pairs.resize(extent.pairs);
  kernel.inside_tests.resize(extent.inside_tests);
  kernel.patches.resize(extent.patches);
  kernel.insides.resize(extent.insides);
  triangles_.resize(extent.triangles);
  points_.resize(extent.points);
  ShareArrays();
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

}  // namespace planbench
