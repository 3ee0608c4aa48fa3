#pragma once

#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// The arms of a planning group: the joints that move one of several tips, and no other. A group
/// with fewer than two of them counts as one arm, joints and tips and all.
struct Arms {
  int num = 1;
  /// n joints: the arm, or `num` if the joint moves several tips (a torso) or none.
  std::vector<int> of_joint;
  /// By tip, in the order of PlanningGroup::tips; `num` for a tip that no joint moves alone.
  std::vector<int> of_tip;
};
Arms ArmsOf(const RobotModel& model, const PlanningGroup& group);
/// All of a group's joints and tips as one arm.
Arms OneArm(const PlanningGroup& group);

/// By pair of joints of a group: true if one of the two moves the other.
std::vector<std::vector<char>> JointsOnOneArm(const RobotModel& model, const PlanningGroup& group);

}  // namespace planbench
