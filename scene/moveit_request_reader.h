#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"
#include "scene/frame_tree.h"
#include "scene/problem.h"

namespace planbench {

// Parts of a moveit_msgs/MotionPlanRequest. All throw InputError naming file, line and field.

/// Refuses what is no map, fields that the message does not have, and constraints on the path.
/// Warns of trajectories to start from.
void RequireRequest(const YamlNode& motion_plan_request);

/// The planning group that a request is for.
struct RequestGroup {
  const PlanningGroup* group = nullptr;  ///< The robot's.
  /// For errors, "no group_name, so 'left'"; "" if the request names it, or the robot has no other.
  std::string why = {};
};

/// The planning group that group_name names; without one, or with an empty one, that of exactly the
/// joints that the goals name, else the first that has all of these, else the robot's first. Of
/// several the one that was taken is warned of.
RequestGroup ReadGroup(const YamlNode& motion_plan_request, const Robot& robot);

/// goal_constraints, as Problem::goal: each set is an alternative, of joint constraints with one
/// for each joint of the group, in any order; or of constraints on the poses of tips (see
/// FindPoseGoals), which are as many alternatives as configurations are found, without tolerance,
/// within what joint constraints beside them allow. Constraints of other joints are taken if they
/// say nothing: of fixed joints at 0, of joints outside the group where they are at `start` (full
/// positions), of joints that follow one of the group where that puts them. Goals name the joints
/// in the group's order.
std::vector<JointGoal> ReadGoal(const YamlNode& motion_plan_request, const Robot& robot,
                                const PlanningGroup& group, const std::vector<double>& start,
                                const FrameTree& frames);

/// workspace_parameters, if they are set. `frames` have the robot at the start; in a frame that
/// they do not have it is left out, with a warning.
std::optional<Workspace> ReadWorkspace(const YamlNode& motion_plan_request,
                                       const FrameTree& frames);
/// min_corner and max_corner of `node`, in a frame; nothing if all are zero, which is unset.
std::optional<Workspace> ReadCorners(const YamlNode& node, const std::string& frame);

/// allowed_planning_time, s; 0 without one.
double ReadTimeLimit(const YamlNode& motion_plan_request);

}  // namespace planbench
