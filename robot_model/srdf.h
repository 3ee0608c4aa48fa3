#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// What an SRDF, MoveIt's semantic description, says of a robot, resolved against its URDF.
struct Srdf {
  /// A hand or tool that a group carries.
  struct EndEffector {
    std::string name;
    std::string group;         ///< Of its own joints and links.
    std::string parent_link;   ///< That it is mounted on.
    std::string parent_group;  ///< That moves it; "" if the file does not say.
  };
  /// How the robot stands in the world.
  struct VirtualJoint {
    std::string name;
    std::string type;  ///< fixed, planar or floating
    std::string parent_frame;
    std::string child_link;
  };

  /// Those with a joint that can be planned with, in file order; joints in URDF order, without
  /// fixed, planar and floating ones, passive ones and those that follow others. Tips are those of
  /// the chains, else the outermost links. States are complete: joints that the file does not name
  /// are at their default position.
  std::vector<PlanningGroup> groups;
  std::vector<EndEffector> end_effectors;
  std::vector<VirtualJoint> virtual_joints;
  std::vector<std::pair<int, int>> disabled_pairs;  ///< Link indices, each pair once, the lower
                                                    ///< first.
  std::vector<LinkSphere> spheres;                  ///< Approximations, sorted by link.
  /// What of the file does not count, one line each: pairs of links that the robot does not have,
  /// elements that are not known.
  std::vector<std::string> warnings;
  /// Groups, joints of groups and states that planning has no use for, one line each.
  std::vector<std::string> left_out;
};

/// Reads SRDF text; `origin` names it. Throws InputError with file and line: for text that is no
/// SRDF, and for groups, end effectors and spheres that name what the robot or the file does not
/// have.
Srdf ParseSrdf(const std::string& srdf_text, const std::string& origin, const RobotModel& model);

}  // namespace planbench
