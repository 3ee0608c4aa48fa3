#pragma once

#include <string>
#include <vector>

#include "planning/goal_box.h"
#include "planning/plan_result.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// What is asked, in a group's coordinates.
struct ResolvedQuery {
  std::vector<double> base_positions;  ///< Full positions at the start.
  Configuration start;                 ///< n joints, group order.
  std::vector<GoalBox> goals;          ///< Alternatives, one at least.
  Path initial_path;                   ///< From the start into a goal, to improve; may be empty.
};

/// Resolves named start and goal. Throws InputError (prefixed by `origin`) for unknown joints,
/// sizes that differ, non-finite values, negative tolerances, a start that misses and an
/// alternative of the goal that misses or repeats a joint of the group. Goal boxes are cut at the
/// joint limits; a nominal goal outside them stays as it is.
ResolvedQuery ResolveQuery(const Robot& robot, const PlanningGroup& group, const JointState& start,
                           const std::vector<JointGoal>& goal, const std::string& origin);

/// The initial path of `query`, given by name; empty if it is. Throws InputError (prefixed by
/// `origin`) if it does not name every joint of the group once, or a waypoint has another size or
/// values that are not finite, or it does not lead from the start into a goal of `query`.
Path ResolveInitialPath(const PlanningGroup& group, const ResolvedQuery& query,
                        const std::vector<std::string>& joint_names, const Path& path,
                        const std::string& origin);

}  // namespace planbench
