#pragma once

#include <memory>

#include "common/yaml.h"
#include "planning/planner.h"

namespace planbench {

/// Trajectory optimisation by the algorithm that the settings name (see TrajoptSettings), from one
/// initial guess after the other. Throws InputError for unknown keys and bad values. The robot must
/// outlive the planner.
std::unique_ptr<Planner> MakeTrajoptPlanner(const Robot& robot, const YamlNode& settings);

}  // namespace planbench
