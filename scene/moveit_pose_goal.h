#pragma once

#include <vector>

#include "common/error.h"
#include "common/yaml.h"
#include "robot_model/robot_model.h"
#include "scene/frame_tree.h"

namespace planbench {

/// No configuration of the group was found for a constraint.
class OutOfReach : public InputError {
 public:
  using InputError::InputError;
};

/// True if a moveit_msgs/Constraints constrains the position or orientation of a link.
bool HasPoseConstraints(const YamlNode& constraints);

/// Configurations of the group, group order, that meet the position constraint, the orientation
/// constraint, or both, that a moveit_msgs/Constraints has of one or several of the group's tips.
/// They are found by inverse kinematics, within `limits` (group order): for the middle of the
/// constraint and for poses drawn from all that it allows, from random configurations; of several
/// tips one after the other, with the joints held that move those before. One to 16, which differ
/// by 0.1 (rad, m; L2) or more. They depend on the constraint, the robot and the full positions
/// `start` alone, at which other joints are held: the same for every planner and in every run.
///
/// Position: the point `target_point_offset` of the link is in one of the constraint_region's
/// primitives, boxes and spheres. Orientation: that of the link, R_L = R_D * d for the wanted R_D,
/// has a deviation d whose angles are within absolute_{x,y,z}_axis_tolerance: with parameterization
/// 0 those of rotations about x, the new y and the new z, with 1 the components of the rotation
/// vector. For the link there may stand an object attached to it, or a subframe of such. `frames`
/// have the robot at the start. Either is met to 1e-6 (m, rad); what is
/// not constrained is free.
///
/// Throws InputError naming file, line and field for what cannot be read, more than one constraint
/// of a kind for a tip, links that do not move as one with a tip of the group; OutOfReach for
/// constraints that no configuration was found for.
std::vector<std::vector<double>> FindPoseGoals(const YamlNode& constraints, const RobotModel& model,
                                               const PlanningGroup& group, const JointSpace& limits,
                                               const std::vector<double>& start,
                                               const FrameTree& frames);

}  // namespace planbench
