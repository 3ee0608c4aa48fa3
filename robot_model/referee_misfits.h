#pragma once

#include <string>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Setting in which a scene server tells RefereeMisfits, if there are any.
inline constexpr char kRefereeMisfits[] = "referee_misfits";

/// In what a referee's robot, which has the planning robot's groups and a root in common with it,
/// is another robot, a clause each. The first link, from the root, that is elsewhere than the
/// planning robot's of its name, relative to that root, in one of a few configurations, the same at
/// every call: its origin by more than a millimetre, or its directions by more than a milliradian,
/// other than by the same turn in all of them, which of a tip counts, too. Joints of one name are
/// at one place in both; those that one robot has fixed are where it has them. And the joints of
/// the groups that it lets move less, or of which one alone turns for ever. Empty if it is the
/// same.
std::string RefereeMisfits(const Robot& planning_robot, const Robot& referee);

/// Full positions of the referee's robot where the planning robot (`model`) is at its full
/// `positions`: joints of one name are at one place, those that follow others and those that only
/// the planning robot has fixed among them; what it cannot follow does not count, and others are at
/// their defaults.
std::vector<double> RefereePositions(const RobotModel& model, const std::vector<double>& positions,
                                     const RobotModel& referee);

/// The joints that the referee's robot has elsewhere all the same, by more than a millimetre or a
/// milliradian, a clause each: it has them fixed, or follow others ("joint 'lift' is fixed there,
/// at 0.0000, not at 0.2000", m or rad). Empty if there are none.
std::string PostureMisfits(const RobotModel& model, const std::vector<double>& positions,
                           const RobotModel& referee);

}  // namespace planbench
