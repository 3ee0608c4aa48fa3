#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "common/enum_names.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// How far configurations are apart.
enum class Metric {
  kL2,   ///< Root of the sum of squares over joints, as a space of OMPL's own has it.
  kSum,  ///< Sum over joints, as MoveIt's joint-group space has it.
};

template <>
struct EnumNames<Metric> {
  static constexpr auto kNames = std::to_array<std::string_view>({"l2", "sum"});
};

/// Distances and motions of a JointSpace for configurations whose continuous joints are in
/// [-pi, pi], as every state of an OMPL space is here: without the cases that general positions
/// need, and without looking at the joints one by one.
class FlatJoints {
 public:
  explicit FlatJoints(const JointSpace& joints, Metric metric = Metric::kL2) : metric_(metric) {
    for (const JointSpace::Joint& joint : joints.joints()) {
      half_turn_.push_back(joint.continuous ? std::numbers::pi
                                            : std::numeric_limits<double>::infinity());
      turn_.push_back(joint.continuous ? 2 * std::numbers::pi : 0);
    }
  }

  std::size_t size() const { return turn_.size(); }
  Metric metric() const { return metric_; }

  /// In the metric.
  double Distance(const double* from, const double* to) const {
    double sum = 0;
    if (metric_ == Metric::kSum) {
      for (std::size_t j = 0; j < size(); ++j) sum += std::abs(Difference(j, from[j], to[j]));
      return sum;
    }
    for (std::size_t j = 0; j < size(); ++j) {
      const double difference = Difference(j, from[j], to[j]);
      sum += difference * difference;
    }
    return std::sqrt(sum);
  }

  /// The point at fraction t in [0, 1] of the straight motion; with t = 0 and t = 1 the ends as
  /// they are. `out` may be one of the ends.
  void Interpolate(const double* from, const double* to, double t, double* out) const {
    if (t == 0 || t == 1) {
      const double* end = t == 0 ? from : to;
      if (out != end) std::copy_n(end, size(), out);
      return;
    }
    for (std::size_t j = 0; j < size(); ++j) {
      out[j] = Wrap(j, from[j] + t * Difference(j, from[j], to[j]));
    }
  }

 private:
  /// Brings what is at most a turn beyond [-pi, pi] back.
  double Wrap(std::size_t j, double angle) const {
    const double down = angle > half_turn_[j] ? angle - turn_[j] : angle;
    return angle < -half_turn_[j] ? angle + turn_[j] : down;
  }
  double Difference(std::size_t j, double from, double to) const { return Wrap(j, to - from); }

  Metric metric_;
  std::vector<double> half_turn_;  ///< Infinite for bounded joints.
  std::vector<double> turn_;
};

}  // namespace planbench
