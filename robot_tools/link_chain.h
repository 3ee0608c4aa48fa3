#pragma once

#include <array>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// The joints between two links and the nearest link that carries both: joint indices, fixed ones
/// included, outermost first; those of the first link, those of the second.
using LinkChain = std::array<std::vector<int>, 2>;

LinkChain ChainBetween(const RobotModel& model, int link_a, int link_b);

/// The joints (indices, ascending) whose positions place the two links against each other: those
/// between them, or which they follow.
std::vector<int> JointsThatPlace(const RobotModel& model, int link_a, int link_b);

/// Whether one of `joints` (indices) is among them.
bool JointsMove(const RobotModel& model, const std::vector<int>& joints, int link_a, int link_b);

/// Whether a planar or floating one is among them: it has no limits, and problems say where it is.
bool AnywhereByPose(const RobotModel& model, int link_a, int link_b);

}  // namespace planbench
