#include "planning/planner_settings.h"

#include "common/name_value.h"

namespace planbench {
namespace {

YamlNode SettingsFile(const Robot& robot, const std::string& planner, const std::string& config) {
  if (!config.empty()) return YamlNode::LoadFile(config);
  const auto named = robot.planner_settings.find(planner);
  if (named != robot.planner_settings.end()) return YamlNode::LoadFile(named->second.string());
  return YamlNode::Parse("", "settings of planner " + planner);  // its own defaults
}

}  // namespace

YamlNode LoadPlannerSettings(const Robot& robot, const std::string& planner,
                             const std::string& config, const std::vector<std::string>& overrides) {
  YamlNode settings = SettingsFile(robot, planner, config);
  for (const std::string& argument : overrides) {
    const auto [key, value] = SplitNameValue(argument, "--set", "KEY=VALUE");
    settings.Override(key, value, "--set " + key);
  }
  return settings;
}

}  // namespace planbench
