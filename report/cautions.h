#pragma once

#include <string>
#include <vector>

#include "results/compared_sessions.h"

namespace planbench {

/// What a reader has to know of how the sessions were measured: runs that are missing, planners
/// that worked at once, contestants that have learned from what they are tried on, whose times are
/// odd, or whose simplified paths were rejected.
std::vector<std::string> Cautions(const ComparedSessions& compared);

/// What confirmed paths are worth on the robot's true geometry, where no robot with meshes judged
/// them besides: by what collision model each contestant's were planned and judged.
std::string WithoutMeshRobot(const ComparedSessions& compared);

}  // namespace planbench
