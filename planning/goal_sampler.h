#pragma once

#include <cstdint>
#include <random>

#include "planning/goal_box.h"
#include "planning/plan_result.h"

namespace planbench {

/// Points of a goal box: its nominal point first, then uniform ones, by a generator of its own.
/// `joints` and `box` must outlive it.
class GoalSampler {
 public:
  GoalSampler(const JointSpace& joints, const GoalBox& box, std::uint64_t seed);

  /// The next one, continuous joints wrapped.
  Configuration Sample();
  /// How many are worth drawing: one of a box that is a point.
  int max_samples() const { return max_samples_; }

 private:
  const JointSpace& joints_;
  const GoalBox& box_;
  int max_samples_;
  bool nominal_sampled_ = false;
  std::mt19937_64 generator_;
};

}  // namespace planbench
