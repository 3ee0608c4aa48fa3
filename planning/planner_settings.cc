#include "planning/planner_settings.h"

#include <map>

#include "common/name_value.h"
#include "common/named_file.h"

namespace planbench {
namespace {

YamlNode SettingsFile(const Robot& robot, const std::string& planner, const std::string& config) {
  if (!config.empty()) return YamlNode::LoadFile(config);
  const auto named = robot.planner_settings.find(planner);
  if (named != robot.planner_settings.end()) {
    const NamedFile file = ReadNamedFile(named->second, robot.folder);
    return YamlNode::Parse(file.text, file.path.string());
  }
  return YamlNode::Parse("", "settings of planner " + planner);  // its own defaults
}

}  // namespace

YamlNode LoadPlannerSettings(const Robot& robot, const std::string& planner,
                             const std::string& config, const std::vector<std::string>& overrides,
                             const std::vector<std::string>& origins) {
  std::map<std::string, std::string> origin_of;
  for (const std::string& origin : origins) {
    origin_of.insert(SplitNameValue(origin, "--set-origin", "KEY=ORIGIN"));
  }
  YamlNode settings = SettingsFile(robot, planner, config);
  for (const std::string& argument : overrides) {
    const auto [key, value] = SplitNameValue(argument, "--set", "KEY=VALUE");
    settings.Override(key, value, origin_of.try_emplace(key, "--set " + key).first->second);
  }
  return settings;
}

}  // namespace planbench
