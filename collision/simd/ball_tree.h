#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "collision/balls.h"
#include "collision/rigid_bodies.h"

namespace planbench {

/// A tree of balls with few children a node, for testing balls of one part of a robot against the
/// same things: leaves are the given balls.
class BallTree {
 public:
  /// At least one ball. Balls that lie wholly inside another are left out.
  explicit BallTree(std::vector<Ball> balls);
  /// Joins trees under one root; for the steps see EnclosingBall.
  explicit BallTree(std::vector<BallTree> children, int num_steps = 200);
  /// A leaf that encloses a cluster of triangles, of that index in a list of the caller's.
  BallTree(const Ball& ball, int cluster) : ball_(ball), cluster_(cluster), has_box_(true) {}
  /// Clusters under a ball that encloses them.
  BallTree(const Ball& ball, std::vector<BallTree> children)
      : ball_(ball), has_box_(true), children_(std::move(children)) {}

  /// The tree in a frame A, given in B.
  BallTree In(const Pose& X_AB) const;

  /// Sets how large a ball about the same centre is inside of the body, by `depth(centre)` in m (0
  /// or less: none), of every ball that Leaves() knows and of those above them.
  void SetInner(const std::function<double(const Eigen::Vector3d&)>& depth);

  const Ball& ball() const { return ball_; }
  double inner() const { return inner_; }  ///< A radius, m; 0: nothing is known.
  const std::vector<BallTree>& children() const { return children_; }
  /// Of a leaf; negative for a ball of no cluster.
  int cluster() const { return cluster_; }
  /// True if a box around its clusters tells more than the ball does.
  bool has_box() const { return has_box_; }
  /// Levels below and including this one.
  int Depth() const;
  /// The balls that those above enclose, in tree order: the leaves, and what encloses clusters.
  std::vector<Ball> Leaves() const;

 private:
  BallTree() = default;

  Ball ball_;
  double inner_ = 0;
  int cluster_ = -1;
  bool has_box_ = false;
  std::vector<BallTree> children_;
};

}  // namespace planbench
