#include "collision/fcl/sphere_tree.h"

#include <Eigen/Geometry>

namespace planbench {
SphereTree::SphereTree(std::vector<Ball> spheres) {
  if (spheres.empty()) return;
  nodes_.reserve(2 * spheres.size() - 1);
  Build(spheres);
  ComputeBox();
}

SphereTree SphereTree::Transformed(const Pose& X_AS) const {
  SphereTree moved = *this;
  for (Node& node : moved.nodes_) node.center = X_AS * node.center;
  moved.ComputeBox();
  return moved;
}

void SphereTree::ComputeBox() {
  Eigen::AlignedBox3d box;
  for (const Node& node : nodes_) {
    if (!node.leaf) continue;
    box.extend((node.center.array() - node.radius).matrix());
    box.extend((node.center.array() + node.radius).matrix());
  }
  box_center_ = box.center();
  box_half_size_ = box.sizes() / 2;
}

void SphereTree::Build(std::span<Ball> spheres) {
  Ball bound = spheres.front();
  if (spheres.size() > 1) {
    bound = EnclosingBall(spheres);
    bound.radius *= 1 + 1e-12;  // what is enclosed must stay so when rounded
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back({bound.center, bound.radius, 0, spheres.size() == 1});
  if (spheres.size() > 1) {
    const std::size_t half = Halve(spheres);
    Build(spheres.first(half));
    Build(spheres.subspan(half));
  }
  nodes_[index].next = static_cast<int>(nodes_.size());
}

double SphereTree::Distance(const Eigen::Vector3d& center, double radius, double at_most) const {
  double best = at_most;
  const int end = static_cast<int>(nodes_.size());
  for (int i = 0; i < end;) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const double distance = (node.center - center).norm() - node.radius - radius;
    if (distance >= best) {
      i = node.next;
    } else {
      if (node.leaf) best = distance;
      ++i;
    }
  }
  return best;
}

}  // namespace planbench
