#pragma once

#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"
#include "messaging/messages.h"

namespace planbench {

/// One run to be made.
struct ScheduledRun {
  std::string planner;
  std::string problem_set;
  int problem_index = 0;
  Direction direction = Direction::kForward;
  int trial = 1;           ///< From 1.
  std::uint64_t seed = 1;  ///< The first trial's seed + trial - 1; equal for all planners.
  std::string request_id;  ///< <run_id>/<set>/<index>/<planner>/<direction>/<trial>
};

/// Every run of a session, in order: problem by problem, so that all planners meet a problem under
/// like conditions of the machine; on each, planner by planner, trial by trial, direction by
/// direction. Throws InputError for a set that is not served (naming those that are) or a range
/// that selects no problem of a set.
std::vector<ScheduledRun> MakeSchedule(const DriverOptions& options,
                                       const ProblemSetsMessage& served);

}  // namespace planbench
