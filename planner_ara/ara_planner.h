#pragma once

#include <memory>

#include "common/yaml.h"
#include "planning/planner.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// The ARA* planner: an anytime search (AraStar) over a lattice of motion primitives anchored at
/// the start (ManipulationGraph). `settings` is the robot's ara.yaml, see AraSettings; a request's
/// parameters are laid over it. SearchResult::cost is in the graph's unit, SearchResult::epsilon
/// the proven bound of that cost against the best path of the graph. Throws InputError for settings
/// that cannot be used with the robot's first group; other groups are looked at when a request
/// names them. The robot must outlive the planner.
std::unique_ptr<Planner> MakeAraPlanner(const Robot& robot, const YamlNode& settings);

}  // namespace planbench
