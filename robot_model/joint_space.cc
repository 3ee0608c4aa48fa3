#include "robot_model/joint_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

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

JointSpace::JointSpace(std::vector<Joint> joints) : joints_(std::move(joints)) {
  for (const Joint& joint : joints_) {
    constexpr double kLargest = std::numeric_limits<double>::max();  // that is finite
    const bool bounded = !joint.continuous;
    lowest_.push_back(bounded ? std::max(-kLargest, joint.lower - kLimitTolerance)
                              : -kFarthestTurned);
    highest_.push_back(bounded ? std::min(kLargest, joint.upper + kLimitTolerance)
                               : kFarthestTurned);
  }
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

double JointSpace::WithoutTurns(int j, double position) const {
  const double turned = std::abs(position);
  const bool has_turns = joint(j).continuous && turned > kPi && turned <= kFarthestTurned;
  return has_turns ? WrapAngle(position) : position;
}

std::optional<std::string> JointSpace::FindTurnsDoubt(int j, double position) const {
  if (!joint(j).continuous || std::abs(position) <= 2 * kPi) return std::nullopt;
  return fmt::format("is at {} rad, {:.3g} turns; degrees?", position, position / (2 * kPi));
}

std::vector<std::string> JointSpace::TakeTurnsOut(std::span<double> q) const {
  std::vector<std::string> doubts;
  for (int j = 0; j < size(); ++j) {
    double& position = q[static_cast<std::size_t>(j)];
    if (const auto doubt = FindTurnsDoubt(j, position)) {
      doubts.push_back(fmt::format("joint '{}' {}", joint(j).name, *doubt));
    }
    position = WithoutTurns(j, position);
  }
  if (auto fault = FindLimitFault(q)) doubts.push_back(*std::move(fault));
  return doubts;
}

void JointSpace::ToNearestTurn(std::span<const double> to, std::span<double> q) const {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int j = 0; j < size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (joint(j).continuous || joint(j).prismatic || !joint(j).same_after_turn) continue;
    const double most = std::floor((highest_[i] - q[i]) / kTurn);
    const double least = std::ceil((lowest_[i] - q[i]) / kTurn);
    if (least > most) continue;
    q[i] += kTurn * std::clamp(std::round((to[i] - q[i]) / kTurn), least, most);
  }
}

JointSpace JointSpace::Held(const std::vector<int>& joints, std::span<const double> q) const {
  std::vector<Joint> held = joints_;
  for (const int j : joints) {
    const auto i = static_cast<std::size_t>(j);
    held[i].continuous = false;
    held[i].lower = held[i].upper = q[i];
  }
  return JointSpace(std::move(held));
}

std::string JointSpace::DescribeLimits(int j) const {
  const bool bounded = !joint(j).continuous;
  return fmt::format("[{:.8g}, {:.8g}]", bounded ? joint(j).lower : -kFarthestTurned,
                     bounded ? joint(j).upper : kFarthestTurned);
}

int JointSpace::FirstOutsideLimits(std::span<const double> q) const {
  for (std::size_t i = 0; i < lowest_.size(); ++i) {
    if (!(q[i] >= lowest_[i] && q[i] <= highest_[i])) return static_cast<int>(i);
  }
  return -1;
}

std::optional<std::string> JointSpace::FindLimitFault(std::span<const double> q) const {
  const int j = FirstOutsideLimits(q);
  if (j < 0) return std::nullopt;
  return fmt::format("joint '{}' at {} is outside its limits {}", joint(j).name,
                     q[static_cast<std::size_t>(j)], DescribeLimits(j));
}

bool JointSpace::WithinLimits(std::span<const double> q) const {
  bool within = true;
  for (std::size_t i = 0; i < lowest_.size(); ++i) {
    within &= (q[i] >= lowest_[i]) & (q[i] <= highest_[i]);  // NaN is not
  }
  return within;
}

}  // namespace planbench
