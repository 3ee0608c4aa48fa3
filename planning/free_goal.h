#pragma once

#include <functional>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "planning/goal_box.h"
#include "planning/plan_result.h"

namespace planbench {

/// Why a state is not valid, in one line that begins with `what`; empty if it is valid.
std::string FindFault(EdgeChecker* edges, const Configuration& q, const std::string& what);

/// Configurations of a goal box that are tried where its nominal point is not valid.
inline constexpr int kGoalTries = 1000;

/// What became of the search for a valid point.
enum class GoalVerdict {
  kFree,
  kInvalid,
  kUndecided,  ///< It was told to stop before it had tried what it would have.
};

struct GoalFinding {
  GoalVerdict verdict = GoalVerdict::kFree;
  std::string fault;  ///< In one line; empty where the goal is free.
};

/// Sees to it that a goal's nominal point is valid: where it is not, valid points are looked for in
/// the rest of the box, and the first one becomes the nominal point. The box may lose points of
/// continuous joints that are half a turn or more from where the nominal point was. The same
/// request gives the same point.
///
/// Nothing is proven about a box that has points within the limits other than the nominal one: then
/// the fault says, behind what is wrong with that, how many were tried: kGoalTries, or fewer, and
/// nothing is decided, if `should_stop` said so.
GoalFinding FindFreeGoal(EdgeChecker* edges, GoalBox* goal,
                         const std::function<bool()>& should_stop);

/// Leaves, of several goals, those that have a valid point (see FindFreeGoal), nearest to the start
/// first, and of equal ones one. kInvalid if there is none; kUndecided if one is not decided, which
/// leaves no time for the others either.
GoalFinding KeepFreeGoals(EdgeChecker* edges, const Configuration& start,
                          std::vector<GoalBox>* goals, const std::function<bool()>& should_stop);

}  // namespace planbench
