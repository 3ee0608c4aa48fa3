#pragma once

#include <functional>
#include <string>

#include "collision/edge_checker.h"
#include "planning/goal_box.h"
#include "planning/plan_result.h"

namespace planbench {

/// Why a state is not valid, in one line that begins with `what`; empty if it is valid.
std::string FindFault(EdgeChecker* edges, const Configuration& q, const std::string& what);

/// Configurations of a goal box that are tried where its nominal point is not valid.
inline constexpr int kGoalTries = 1000;

/// Sees to it that a goal's nominal point is valid: where it is not, valid points are looked for in
/// the rest of the box, and the first one becomes the nominal point. The box may lose points of
/// continuous joints that are half a turn or more from where the nominal point was. The same
/// request gives the same point.
///
/// Returns why there is none, in one line; empty if there is. Nothing is proven about a box that
/// has points within the limits other than the nominal one: then the line says, behind what is
/// wrong with that, how many were tried, kGoalTries at most, fewer if `should_stop` said so.
std::string FindFreeGoal(EdgeChecker* edges, GoalBox* goal,
                         const std::function<bool()>& should_stop);

}  // namespace planbench
