#pragma once

#include <array>

#include "planning/plan_request.h"

namespace planbench {

/// The phases that the total time is made of; simplification comes on top.
inline constexpr std::array<double PhaseTimes::*, 4> kPartsOfTotal = {
    &PhaseTimes::setup_s, &PhaseTimes::collision_s, &PhaseTimes::guidance_s, &PhaseTimes::search_s};

/// Brings the times that a planner tells of within each other and within the round trip (s) that
/// the driver saw, a failed attempt's to what it must have taken, that of one that was not asked
/// for better paths to the end of its search, and improvements to the path that came of them; notes
/// in counters (kOddTimes of results/outcomes.h; a planner's own of these names are dropped) by how
/// much they were not so, how long a search went on beyond the time limit with a path in hand, and
/// what an answer that came after the limit does not tell of. `is_overdue`: the request had been
/// cancelled by then, so that a path is a failure, as is one that is late by its planner's word.
void KeepTimesPossible(double roundtrip_time_s, const PlanRequest& request, bool is_overdue,
                       PlanResult* result);

}  // namespace planbench
