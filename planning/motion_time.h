#pragma once

#include <vector>

#include "planning/plan_result.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// Shortest time, s, in which joints can follow the path exactly: from rest to rest between the
/// points where it turns, since no bounded acceleration goes round a corner. No joint is faster
/// than its limit (1 rad/s or m/s where the URDF has none), nor accelerates to it within less than
/// kTimeToFullSpeed: a trapezoid of the speed along each straight piece, however many waypoints lie
/// on it.
inline constexpr double kTimeToFullSpeed = 0.5;  // s
double MotionTime(const JointSpace& space, const Path& path);

/// Unit vector of the straight motion, whose length must not be 0.
std::vector<double> DirectionOf(const JointSpace& space, const Configuration& from,
                                const Configuration& to, double length);

}  // namespace planbench
