#pragma once

#include <set>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Indices of the joints between a link and the root, the link's own first.
std::vector<int> JointsToRoot(const RobotModel& model, int link);

/// The links that stand for the ends of a group of `joints` (indices, as in `hand_joints`):
/// `chain_tips`, where the group moves them; of branches without one the outermost links; and none
/// that an arm leads on from, which is three of the joints or more, none of them a hand's. Some may
/// be rigid to each other (RobotModel::MakeGroup).
std::vector<int> GroupTips(const RobotModel& model, const std::set<int>& joints,
                           const std::vector<int>& chain_tips, const std::set<int>& hand_joints);

}  // namespace planbench
