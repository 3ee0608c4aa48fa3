#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// What a moveit_msgs/RobotState says of the robot, but for attached objects.
struct RobotStateFields {
  /// joint_state, and the poses that multi_dof_joint_state gives to planar and floating joints of
  /// the robot, as positions (RobotModel::position_names).
  JointState joints;
  std::string frame;  ///< Of joint_state, "" if it names none.
  /// Pose of the robot's root link in the frame multi_dof_joint_state is in: that of a joint which
  /// the robot's description does not have, which joins the robot to its surroundings.
  std::optional<Eigen::Isometry3d> X_WR;
  std::string root_frame;             ///< The frame W of that.
  std::optional<YamlNode> root_node;  ///< Where it stands.
};

/// Throws InputError naming the line: names with another number of positions or transforms, joints
/// that occur twice or that the robot does not have, positions and poses that a joint's type rules
/// out (FindPositionFault, FindPoseFault), those of virtual joints too, more than one joint that
/// could join the robot to its surroundings.
RobotStateFields ReadRobotState(const YamlNode& robot_state, const Robot& robot);

}  // namespace planbench
