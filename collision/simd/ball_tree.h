#pragma once

#include <vector>

#include "collision/balls.h"

namespace planbench {

/// A tree of balls with few children a node, for testing balls of one part of a robot against the
/// same things: leaves are the given balls.
class BallTree {
 public:
  /// At least one ball. Balls that lie wholly inside another are left out.
  explicit BallTree(std::vector<Ball> balls);
  /// Joins trees under one root.
  explicit BallTree(std::vector<BallTree> children);

  const Ball& ball() const { return ball_; }
  const std::vector<BallTree>& children() const { return children_; }
  /// Levels below and including this one.
  int Depth() const;
  /// The leaves, in tree order.
  std::vector<Ball> Leaves() const;

 private:
  Ball ball_;
  std::vector<BallTree> children_;
};

}  // namespace planbench
