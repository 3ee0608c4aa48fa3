#pragma once

#include <map>
#include <string>
#include <vector>

#include "planning/plan_status.h"

namespace planbench {

/// What is known of how long the answer to a run took, s.
struct AnswerTimes {
  PlanStatus status = PlanStatus::kSolved;  ///< Final, the referee's word included.
  double told_s = 0;       ///< Total time and simplification, by the planner's word.
  double roundtrip_s = 0;  ///< By the driver's clock.
  double waited_s = 0;     ///< For a processor, as far as that was measured.
};

/// Whose answers came much later than the times that they tell of, a line on each, by contestant.
/// Loading and the bus are in no time told; what they take is what the round trips of the others
/// leave. Medians over the runs of one session, so that single runs that were held up tell of
/// nobody: over those that are confirmed, and over those whose time counts as told before such a
/// one, the path having been rejected, or memory or search space having come to its end, beside all
/// failed runs of the others.
std::map<std::string, std::string> DescribeUntoldTimes(
    const std::map<std::string, std::vector<AnswerTimes>>& by_contestant);

}  // namespace planbench
