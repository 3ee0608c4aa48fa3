#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "collision/rigid_bodies.h"

namespace planbench {

/// Bounding-sphere hierarchy over the spheres of one link. Nodes stand in depth-first order, each
/// with the index of the node that follows its subtree, so that a query is a plain loop without a
/// stack.
class SphereTree {
 public:
  struct Node {
    Eigen::Vector3d center;  ///< m, in the frame the spheres were given in
    double radius;           ///< m
    int next;                ///< Index of the first node behind this subtree.
    bool leaf;               ///< One of the given spheres; otherwise encloses all of its subtree.
  };
  SphereTree() = default;
  explicit SphereTree(std::vector<Ball> spheres);

  /// The same spheres in another frame A.
  SphereTree Transformed(const Pose& X_AS) const;

  std::span<const Node> nodes() const { return nodes_; }
  int num_spheres() const { return (static_cast<int>(nodes_.size()) + 1) / 2; }
  /// Bounding box of all spheres.
  const Eigen::Vector3d& box_center() const { return box_center_; }
  const Eigen::Vector3d& box_half_size() const { return box_half_size_; }

  /// True if the ball touches one of the spheres.
  bool Touches(const Eigen::Vector3d& center, double radius) const;
  /// Smaller of `at_most` and the signed distance between the ball and the nearest (deepest)
  /// sphere.
  double Distance(const Eigen::Vector3d& center, double radius, double at_most) const;

 private:
  void Build(std::span<Ball> spheres);
  void ComputeBox();

  std::vector<Node> nodes_;
  Eigen::Vector3d box_center_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_half_size_ = Eigen::Vector3d::Zero();
};

inline bool SphereTree::Touches(const Eigen::Vector3d& center, double radius) const {
  const int end = static_cast<int>(nodes_.size());
  for (int i = 0; i < end;) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const double reach = node.radius + radius;
    if ((node.center - center).squaredNorm() > reach * reach) {
      i = node.next;
    } else if (node.leaf) {
      return true;
    } else {
      ++i;
    }
  }
  return false;
}

}  // namespace planbench
