#include "collision/simd/ball_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace planbench {
namespace {

/// So many children a node has at most. Wider trees test more balls, deeper ones enclose more
/// often.
constexpr std::size_t kMaxChildren = 4;

Ball Enclosing(const std::vector<BallTree>& children, int num_steps) {
  std::vector<Ball> balls;
  for (const BallTree& child : children) {
    for (const Ball& leaf : child.Leaves()) balls.push_back(leaf);
  }
  return EnclosingBall(balls, num_steps);
}

/// Cuts balls into up to kMaxChildren groups, always the group with the largest enclosing ball.
std::vector<std::vector<Ball>> Partition(std::vector<Ball> balls, int num_steps) {
  std::vector<std::vector<Ball>> groups = {std::move(balls)};
  while (groups.size() < kMaxChildren) {
    auto largest = groups.end();
    double radius = 0;
    for (auto group = groups.begin(); group != groups.end(); ++group) {
      if (group->size() < 2) continue;
      const double r = EnclosingBall(*group, num_steps).radius;
      if (largest == groups.end() || r > radius) {
        largest = group;
        radius = r;
      }
    }
    if (largest == groups.end()) break;
    const auto middle = largest->begin() + static_cast<std::ptrdiff_t>(Halve(*largest));
    std::vector<Ball> second(middle, largest->end());
    largest->erase(middle, largest->end());
    groups.push_back(std::move(second));
  }
  return groups;
}

std::vector<Ball> WithoutCovered(std::vector<Ball> balls) {
  std::stable_sort(balls.begin(), balls.end(),
                   [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
  std::vector<Ball> kept;
  for (const Ball& ball : balls) {
    const bool covered = std::any_of(kept.begin(), kept.end(), [&](const Ball& large) {
      return (large.center - ball.center).norm() + ball.radius <= large.radius;
    });
    if (!covered) kept.push_back(ball);
  }
  return kept;
}

}  // namespace

BallTree::BallTree(std::vector<Ball> balls, int num_steps) {
  balls = WithoutCovered(std::move(balls));
  ball_ = EnclosingBall(balls, num_steps);
  if (balls.size() == 1) {
    ball_ = balls.front();
    return;
  }
  for (std::vector<Ball>& group : Partition(std::move(balls), num_steps)) {
    children_.push_back(BallTree(std::move(group), num_steps));
  }
}

BallTree::BallTree(std::vector<BallTree> children, int num_steps) : children_(std::move(children)) {
  ball_ = Enclosing(children_, num_steps);
}

BallTree BallTree::In(const Pose& X_AB) const {
  BallTree tree = *this;
  tree.ball_.center = X_AB * ball_.center;
  for (Eigen::Vector3d& point : tree.hull_.points) point = X_AB * point;
  for (BallTree& child : tree.children_) child = child.In(X_AB);
  return tree;
}

void BallTree::SetInner(const std::function<double(const Eigen::Vector3d&)>& depth) {
  inner_ = std::max(0.0, depth(ball_.center));
  for (BallTree& child : children_) child.SetInner(depth);
}

void BallTree::SetHulls(std::size_t most) {
  double slack = hull_.slack;
  std::vector<Eigen::Vector3d> points = std::move(hull_.points);
  bool all = patch_ >= 0 || !children_.empty();
  for (BallTree& child : children_) {
    child.SetHulls(most);
    all = all && !child.hull_.points.empty();
    points.insert(points.end(), child.hull_.points.begin(), child.hull_.points.end());
    slack = std::max(slack, child.hull_.slack);
  }
  hull_ = all ? MakeHull(std::move(points), most) : Hull();
  hull_.slack += slack;
}

std::vector<Ball> BallTree::Leaves() const {
  if (children_.empty()) return {ball_};
  std::vector<Ball> leaves;
  for (const BallTree& child : children_) {
    for (const Ball& leaf : child.Leaves()) leaves.push_back(leaf);
  }
  return leaves;
}

}  // namespace planbench
