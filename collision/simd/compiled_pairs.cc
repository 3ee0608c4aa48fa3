// Which pairs of trees are compared: those that are not proven never to meet.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <utility>

#include "collision/at.h"
#include "collision/simd/compiled_robot.h"
#include "common/random.h"

namespace planbench {
namespace {

using kernels::Node;

/// What is tried to prove that two trees never meet.
constexpr int kMaxProofJoints = 3;
constexpr int kMaxProofBoxes = 4000;
constexpr std::size_t kMaxProofBalls = 64;  ///< Of a tree of meshes.
constexpr int kNumSamples = 64;             ///< Configurations.

/// What a gate has to save, in tests of pairs.
constexpr double kGateGain = 1.5;

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

}  // namespace

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

std::optional<kernels::Reach> CompiledRobot::AddReachOfPair(const CompiledTree& a,
                                                            const CompiledTree& b) {
  if (!WithinReach(a, b) || !WithinReach(b, a)) return std::nullopt;
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
  return ReachAt(offset);
}

void CompiledRobot::AddPair(const CompiledTree& a, const CompiledTree& b) {
  const std::optional<kernels::Reach> reach = AddReachOfPair(a, b);
  if (!reach) return;
  const std::size_t num_pairs = kernel.pairs.size();
  AddProven(a, b, *reach);
  if (kernel.pairs.size() == num_pairs) {
    kernel.reaches.resize(static_cast<std::size_t>(reach->first));
  }
}

void CompiledRobot::AddAttachedPair(const CompiledTree& other, const CompiledTree& tree) {
  if (const std::optional<kernels::Reach> reach = AddReachOfPair(other, tree)) {
    kernel.pairs.push_back(PairOf(other, tree, *reach));
  }
  // Where their surfaces never meet one may be in the other all the same. Tests of their own, which
  // can be forgotten again.
  std::vector<kernels::InsideTest> tests;
  for (const auto& [of, in] : {std::pair(&other, &tree), std::pair(&tree, &other)}) {
    AddInsideTests(*of, *in, &tests);
  }
  kernel.inside_tests.insert(kernel.inside_tests.end(), tests.begin(), tests.end());
}

kernels::TreePair CompiledRobot::PairOf(const CompiledTree& a, const CompiledTree& b,
                                        const kernels::Reach& reach) const {
  const float radius = At(kernel.nodes, a.root).radius + At(kernel.nodes, b.root).radius;
  return {a.root, b.root, a.body, b.body, a.doubtful || b.doubtful, radius, reach};
}

void CompiledRobot::AddProven(const CompiledTree& a, const CompiledTree& b,
                              const kernels::Reach& reach) {
  const auto weights_at = kernel.reaches.begin() + reach.first;
  const std::vector<float> weights(weights_at, weights_at + kernel.num_joints);
  if (ProvenApart(a, b, weights)) return;
  const CompiledTree* split = nullptr;
  if (ShareTouching(a, b) > 0.5) {
    const Node& node_a = At(kernel.nodes, a.root);
    const Node& node_b = At(kernel.nodes, b.root);
    if (node_a.num_children > 0) split = &a;
    if (node_b.num_children > 0 && (split == nullptr || node_b.radius > node_a.radius)) split = &b;
  }
  if (split == nullptr) {
    kernel.pairs.push_back(PairOf(a, b, reach));
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

double CompiledRobot::ShareTouching(const CompiledTree& a, const CompiledTree& b) const {
  const auto num =
      std::count_if(samples_.begin(), samples_.end(),
                    [&](const std::vector<Pose>& X_WG) { return RootsTouch(a, b, X_WG); });
  return static_cast<double>(num) / kNumSamples;
}

void CompiledRobot::AddPairs(
    const CompiledTree& body_a, const CompiledTree& body_b,
    const std::function<bool(const CompiledTree&, const CompiledTree&)>& checks, double* distance) {
  const bool same = body_a.body == body_b.body;
  const std::size_t first = kernel.pairs.size();
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
      standing.pairs.push_back(PairOf(*a, *b, a->reach));
      AddInsideTests(*a, *b, &standing.inside_tests);
      AddInsideTests(*b, *a, &standing.inside_tests);
    }
  } else if (checks_all) {
    AddLinkPairs(body_a, body_b, pairs);
  } else {
    for (const auto& pair : pairs) AddLinkPairs(*pair.first, *pair.second, {pair});
  }
  if (!same) AddGate(body_a, body_b, first);
}

void CompiledRobot::AddGate(const CompiledTree& a, const CompiledTree& b, std::size_t first) {
  const std::size_t num = kernel.pairs.size() - first;
  if (num == 0) return;
  const std::optional<kernels::Reach> reach = AddReachOfPair(a, b);
  if (!reach) return;
  kernels::TreePair gate = PairOf(a, b, *reach);
  gate.num_behind = static_cast<int>(num);
  if (ShareTouching(a, b) * static_cast<double>(num) + kGateGain > static_cast<double>(num)) {
    gate.table = TableOf(a, b, *reach);
    if (gate.table < 0) return;
  }
  kernel.pairs.insert(kernel.pairs.begin() + static_cast<std::ptrdiff_t>(first), gate);
}

void CompiledRobot::AddLinkPairs(const CompiledTree& a, const CompiledTree& b,
                                 const LinkPairs& links_of) {
  const std::size_t num_pairs = kernel.pairs.size();
  AddPair(a, b);
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
