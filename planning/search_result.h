#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "planning/plan_result.h"
#include "planning/plan_status.h"

namespace planbench {

/// What a search found. Status is one of kSolved, kTimedOut, kExhausted, kCancelled, kMemoryLimit;
/// a cancelled or timed-out anytime search that has a path returns it as kSolved.
struct SearchResult {
  PlanStatus status = PlanStatus::kTimedOut;
  std::string message;
  Path path;  ///< Query start to a point of the goal box; waypoints' edges all found valid by
              ///< SearchQuery::edges().
  double epsilon = 0;
  double cost = 0;
  std::uint64_t guidance_ticks = 0;  ///< Time spent on heuristic or nearest neighbours (Ticks), if
                                     ///< measured; without collision checking.
  std::map<std::string, double> counters;
  /// What the search was made of, where freeing it takes time. Planner frees it once the clock has
  /// stopped, so that it counts for no planner.
  std::shared_ptr<void> remains;
};

}  // namespace planbench
