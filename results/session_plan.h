#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "common/enum_names.h"
#include "planning/plan_status.h"

namespace planbench {

/// In which directions a contestant is asked to search.
enum class Directions {
  kAuto,  ///< Forward; then backward if that failed, unless it searches from both ends at once.
  kForward,
  kBackward,
  kBoth,
};
template <>
struct EnumNames<Directions> {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"auto", "forward", "backward", "both"});
};

/// A session has no more of problems of a set, trials or shards.
inline constexpr int kMostPlanned = 1'000'000;

/// One of `count` parts of a session, from 1.
struct Shard {
  int index = 1;
  int count = 1;
  bool operator==(const Shard&) const = default;
};

/// Problems of a set that are to be tried.
struct PlannedSet {
  std::string name;
  std::vector<int> problems;  ///< Indices, ascending.
  bool operator==(const PlannedSet&) const = default;
};

/// A planner that is to try them.
struct PlannedPlanner {
  std::string name;                           ///< On the bus.
  Directions directions = Directions::kAuto;  ///< kForward where auto asks for that alone.
  int trials = 1;  ///< Of each problem; 1 where the answer does not depend on the seed.
  bool operator==(const PlannedPlanner&) const = default;
};

/// A trial of a problem, which all planners of a call make.
struct PlannedTrial {
  std::string problem_set;
  int problem_index = 0;
  int trial = 1;  ///< From 1.
  bool operator==(const PlannedTrial&) const = default;
  friend bool operator<(const PlannedTrial& a, const PlannedTrial& b) {
    return std::tie(a.problem_set, a.problem_index, a.trial) <
           std::tie(b.problem_set, b.problem_index, b.trial);
  }
};

/// What one call of the driver is to make: all it takes to tell which runs.
struct PlannedCall {
  std::vector<PlannedSet> sets;          ///< In their order.
  std::vector<PlannedPlanner> planners;  ///< In the order of the line-up.
  Shard shard;
  bool operator==(const PlannedCall&) const = default;

  /// Of the whole: trials of problems, of which a shard has one at least.
  std::size_t NumParts() const;
  /// The trials of its shard, problem by problem. Shards take turns at the first trials of all
  /// problems, then the second, so that each has its share of the first one, which is all that
  /// deterministic planners make, and that who they are changes nothing.
  std::vector<PlannedTrial> Trials() const;
};

/// What all calls of the driver for a session were to make: how it was begun and resumed, and that
/// of all its parts if it was merged. No call twice.
using SessionPlan = std::vector<PlannedCall>;

/// Adds what is new of `more`.
void AddCalls(const SessionPlan& more, SessionPlan* plan);

/// Among a session's flags: its plan, as a line of JSON (docs/database.md).
inline constexpr char kPlanSetting[] = "plan";
std::string PlanText(const SessionPlan& plan);
/// By a session's flags; nothing if they do not tell, as in sessions of earlier versions. Throws
/// InputError for a text that is none of PlanText's.
std::optional<SessionPlan> ReadPlan(const std::map<std::string, std::string>& flags);

/// One run of a plan.
struct PlannedRun {
  PlannedTrial trial;
  std::string planner;
  Direction direction = Direction::kForward;
  friend bool operator<(const PlannedRun& a, const PlannedRun& b) {
    return std::tie(a.trial, a.planner, a.direction) < std::tie(b.trial, b.planner, b.direction);
  }
};

/// All runs of a plan, and whether the trial's forward one may make it needless.
std::map<PlannedRun, bool> RunsOf(const SessionPlan& plan);

/// A problem's name among those that a session left out (SessionMessage): "SET INDEX".
std::string LeftOutName(const std::string& problem_set, int problem_index);

/// Names of all problems of which a plan makes a trial.
std::set<std::string> ProblemsOf(const SessionPlan& plan);

/// How many runs of a plan are still to be made, backward ones included that the forward one may
/// make needless. `made`: and whether they make them needless. `left_out`: by LeftOutName, what
/// nobody has to make.
int CountOwed(const SessionPlan& plan, const std::map<PlannedRun, bool>& made,
              const std::map<std::string, std::string>& left_out);

/// Shards of which runs are in no call of the plan, in a line for each whole: "2/3, 3/3 of shelf
/// 1-4 by ara (auto, 2 trials)". Shards are of one whole if their problems and planners, directions
/// and trials included, are the same.
std::vector<std::string> MissingShards(const SessionPlan& plan);

/// A planner of both plans that they ask in different directions.
struct DirectionsDifference {
  std::string planner;
  Directions first = Directions::kAuto;
  Directions second = Directions::kAuto;
};
std::optional<DirectionsDifference> FindDirectionsDifference(const SessionPlan& first,
                                                             const SessionPlan& second);

/// Among a session's flags: which part "I/N" of a whole the call made, "" for all of it; of a
/// session that was merged of shards of earlier versions those of all, with ", " between.
inline constexpr char kShardFlag[] = "shard";

/// Said in the place of MissingShards where the plan is not known.
inline constexpr char kUnknownShards[] =
    "not known, since it is made of shards of an earlier version, which did not record its plan";

}  // namespace planbench
