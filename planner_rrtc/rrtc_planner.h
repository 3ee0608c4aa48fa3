#pragma once

#include <memory>

#include "common/yaml.h"
#include "planning/planner.h"

namespace planbench {

/// RRT-Connect, or the planner of OMPL that the settings name (see RrtcSettings). Throws InputError
/// for unknown keys, algorithms and parameters of OMPL's planners, and for bad values. The robot
/// must outlive the planner.
std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& settings);

}  // namespace planbench
