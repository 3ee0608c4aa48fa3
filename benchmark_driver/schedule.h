#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"
#include "messaging/messages.h"
#include "results/session_plan.h"

namespace planbench {

/// One run to be made.
struct ScheduledRun {
  std::string planner;
  std::string problem_set;
  int problem_index = 0;
  Direction direction = Direction::kForward;
  int trial = 1;           ///< From 1.
  std::uint64_t seed = 1;  ///< RunSeed's: equal for all contestants.
  std::string request_id;  ///< <run_id>/<set>/<index>/<planner>/<direction>/<trial>
  /// Request id of the attempt in the other direction: with one, this run is made only if that one
  /// found no path.
  std::optional<std::string> unless_solved = {};
  /// The attempt in the other direction is made, too, whatever becomes of this one.
  bool is_one_of_two = false;
};

/// A contestant that is asked in these directions and trials, by what planners say of themselves:
/// its own, and the one whose path it improves, if there is one. Whether there is a path at all is
/// that one's matter.
PlannedPlanner PlanPlanner(const Contestant& contestant, Directions directions, int trials,
                           const std::map<std::string, NodeStatusMessage>& planners);

/// What the options select of the sets that are served, for these planners. Throws InputError for a
/// set that is not served (naming those that are), a range that selects no problem of a set, and a
/// shard without runs.
PlannedCall PlanCall(const DriverOptions& options, std::vector<PlannedPlanner> planners,
                     const ProblemSetsMessage& served);

/// A line for each set of a call that has fewer problems than the options' range selects.
std::vector<std::string> ShortOfRange(const DriverOptions& options, const PlannedCall& call);

/// The seed of a run: a hash, so that neither problems, directions, trials nor sessions share
/// sequences of samples. Below 2^63.
std::uint64_t RunSeed(std::uint64_t session_seed, const std::string& problem_set, int problem_index,
                      Direction direction, int trial);

/// Every run of a call, in order: problem by problem and trial by trial, the contestants in an
/// order drawn anew each time (by the session's seed), so that all meet a problem under like
/// conditions of the machine and none always comes first; forward before backward. `request`: with
/// the session's run id and seed.
std::vector<ScheduledRun> MakeSchedule(const PlannedCall& call, const PlanRequest& request);

}  // namespace planbench
