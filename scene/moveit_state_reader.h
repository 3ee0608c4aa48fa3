#pragma once

#include <string>
#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"
#include "scene/frame_tree.h"
#include "scene/problem.h"

namespace planbench {

/// What a moveit_msgs/RobotState says of the robot, but for attached objects.
struct RobotStateFields {
  /// joint_state, and the poses that multi_dof_joint_state gives to planar and floating joints of
  /// the robot, as positions (RobotModel::position_names). A rotation is there whole or not at all.
  JointState joints;
  std::string frame;  ///< Of joint_state, "" if it names none.
  /// The poses that multi_dof_joint_state gives to virtual joints: those of their child links in
  /// their parent frames. Where the robot has no virtual joint, one of a joint that it does not
  /// have is such a pose, of the root link in the header's frame.
  std::vector<PlacedLink> placed_links;
  std::string placed_frame;  ///< Of multi_dof_joint_state, if links are placed.
};

/// Throws InputError naming the line: names with another number of positions or transforms, joints
/// that occur twice or that the robot does not have, positions and poses that a joint's type rules
/// out (FindPositionFault, FindPoseFault), those of virtual joints too, rotations that are none,
/// and poses in a frame that is not the joint's. Warns of positions in doubt (FindPositionDoubt),
/// of the group's joints also for their turns (JointSpace::FindTurnsDoubt).
RobotStateFields ReadRobotState(const YamlNode& robot_state, const Robot& robot,
                                const PlanningGroup& group);

/// Refuses a name that is a virtual joint's, or one of its variables' ("world_joint/x"), where a
/// position or a goal is given: such a joint has a pose, which no plan changes.
void RefuseVirtualJoint(const YamlNode& name, const Robot& robot);

/// `below` overlaid by `above`, which has the last word on the joints that it names. Throws
/// InputError if both place the root link, but in different frames.
RobotStateFields Overlaid(RobotStateFields below, const RobotStateFields& above);

}  // namespace planbench
