#pragma once

#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Planning groups for a robot of which nothing but its tree is known. An arm is a chain of joints
/// that move and follow none, from where it leaves the body to its last joint before a hand; a
/// branch with fewer than three such joints is no arm beside one that has more (wheels, a head,
/// fingers). A hand is what parts at the end of an arm of three or more joints in branches that
/// have no more joints than it and are less than half as long. From the end of an arm of more than
/// three joints are taken, for a hand's, those that a joint of another branch follows, and a
/// prismatic joint that moves less than 0.1 m and has something beside it. The tip is the outermost
/// link that is rigid to the last joint's and has no link beside it.
///
/// One arm gives one group, `arm`, with the joints of the body that carry it; several give
/// `arm_TIP` each, with the joints of that arm alone, and `all_arms`, with everything and a tip for
/// each. Where three or more joints of the body lead to where arms part, they are `arm_TIP` too.
/// Joints that no group can have (RobotModel::FollowerThatTurnsMove) are left out, with a note
/// each. Throws InputError if no joint can be planned with.
std::vector<PlanningGroup> ProposeGroups(const RobotModel& model,
                                         std::vector<std::string>* notes = nullptr);

}  // namespace planbench
