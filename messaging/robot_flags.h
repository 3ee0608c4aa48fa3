#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// The flags that say which robot a process has: --robot, --spheres, --package-path.
struct RobotFlags {
  std::filesystem::path folder;  ///< Or the name of a robot that ships.
  std::filesystem::path spheres;
  std::vector<std::string> package_paths;

  /// Returns the three options, --robot first.
  std::vector<CLI::Option*> AddTo(CLI::App* app);
  /// --package-path alone.
  CLI::Option* AddPackagePaths(CLI::App* app);
  std::map<std::string, std::filesystem::path> Packages() const;
  /// Throws InputError as LoadRobot and ParsePackagePaths do.
  Robot Load() const { return LoadRobot(folder, Packages(), spheres); }
  /// The same, as arguments of another process.
  std::vector<std::string> Arguments() const;
};

}  // namespace planbench
