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

  /// Those with a joint that can be planned with, in file order; joints in URDF order, without
  /// fixed, planar and floating ones, passive ones and those that follow others. A chain is all
  /// joints between two links; where neither carries the other, it has two branches, two tips, and,
  /// as MoveIt takes it, the joint beneath where they meet. Tips are those of the chains, but for
  /// those that an arm leads on from (three joints or more, none of an end effector), and the
  /// outermost links of branches without one; no two are rigid to each other. States are complete:
  /// joints that the file does not name are where the last follower that it names puts them, or at
  /// their default position.
  std::vector<PlanningGroup> groups;
  std::vector<EndEffector> end_effectors;
  std::vector<VirtualJoint> virtual_joints;
  /// Link indices, each pair once, the lower first. What the file both enables and disables is
  /// disabled, as in MoveIt.
  std::vector<std::pair<int, int>> disabled_pairs;
  std::vector<std::pair<int, int>> enabled_pairs;  ///< Of <enable_collisions>, likewise.
  /// Links, likewise, that a joint connects (RobotModel::Joined) and that are checked all the same:
  /// enabled pairs, and, in a file that disables some, those that it does not: as MoveIt takes it,
  /// whose Setup Assistant writes them as disabled ("Adjacent").
  std::vector<std::pair<int, int>> checked_pairs;
  std::vector<LinkSphere> spheres;  ///< Approximations, sorted by link.
  /// What of the file does not count, or contradicts the rest, one line each: the name of another
  /// robot, elements and attributes that are not known, pairs of links that the robot does not have
  /// or that cannot be as the file says.
  std::vector<std::string> warnings;
  /// What of the groups does not count although it was meant to, one line each: groups that name
  /// nothing or cannot be planned with, planar and floating joints of groups; joints that states do
  /// not give, give outside their limits, or elsewhere than where those put them that they follow;
  /// those of states, and passive ones, that neither the robot nor the file has; states of no
  /// group, and end effectors on a link or of a parent group that there is not.
  std::vector<std::string> group_warnings;
  std::vector<std::string> sphere_warnings;  ///< Spheres of links that the robot does not have.
  /// Groups, joints of groups and states that planning has no use for, one line each.
  std::vector<std::string> left_out;
  /// Why a group of the file is not in `groups`, by its name: its line in one of the two above.
  std::map<std::string, std::string> why_no_group;
};

/// For messages: that it has no group to plan with, and why.
std::string NoGroupFault(const Srdf& srdf, const std::string& origin);

/// Reads SRDF text; `origin` names it. Throws InputError with file and line: for text that is no
/// SRDF, for groups and virtual joints that name what the robot or the file does not have, for end
/// effectors of no group, and for names that occur twice.
Srdf ParseSrdf(const std::string& srdf_text, const std::string& origin, const RobotModel& model);

}  // namespace planbench
