#pragma once

#include <ompl/base/goals/GoalSampleableRegion.h>

#include <cstdint>
#include <random>

#include "planner_rrtc/ompl_joint_space.h"
#include "planning/planner.h"

namespace planbench {

/// A goal box for OMPL: its nominal point first, then uniform samples, by a generator of its own.
/// `space` and `box` must outlive it.
class GoalBoxRegion final : public ompl::base::GoalSampleableRegion {
 public:
  GoalBoxRegion(const ompl::base::SpaceInformationPtr& si, const OmplJointSpace& space,
                const GoalBox& box, std::uint64_t seed);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;
  unsigned int maxSampleCount() const override;

 private:
  const OmplJointSpace& space_;
  const GoalBox& box_;
  bool is_point_;
  mutable bool nominal_sampled_ = false;
  mutable std::mt19937_64 generator_;
};

}  // namespace planbench
