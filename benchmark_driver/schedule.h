#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
  std::uint64_t seed = 1;  ///< RunSeed's: equal for all contestants.
  std::string request_id;  ///< <run_id>/<set>/<index>/<planner>/<direction>/<trial>
  /// Request id of the attempt in the other direction: with one, this run is made only if that one
  /// found no path.
  std::optional<std::string> unless_solved = {};
  /// The attempt in the other direction is made, too, whatever becomes of this one.
  bool is_one_of_two = false;
};

/// A contestant as the schedule sees it.
struct Entrant {
  std::string planner;
  Directions directions = Directions::kAuto;
  bool can_backward = true;
  bool bidirectional = false;  ///< Searches from both ends at once: auto is one run.
  bool deterministic =
      false;  ///< Whatever the seed, the answer is the same: further trials are not run.

  /// Whether auto is the forward search alone.
  bool IsAskedOnce() const { return bidirectional || !can_backward; }
};

/// A contestant that is asked in these directions, by what planners say of themselves: its own, and
/// the one whose path it improves, if there is one.
Entrant MakeEntrant(const Contestant& contestant, Directions directions,
                    const std::map<std::string, NodeStatusMessage>& planners);

/// The seed of a run: a hash, so that neither problems, directions, trials nor sessions share
/// sequences of samples. Below 2^63.
std::uint64_t RunSeed(std::uint64_t session_seed, const std::string& problem_set, int problem_index,
                      Direction direction, int trial);

/// Every run of a session, in order: problem by problem and trial by trial, the contestants in an
/// order drawn anew each time (by the session's seed), so that all meet a problem under like
/// conditions of the machine and none always comes first; forward before backward. A shard has
/// every count-th trial of a problem, counted over the first trials of all, then the second, with
/// all contestants, whoever they are. Throws InputError for a set that is not served (naming those
/// that are), a range that selects no problem of a set, and a shard without runs.
std::vector<ScheduledRun> MakeSchedule(const DriverOptions& options,
                                       const std::vector<Entrant>& entrants,
                                       const ProblemSetsMessage& served);

}  // namespace planbench
