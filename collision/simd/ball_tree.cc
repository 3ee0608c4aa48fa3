#include "collision/simd/ball_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace planbench {
namespace {

/// So many children a node has at most. Wider trees test more balls, deeper ones enclose more
/// often.
constexpr std::size_t kMaxChildren = 4;

Ball Enclosing(const std::vector<BallTree>& children) {
  std::vector<Ball> balls;
  for (const BallTree& child : children) {
    for (const Ball& leaf : child.Leaves()) balls.push_back(leaf);
  }
  return EnclosingBall(balls);
}

/// Cuts balls in two across the longest extent of their centres, at the middle ball.
std::pair<std::vector<Ball>, std::vector<Ball>> Halve(std::vector<Ball> balls) {
  Eigen::Vector3d low = balls.front().center;
  Eigen::Vector3d high = low;
  for (const Ball& ball : balls) {
    low = low.cwiseMin(ball.center);
    high = high.cwiseMax(ball.center);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::stable_sort(balls.begin(), balls.end(), [axis](const Ball& a, const Ball& b) {
    return a.center[axis] < b.center[axis];
  });
  const auto middle = balls.begin() + static_cast<std::ptrdiff_t>(balls.size() / 2);
  return {std::vector<Ball>(balls.begin(), middle), std::vector<Ball>(middle, balls.end())};
}

/// Cuts balls into up to kMaxChildren groups, always the group with the largest enclosing ball.
std::vector<std::vector<Ball>> Partition(std::vector<Ball> balls) {
  std::vector<std::vector<Ball>> groups = {std::move(balls)};
  while (groups.size() < kMaxChildren) {
    auto largest = groups.end();
    double radius = 0;
    for (auto group = groups.begin(); group != groups.end(); ++group) {
      if (group->size() < 2) continue;
      const double r = EnclosingBall(*group).radius;
      if (largest == groups.end() || r > radius) {
        largest = group;
        radius = r;
      }
    }
    if (largest == groups.end()) break;
    auto [first, second] = Halve(std::move(*largest));
    *largest = std::move(first);
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

Ball EnclosingBall(std::span<const Ball> balls) {
  Ball enclosing = balls.front();
  const auto farthest = [&](const Eigen::Vector3d& center) {
    return std::max_element(balls.begin(), balls.end(), [&](const Ball& a, const Ball& b) {
      return (a.center - center).norm() + a.radius < (b.center - center).norm() + b.radius;
    });
  };
  Eigen::Vector3d center = enclosing.center;
  enclosing.radius = -1;
  for (int i = 0; i < 200; ++i) {
    const Ball& far = *farthest(center);
    const Eigen::Vector3d to_far = far.center - center;
    const double distance = to_far.norm();
    const double radius = distance + far.radius;
    if (enclosing.radius < 0 || radius < enclosing.radius) enclosing = {center, radius};
    if (distance < 1e-12) break;
    // Towards the far side of the farthest ball.
    center += to_far * (radius / distance / (i + 2));
  }
  return enclosing;
}

BallTree::BallTree(std::vector<Ball> balls) {
  balls = WithoutCovered(std::move(balls));
  ball_ = EnclosingBall(balls);
  if (balls.size() == 1) {
    ball_ = balls.front();
    return;
  }
  for (std::vector<Ball>& group : Partition(std::move(balls))) {
    children_.emplace_back(std::move(group));
  }
}

BallTree::BallTree(std::vector<BallTree> children) : children_(std::move(children)) {
  ball_ = Enclosing(children_);
}

int BallTree::Depth() const {
  int depth = 0;
  for (const BallTree& child : children_) depth = std::max(depth, child.Depth());
  return depth + 1;
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
