#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/plan_status.h"

namespace planbench {

/// n joint positions, group order, rad or m.
using Configuration = std::vector<double>;
/// Waypoints from start to goal, joined by edges.
using Path = std::vector<Configuration>;

/// Waypoints that a path of a result has at most. The raw and the simplified path of 8 joints are
/// then 1.92 MB together, which is half of a receiver's buffer. Each passes the bus several times,
/// in result, checks and record: 13 MB of them kept the processes busy for 15 s, and who does not
/// announce himself for 3 s counts as gone.
inline constexpr std::size_t kMostResultWaypoints = 15'000;

/// What is wrong with a path that a result cannot hold; "" if it can.
inline std::string WhyTooLong(const Path& path) {
  if (path.size() <= kMostResultWaypoints) return "";
  return "path of " + std::to_string(path.size()) + " waypoints; a result holds at most " +
         std::to_string(kMostResultWaypoints);
}

/// Whether a planner tells what its path costs. 0 is no cost but where a bound of it is told, too:
/// of a start that is in the goal.
inline bool TellsCost(double cost, double epsilon) { return cost != 0 || epsilon != 0; }

/// An improved solution of an anytime planner.
struct PlanProgress {
  double elapsed_s = 0;  ///< On the clock of the planning time.
  double epsilon = 0;    ///< Proven suboptimality bound, >= 1; 0 if the planner gives none.
  double cost = 0;       ///< In the planner's own unit (TellsCost). Does not rise.
  std::int64_t expansions = 0;
  bool operator==(const PlanProgress&) const = default;
};

/// Where the time up to the end of the search (PlanResult::total_time_s) went, s. That is the
/// planning time, unless the search went on with a path in hand: an anytime search after its first
/// solution, any other until the time limit. Phases that a planner does not have are 0, and all of
/// them if it does not tell.
struct PhaseTimes {
  double setup_s = 0;      ///< Scene, robot state, planner structures for this request.
  double collision_s = 0;  ///< Collision checking of states and edges.
  double guidance_s = 0;   ///< Heuristic or nearest neighbours, where the planner can tell.
  double search_s = 0;     ///< The rest.
  double simplification_s =
      0;  ///< After planning; no part of the planning time. 0: there was none.

  /// Whether the planner tells of the phases that the total time is made of.
  bool AreTold() const { return setup_s + collision_s + guidance_s + search_s > 0; }
  std::optional<double> Simplification() const {  ///< s; nothing if there was none.
    return simplification_s == 0 ? std::nullopt : std::optional(simplification_s);
  }
  bool operator==(const PhaseTimes&) const = default;
};

struct PlanResult {
  PlanStatus status = PlanStatus::kInvalidRequest;
  std::string message;         ///< Why, in one line, when not solved.
  double planning_time_s = 0;  ///< Request and scene at hand -> first solution or verdict ready.
  double total_time_s = 0;     ///< The same up to the end of the search: longer only for anytime,
                               ///< and beyond a time limit that came with a path in hand.
  PhaseTimes phases;
  Path path;             ///< Raw; empty unless solved.
  Path simplified_path;  ///< After the shared pass; empty if not asked for.
  double epsilon = 0;    ///< Proven bound of the path's cost, >= 1; 0 if the planner gives none.
  double cost = 0;       ///< In the planner's own unit (TellsCost).
  std::vector<PlanProgress> progress;
  /// Counts by name: edges_checked, configurations_checked, and the planner's own (iterations,
  /// expansions, states, ...).
  std::map<std::string, double> counters;
  double peak_memory_mb =
      0;  ///< Peak resident memory of the process during the request, MiB. (Since the start
          ///< of the process where the kernel forbids resetting it.)
  /// What the planner says; whether it is true, a referee tells.
  bool Solves() const { return status == PlanStatus::kSolved && !path.empty(); }
  bool operator==(const PlanResult&) const = default;
};

}  // namespace planbench
