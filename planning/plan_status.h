#pragma once

#include <optional>
#include <string_view>

namespace planbench {

/// How a request ended. The numbers are those of lcmt_plan_result and of the database.
enum class PlanStatus {
  kSolved = 0,
  kTimedOut = 1,
  kExhausted = 2,     ///< The search space is provably empty of solutions.
  kStartInvalid = 3,  ///< The start is outside the limits or in collision.
  kGoalInvalid = 4,
  kInvalidRequest = 5,
  kCancelled = 6,
  kNoAnswer = 7,     ///< The process died or fell silent (set by the driver).
  kInvalidPath = 8,  ///< The referee rejected the path (set by the driver).
  kMemoryLimit = 9,
};
inline constexpr int kNumPlanStatuses = 10;

/// "SOLVED", "TIMED_OUT", ...
std::string_view PlanStatusName(PlanStatus status);
std::optional<PlanStatus> ParsePlanStatus(std::string_view name);

enum class Direction {
  kForward = 0,   ///< Search from start to goal.
  kBackward = 1,  ///< Search from goal to start; the path is returned start to goal.
};
/// "forward", "backward".
std::string_view DirectionName(Direction direction);
std::optional<Direction> ParseDirection(std::string_view name);

}  // namespace planbench
