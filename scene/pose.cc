#include "scene/pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace planbench {
namespace {

using Components = std::array<double, 4>;  // w, x, y, z

// Signs below this size are rounding noise of the conversion (about 1e-16 each).
constexpr double kSignThreshold = 1e-9;

Eigen::Quaterniond FromComponents(const Components& q) { return {q[0], q[1], q[2], q[3]}; }

Eigen::Matrix3d RotationOf(const Eigen::Quaterniond& q) {
  return q.normalized().toRotationMatrix();
}

Components CanonicalQuaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  Components components = {q.w(), q.x(), q.y(), q.z()};
  const auto leading = std::find_if(components.begin(), components.end(), [](double component) {
    return std::abs(component) > kSignThreshold;
  });
  const double sign = leading != components.end() && *leading < 0 ? -1.0 : 1.0;
  for (double& component : components) component = sign * component + 0.0;  // No -0.0.
  return components;
}

}  // namespace

Eigen::Isometry3d PoseFromPositionOrientation(const Eigen::Vector3d& position,
                                              const Eigen::Quaterniond& orientation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = RotationOf(orientation);
  pose.translation() = position;
  return pose;
}

Eigen::Quaterniond OrientationOf(const Eigen::Isometry3d& pose) {
  std::vector<Components> visited = {CanonicalQuaternion(pose.linear())};
  while (true) {
    const Components next = CanonicalQuaternion(RotationOf(FromComponents(visited.back())));
    const auto circle = std::find(visited.begin(), visited.end(), next);
    // Ends: the orbit stays within a few last bits of where it started, so it must meet itself.
    if (circle != visited.end()) return FromComponents(*std::min_element(circle, visited.end()));
    visited.push_back(next);
  }
}

}  // namespace planbench
