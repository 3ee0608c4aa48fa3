#include "collision/fcl/sphere_tree.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace planbench {
namespace {

/// A small sphere around all balls, by Badoiu and Clarkson's iteration: step towards the farthest
/// ball by 1/(k+1).
Ball Enclose(std::span<const Ball> balls) {
  if (balls.size() == 1) return balls.front();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Ball& ball : balls) center += ball.center;
  center /= static_cast<double>(balls.size());

  Ball best{center, 0};
  constexpr int kIterations = 200;
  for (int k = 0; k < kIterations; ++k) {
    double radius = 0;
    const Ball* farthest = &balls.front();
    for (const Ball& ball : balls) {
      const double reach = (ball.center - center).norm() + ball.radius;
      if (reach > radius) {
        radius = reach;
        farthest = &ball;
      }
    }
    if (k == 0 || radius < best.radius) best = {center, radius};
    center += (farthest->center - center) / (k + 2);
  }
  // The enclosing property must survive rounding.
  best.radius *= 1 + 1e-12;
  return best;
}

}  // namespace

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
  const Ball bound = Enclose(spheres);
  const std::size_t index = nodes_.size();
  nodes_.push_back({bound.center, bound.radius, 0, spheres.size() == 1});
  if (spheres.size() > 1) {
    Eigen::Vector3d low = spheres.front().center;
    Eigen::Vector3d high = low;
    for (const Ball& sphere : spheres) {
      low = low.cwiseMin(sphere.center);
      high = high.cwiseMax(sphere.center);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::stable_sort(spheres.begin(), spheres.end(), [axis](const Ball& a, const Ball& b) {
      return a.center[axis] < b.center[axis];
    });
    Build(spheres.first(spheres.size() / 2));
    Build(spheres.subspan(spheres.size() / 2));
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
