#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "planning/planner.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// Builds a planner from a robot and settings; throws InputError.
using PlannerFactory =
    std::function<std::unique_ptr<Planner>(const Robot& robot, const YamlNode& settings)>;

/// A flag of one planner that stands for one of its settings: `--FLAG VALUE` is `--set KEY=VALUE`.
struct SettingFlag {
  std::string flag;  ///< "--algorithm"
  std::string key;   ///< "algorithm"
  std::string help;
};

/// The main() of a planner process: --robot, --name, --collision-models, --config, --set,
/// --package-path and what every program has. The settings come from --config, else from the file
/// that the robot folder names for `planner`, else they are the planner's defaults; --set overrides
/// single keys, and so do `setting_flags`.
int PlannerMain(int argc, char** argv, const std::string& planner, const std::string& description,
                const PlannerFactory& factory, const std::vector<SettingFlag>& setting_flags = {});

}  // namespace planbench
