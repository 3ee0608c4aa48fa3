#include "scene/pose.h"

#include <algorithm>
#include <cmath>

namespace planbench {
namespace {

constexpr double kStepsPerUnit = 1099511627776.0;  // 2^40

// Components nearer to the largest than this count as equal to it, so that noise in the last bits
// does not choose between the equal components of, say, a quarter turn.
constexpr double kTieTolerance = 1e-6;

}  // namespace

Eigen::Isometry3d PoseFromPositionOrientation(const Eigen::Vector3d& position,
                                              const Eigen::Quaterniond& orientation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = orientation.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

std::array<std::int64_t, 4> OrientationSteps(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const std::array<double, 4> components = {q.w(), q.x(), q.y(), q.z()};
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  const double reference = *std::find_if(
      components.begin(), components.end(),
      [&](double component) { return std::abs(component) >= (1 - kTieTolerance) * largest; });
  std::array<std::int64_t, 4> steps;
  std::transform(components.begin(), components.end(), steps.begin(), [&](double component) {
    return static_cast<std::int64_t>(std::llround(component / reference * kStepsPerUnit));
  });
  return steps;
}

Eigen::Quaterniond OrientationOf(const Eigen::Isometry3d& pose) {
  const std::array<std::int64_t, 4> steps = OrientationSteps(pose);
  // Whole numbers up to about 2^40: exact as doubles.
  return Eigen::Quaterniond(static_cast<double>(steps[0]), static_cast<double>(steps[1]),
                            static_cast<double>(steps[2]), static_cast<double>(steps[3]))
      .normalized();
}

Eigen::Isometry3d CanonicalPose(const Eigen::Isometry3d& pose) {
  return PoseFromPositionOrientation(pose.translation(), OrientationOf(pose));
}

}  // namespace planbench
