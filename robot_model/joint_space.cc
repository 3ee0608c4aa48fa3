#include "robot_model/joint_space.h"

#include <cmath>

#include "common/numbers.h"

namespace planbench {
namespace {

// `angle` in [-pi, pi]. The first branches give what std::remainder gives (the differences are
// exact), in a fraction of its time; they are the ones taken by positions that are themselves
// wrapped.
double ShortWay(double angle) {
  if (std::abs(angle) <= kPi) return angle;
  if (std::abs(angle) <= 3 * kPi) return angle > 0 ? angle - 2 * kPi : angle + 2 * kPi;
  return std::remainder(angle, 2 * kPi);
}

}  // namespace

double WrapAngle(double angle) {
  const double wrapped = ShortWay(angle);
  return wrapped >= kPi ? -kPi : wrapped;
}

int JointSpace::Find(const std::string& name) const {
  for (int j = 0; j < size(); ++j) {
    if (joint(j).name == name) return j;
  }
  return -1;
}

double JointSpace::Difference(int j, double from, double to) const {
  return joint(j).continuous ? ShortWay(to - from) : to - from;
}

double JointSpace::Distance(std::span<const double> from, std::span<const double> to) const {
  double sum = 0;
  for (int j = 0; j < size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double difference = Difference(j, from[i], to[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

void JointSpace::Interpolate(std::span<const double> from, std::span<const double> to, double t,
                             std::span<double> out) const {
  for (int j = 0; j < size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (t == 0) {
      out[i] = from[i];
    } else if (t == 1) {
      out[i] = to[i];
    } else {
      const double position = from[i] + t * Difference(j, from[i], to[i]);
      out[i] = joint(j).continuous ? WrapAngle(position) : position;
    }
  }
}

void JointSpace::Wrap(std::span<double> q) const {
  for (int j = 0; j < size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (joint(j).continuous) q[i] = WrapAngle(q[i]);
  }
}

int JointSpace::FirstOutsideLimits(std::span<const double> q) const {
  for (int j = 0; j < size(); ++j) {
    const double position = q[static_cast<std::size_t>(j)];
    if (!std::isfinite(position)) return j;
    if (joint(j).continuous) continue;
    if (position < joint(j).lower - kLimitTolerance) return j;
    if (position > joint(j).upper + kLimitTolerance) return j;
  }
  return -1;
}

}  // namespace planbench
