#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "planner_rrtc/flat_joints.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// A tree of configurations in flat arrays, with nearest neighbours: nodes are numbered in the
/// order in which they are added; their positions stand node by node as doubles, and once more as
/// floats in blocks, for a vectorised scan of all nodes. Memory is kept from one search to the
/// next.
///
/// Positions of continuous joints must be in [-pi, pi].
class NodeTree {
 public:
  static constexpr int kNoParent = -1;

  struct Neighbor {
    int node = -1;
    double distance = 0;  ///< In the metric.
  };

  explicit NodeTree(const JointSpace& space) : NodeTree(FlatJoints(space), space) {}
  /// With the metric of `flat`, of the same space.
  NodeTree(FlatJoints flat, const JointSpace& space);

  void Clear();
  /// Adds a copy of `q`; returns its number. `q` must not be a node's own positions.
  int Add(std::span<const double> q, int parent);
  int size() const { return static_cast<int>(parents_.size()); }
  const double* Positions(int node) const {
    return positions_.data() + static_cast<std::size_t>(node) * order_.size();
  }
  int Parent(int node) const { return parents_[static_cast<std::size_t>(node)]; }
  /// The node nearest to `q`, in single precision; of several at the same distance, the one added
  /// first. The tree must not be empty.
  Neighbor Nearest(const double* q) const;

 private:
  FlatJoints flat_;
  /// The joints in the order of the blocks.
  std::vector<std::size_t> order_;
  std::size_t num_bounded_ = 0;
  std::vector<double> positions_;
  std::vector<int> parents_;
  std::vector<float> blocks_;
  mutable std::vector<float> query_;  // scratch
};

}  // namespace planbench
