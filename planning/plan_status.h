#pragma once

#include "common/enum_names.h"

namespace planbench {

/// How a request ended. The numbers are those of lcmt_plan_result and of the database.
enum class PlanStatus {
  kSolved = 0,
  kTimedOut = 1,
  kExhausted = 2,     ///< All that was to be tried was: a whole search space, or guesses.
  kStartInvalid = 3,  ///< The start is outside the limits or in collision.
  kGoalInvalid = 4,
  kInvalidRequest = 5,
  kCancelled = 6,
  kNoAnswer = 7,     ///< The process died or fell silent (set by the driver).
  kInvalidPath = 8,  ///< The referee rejected the path (set by the driver).
  kMemoryLimit = 9,  ///< Out of memory that it may have, or the path is too long for a result.
};
template <>
struct EnumNames<PlanStatus> {
  static constexpr auto kNames = std::to_array<std::string_view>(
      {"SOLVED", "TIMED_OUT", "EXHAUSTED", "START_INVALID", "GOAL_INVALID", "INVALID_REQUEST",
       "CANCELLED", "NO_ANSWER", "INVALID_PATH", "MEMORY_LIMIT"});
};

enum class Direction {
  kForward = 0,   ///< Search from start to goal.
  kBackward = 1,  ///< Search from goal to start; the path is returned start to goal.
};
template <>
struct EnumNames<Direction> {
  static constexpr auto kNames = std::to_array<std::string_view>({"forward", "backward"});
};
inline Direction Opposite(Direction direction) {
  return direction == Direction::kForward ? Direction::kBackward : Direction::kForward;
}

}  // namespace planbench
