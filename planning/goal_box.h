#pragma once

#include <span>
#include <tuple>

#include "planning/plan_result.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// Goal of a search: a box in configuration space around a nominal point.
struct GoalBox {
  /// What positions may be outside and count as inside, rad or m.
  static constexpr double kRounding = 1e-9;

  Configuration nominal;
  Configuration lower;  ///< <= nominal
  Configuration
      upper;  ///< >= nominal; continuous joints are not wrapped: lower <= nominal <= upper holds.

  /// True if q is inside (continuous joints compared the short way round from nominal), limits
  /// inclusive with kRounding to spare.
  bool Contains(const JointSpace& space, std::span<const double> q) const;
  /// An order, by which equal boxes are found.
  friend bool operator<(const GoalBox& a, const GoalBox& b) {
    return std::tie(a.nominal, a.lower, a.upper) < std::tie(b.nominal, b.lower, b.upper);
  }
};

}  // namespace planbench
