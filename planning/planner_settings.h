#pragma once

#include <string>
#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// Settings of `planner`: of the file `config`, else (empty) of the one that the robot folder names
/// for it, else none, which leaves all defaults; single keys are overridden by `overrides`,
/// arguments KEY=VALUE of the flag --set, KEY as YamlNode::Override has it. Messages about the
/// value of a key begin with what `origins` (KEY=ORIGIN) has for it, else with "--set KEY". Throws
/// InputError.
YamlNode LoadPlannerSettings(const Robot& robot, const std::string& planner,
                             const std::string& config, const std::vector<std::string>& overrides,
                             const std::vector<std::string>& origins = {});

}  // namespace planbench
