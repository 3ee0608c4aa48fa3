#pragma once

#include "planning/plan_status.h"

namespace planbench {

/// Whether the record of a run tells of a request to its planner. `roundtrip_time_s`: 0 if none is
/// recorded; `has_scene`: whether it names one, which it lacks where the problem could not be had.
inline bool TellsOfRequest(double roundtrip_time_s, PlanStatus status, bool has_scene) {
  // A request that was sent took time, whatever came of it; of a refusal older sessions do not tell
  // how much.
  return roundtrip_time_s > 0 || (status != PlanStatus::kNoAnswer && has_scene);
}

}  // namespace planbench
