#pragma once

#include "planning/plan_result.h"
#include "robot_model/robot_model.h"

namespace planbench {

/// Sum of L2 joint-space distances between waypoints (rad and m unweighted, continuous joints the
/// short way), as OMPL and MotionBenchMaker take it.
double PathLength(const JointSpace& space, const Path& path);

/// Smoothness as OMPL defines it (PathGeometric::smoothness): sum over inner waypoints of
/// (2 (pi - angle) / (a + b))^2 with a, b the lengths of the two segments and `angle` the angle
/// between them; 0 is smoothest. Repeated waypoints are skipped.
double PathSmoothness(const JointSpace& space, const Path& path);

}  // namespace planbench
