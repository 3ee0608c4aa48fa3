#include "planner_rrtc/goal_box_region.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace planbench {

namespace ob = ompl::base;

GoalBoxRegion::GoalBoxRegion(const ob::SpaceInformationPtr& si, const OmplJointSpace& space,
                             const GoalBox& box, std::uint64_t seed)
    : ob::GoalSampleableRegion(si),
      space_(space),
      box_(box),
      is_point_(box.lower == box.upper),
      generator_(seed) {}

double GoalBoxRegion::distanceGoal(const ob::State* state) const {
  const JointSpace& joints = space_.joints();
  const double* q = OmplPositions(state);
  double sum = 0;
  for (int j = 0; j < joints.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double offset = joints.Difference(j, box_.nominal[k], q[k]);
    const double inside =
        std::clamp(offset, box_.lower[k] - box_.nominal[k], box_.upper[k] - box_.nominal[k]);
    sum += (offset - inside) * (offset - inside);
  }
  return std::sqrt(sum);
}

void GoalBoxRegion::sampleGoal(ob::State* state) const {
  const JointSpace& joints = space_.joints();
  Configuration q = box_.nominal;
  if (nominal_sampled_) {
    for (int j = 0; j < joints.size(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      double below = box_.lower[k] - q[k];
      double above = box_.upper[k] - q[k];
      if (joints.joint(j).continuous) {
        // One turn at most; short of half a turn, so that the short way from the nominal point is
        // the sample's.
        constexpr double kHalfTurn = std::numbers::pi - 1e-9;
        below = std::max(below, -kHalfTurn);
        above = std::min(above, kHalfTurn);
      }
      const double u = static_cast<double>(generator_() >> 11) * 0x1p-53;
      q[k] += below + u * (above - below);
    }
  }
  nominal_sampled_ = true;
  space_.SetPositions(state, q);
}

unsigned int GoalBoxRegion::maxSampleCount() const {
  // Some of OMPL's planners take all there are before they begin.
  constexpr unsigned int kSamplesOfABox = 50;
  return is_point_ ? 1 : kSamplesOfABox;
}

}  // namespace planbench
