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
  double cost = 0;
  /// Proven: no path to this goal costs less, whether one was found or not; infinity: there is
  /// none. 0: nothing is proven. Of the paths in what the planner searches, which may be less once
  /// there is a path to another goal (ARA*: lattices without finer moves).
  double lower_bound = 0;
  /// Of several goals: paths to the others are searched for, too, until this one is proven to cost
  /// at most so many times the optimum over all of them. 0: one path to one goal will do.
  double wanted_epsilon = 0;
  std::uint64_t guidance_ticks = 0;  ///< Time spent on heuristic or nearest neighbours (Ticks), if
                                     ///< measured; without collision checking.
  std::map<std::string, double> counters;  ///< Of several goals' searches the sums are told.
  /// What is no count to be summed but tells how the path was found: told of the search whose path
  /// is returned (without a path: of the last).
  std::map<std::string, double> path_counters;
  /// What the search was made of, where freeing it takes time. Planner frees it once the clock has
  /// stopped, so that it counts for no planner.
  std::shared_ptr<void> remains;
};

}  // namespace planbench
