#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messaging/messages.h"

namespace planbench {

/// What the driver was asked to do.
struct DriverOptions {
  std::vector<std::string> sets;     ///< Empty: every set the scene server announces.
  std::vector<int> problem_indices;  ///< Empty: every problem of a set.
  std::vector<std::string> planners = {"ara", "rrtc"};
  std::vector<Direction> directions = {Direction::kForward, Direction::kBackward};
  int trials = 1;
  SessionConditions conditions;  ///< As far as they are not left to what is on the bus.
  double discovery_timeout_s = 5;
  bool skip_bad_problems = false;  ///< Go on without problems that the scene server refuses.

  bool launch = false;
  std::optional<std::filesystem::path> resume;  ///< Session folder to go on with.
  // With launch only:
  std::filesystem::path robot;
  std::vector<std::filesystem::path> problems;
  std::optional<std::filesystem::path> referee_robot;
  std::vector<std::string> package_paths;
  std::optional<std::filesystem::path> out;             ///< None: sessions/<run id>.
  std::map<std::string, std::string> planner_commands;  ///< By planner name.
  std::vector<std::pair<std::string, std::string>>
      planner_settings;  ///< Planner name, "key=value".
};

}  // namespace planbench
