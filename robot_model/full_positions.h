#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Why a joint of that name cannot be at that position ("is unknown"), nothing if it can be named
/// so. Names are those of joints, and RobotModel::position_names. A fixed joint may be named at 0,
/// and where the description may have fixed it: at a coordinate or the angle of its origin, of
/// either sign; what would lift or tilt a planar joint, at 0.
std::optional<std::string> FindPositionFault(const RobotModel& model, const std::string& name,
                                             double position);

/// What is odd about a position without fault, nothing if nothing is: a fixed joint's that its
/// origin does not show along or about the axis of its description.
std::optional<std::string> FindPositionDoubt(const RobotModel& model, const std::string& name,
                                             double position);

/// A part of a planar or floating joint's pose.
struct PosePart {
  int position_index = 0;  ///< In RobotModel::position_names; of an angle, that of rot_z.
  bool is_angle = false;   ///< About a planar joint's z axis, which rot_z and rot_w tell.
};
/// The part of that name, nothing if there is none: one of RobotModel::position_names, or, as
/// MoveIt has them of a planar joint, JOINT/x, JOINT/y, JOINT/theta.
std::optional<PosePart> FindPosePart(const RobotModel& model, const std::string& name);
/// Its value in full positions; an angle in [-2 pi, 2 pi].
double PositionOf(const PosePart& part, const std::vector<double>& full);

/// Why a joint of that type cannot have its child link at pose X_JC in its own frame ("is planar
/// and cannot be tilted"), nothing if it can. Planar ones move in x and y, and turn about z.
std::optional<std::string> FindPoseFault(JointType type, const Eigen::Isometry3d& X_JC);

/// Full positions from named ones: `names[i]` takes `positions[i]`, others their default. A joint
/// that follows another is where that one puts it; if only the follower is named, the leader is
/// where it puts the follower. Throws InputError for names at fault (see FindPositionFault), sizes
/// that differ, repeated names; `origin` names the source. Positions of followers that contradict
/// their leaders' do not count (FindContradictions).
std::vector<double> FullPositions(const RobotModel& model, const std::vector<std::string>& names,
                                  const std::vector<double>& positions, const std::string& origin);

/// The same for a robot that lacks some of the joints, or has them fixed elsewhere: what it cannot
/// follow does not count.
std::vector<double> FullPositionsWherePossible(const RobotModel& model,
                                               const std::vector<std::string>& names,
                                               const std::vector<double>& positions);

/// Positions of followers that contradict their leaders' (by more than 1e-3, rad or m) and do not
/// count, one line each ("joint 'b' is given at 0.3, but follows joint 'a', which puts it at 0.1").
std::vector<std::string> FindContradictions(const RobotModel& model,
                                            const std::vector<std::string>& names,
                                            const std::vector<double>& positions);

/// The one of `names` that, named without its leader, puts the joint of that index where it is; ""
/// if none does.
std::string FollowerThatPuts(const RobotModel& model, int leader,
                             const std::vector<std::string>& names);

/// Puts the named joints of full positions where `positions` have them, in the same way; others
/// stay where they are.
void PutPositions(const RobotModel& model, const std::vector<std::string>& names,
                  const std::vector<double>& positions, std::vector<double>* full);

}  // namespace planbench
