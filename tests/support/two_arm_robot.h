#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Two planar arms side by side, each of two links of 0.4 m about vertical axes, shoulders 0.7 m
/// apart along y, both pointing along x at 0; on request on a torso that turns about z. The group
/// "both" has all joints (torso, left_shoulder, left_elbow, right_shoulder, right_elbow) and the
/// tips left_hand and right_hand.
inline Robot MakeTwoArmRobot(bool with_torso = false) {
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, double x, double y) {
    return fmt::format(
        "<link name='{2}'/><joint name='{0}' type='revolute'><parent link='{1}'/>"
        "<child link='{2}'/><origin xyz='{3} {4} 0'/><axis xyz='0 0 1'/>"
        "<limit lower='-2.5' upper='2.5' velocity='1' effort='1'/></joint>",
        name, parent, child, x, y);
  };
  std::string urdf = "<robot name='two_arms'><link name='base'/>";
  std::vector<std::string> joints;
  std::string parent = "base";
  if (with_torso) {
    urdf += joint("torso", parent, "chest", 0, 0);
    joints.emplace_back("torso");
    parent = "chest";
  }
  for (const std::string side : {"left", "right"}) {
    urdf += joint(side + "_shoulder", parent, side + "_upper", 0, side == "left" ? 0.35 : -0.35);
    urdf += joint(side + "_elbow", side + "_upper", side + "_lower", 0.4, 0);
    urdf += fmt::format(
        "<link name='{0}_hand'/><joint name='{0}_wrist' type='fixed'><parent link='{0}_lower'/>"
        "<child link='{0}_hand'/><origin xyz='0.4 0 0'/></joint>",
        side);
    joints.push_back(side + "_shoulder");
    joints.push_back(side + "_elbow");
  }
  Robot robot;
  robot.name = robot.content_id = "two_arms";
  robot.model = RobotModel::FromUrdf(urdf + "</robot>", "two_arms.urdf");
  robot.groups.push_back(robot.model.MakeGroup("both", joints, "left_hand", {"right_hand"}));
  for (int link = 0; link < robot.model.num_links(); ++link) {
    const std::string& name = robot.model.links()[static_cast<std::size_t>(link)].name;
    if (!name.ends_with("_upper") && !name.ends_with("_lower")) continue;
    for (const double x : {0.1, 0.2, 0.3}) robot.spheres.push_back({link, {x, 0, 0}, 0.05});
  }
  return robot;
}

}  // namespace planbench
