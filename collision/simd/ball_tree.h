#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "collision/balls.h"
#include "collision/rigid_bodies.h"
#include "collision/simd/hull.h"

namespace planbench {

/// A tree of balls with few children a node, for testing balls of one part of a robot against the
/// same things: leaves are the given balls.
class BallTree {
 public:
  /// At least one ball. Balls that lie wholly inside another are left out. For the steps see
  /// EnclosingBall.
  explicit BallTree(std::vector<Ball> balls, int num_steps = 200);
  /// Joins trees under one root.
  explicit BallTree(std::vector<BallTree> children, int num_steps = 200);
  /// A leaf that encloses a patch of a surface, of that index in a list of the caller's, and those
  /// points of it.
  BallTree(const Ball& ball, int patch, Hull hull)
      : ball_(ball), patch_(patch), hull_(std::move(hull)) {}
  /// Trees under a ball that encloses them.
  BallTree(const Ball& ball, std::vector<BallTree> children)
      : ball_(ball), children_(std::move(children)) {}

  /// The tree in a frame A, given in B.
  BallTree In(const Pose& X_AB) const;
  /// Puts a ball that encloses the same in the place of the root's, unless it is larger.
  void Replace(const Ball& ball) {
    if (ball.radius < ball_.radius) ball_ = ball;
  }
  /// Sets how large a ball about the same centre is inside of the body, by `depth(centre)` in m (0
  /// or less: none), of every ball.
  void SetInner(const std::function<double(const Eigen::Vector3d&)>& depth);
  /// Gives the balls of patches a hull of what is in them, of at most so many points.
  void SetHulls(std::size_t most);

  const Ball& ball() const { return ball_; }
  double inner() const { return inner_; }  ///< A radius, m; 0: nothing is known.
  const std::vector<BallTree>& children() const { return children_; }
  /// Of a leaf; negative for a ball of no patch.
  int patch() const { return patch_; }
  /// Of what is below; of no points where there are but balls.
  const Hull& hull() const { return hull_; }
  /// In tree order.
  std::vector<Ball> Leaves() const;

 private:
  BallTree() = default;

  Ball ball_;
  double inner_ = 0;
  int patch_ = -1;
  Hull hull_;
  std::vector<BallTree> children_;
};

}  // namespace planbench
