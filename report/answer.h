#pragma once

#include <string>
#include <vector>

#include "report/tables.h"

namespace planbench {

/// What the sessions say, in at most three sentences: who comes out best, by how much, and how sure
/// that is; in more, of the best and the next, what of it is no test because it has learned from
/// the set, and that its answers came much later than its times account for.
/// `pairs` as ComparePairs gives them.
std::vector<std::string> Answer(const ComparedSessions& compared,
                                const std::vector<ComparedPair>& pairs);

/// What a reader has to know of how the sessions were measured: runs that are missing, planners
/// that worked at once, contestants that have learned from what they are tried on, whose times are
/// odd, or whose simplified paths were rejected.
std::vector<std::string> Cautions(const ComparedSessions& compared);

/// What confirmed paths are worth on the robot's true geometry, where no robot with meshes judged
/// them besides: by what collision model each contestant's were planned and judged.
std::string WithoutMeshRobot(const ComparedSessions& compared);

}  // namespace planbench
