#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_model.h"
#include "planning/plan_status.h"
#include "robot_model/edge_check.h"

namespace planbench {

/// What the driver was asked to do.
struct DriverOptions {
  std::vector<std::string> sets;     ///< Empty: every set the scene server announces.
  std::vector<int> problem_indices;  ///< Empty: every problem of a set.
  std::vector<std::string> planners = {"ara", "rrtc"};
  std::vector<Direction> directions = {Direction::kForward, Direction::kBackward};
  double time_limit_s = 60;
  int trials = 1;
  std::uint64_t seed = 1;
  CollisionModel collision_model = CollisionModel::kSpheres;
  double edge_resolution_m = 0;         ///< 0: the robot's.
  std::optional<EdgeCheck> edge_check;  ///< None: the robot's.
  double referee_step_m = 0;            ///< 0: half the edge resolution.
  bool anytime = false;
  bool simplify = true;
  bool clearance = true;
  bool parallel = false;
  double discovery_timeout_s = 5;

  bool launch = false;
  std::filesystem::path resume;  ///< Session folder to go on with; empty: a new session.
  // With launch only:
  std::filesystem::path robot;
  std::vector<std::filesystem::path> problems;
  std::filesystem::path referee_robot;
  std::vector<std::string> package_paths;
  std::filesystem::path out;                            ///< Empty: sessions/<run id>.
  std::map<std::string, std::string> planner_commands;  ///< By planner name.
  std::vector<std::pair<std::string, std::string>>
      planner_settings;  ///< Planner name, "key=value".
};

}  // namespace planbench
