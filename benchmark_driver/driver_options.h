#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_driver/line_up.h"
#include "benchmark_driver/machine.h"
#include "benchmark_driver/supervisor.h"
#include "messaging/messages.h"
#include "messaging/robot_flags.h"
#include "results/session_plan.h"

namespace planbench {

/// What the driver was asked to do.
struct DriverOptions {
  std::vector<std::string> sets;     ///< Empty: every set the scene server announces.
  std::vector<int> problem_indices;  ///< Empty: every problem of a set.
  LineUpFlags line_up;
  Directions directions = Directions::kAuto;  ///< Of contestants that say nothing else.
  int trials = 1;
  Shard shard;
  SessionConditions conditions;  ///< As far as they are not left to what is on the bus.
  /// By which the planner is asked to check for collisions: the contestant's, or the session's.
  CollisionModel ModelOf(const LineUpEntry& entry) const {
    return entry.contestant.collision_model.value_or(conditions.request.collision_model);
  }
  /// Children may take their time to load meshes, and one that fails is heard of at once.
  std::optional<double> discovery_timeout_s;
  double DiscoveryTimeout() const { return discovery_timeout_s.value_or(launch ? 60 : 5); }
  /// How long one that is started again may not be live: as long as the first one had to come up,
  /// after the silence for which one that is launched is killed.
  std::chrono::milliseconds TimeToComeBack() const {
    return std::chrono::ceil<std::chrono::milliseconds>(
               std::chrono::duration<double>(DiscoveryTimeout())) +
           (launch ? Supervisor::kMostSilence : std::chrono::seconds(0));
  }
  bool skip_bad_problems = false;  ///< Go on without problems that the scene server refuses.
  /// Share of a run's time beyond which what kept its planner from working makes it a disturbed
  /// one.
  double max_disturbance = 0.1;
  bool repeat_disturbed = false;  ///< At the end, in the place of what was disturbed.
  /// After which a planner's process makes room for a new one, with launch only; nothing: never.
  std::optional<int> problems_per_process;
  KernelFolders kernel;

  /// Results from elsewhere to stand in the tables: name, file (results/imported_results.h).
  std::vector<std::pair<std::string, std::string>> references;

  /// Where records wait for loggers to come, beyond what memory holds.
  std::filesystem::path record_folder = "/tmp";

  std::optional<std::filesystem::path> replay;  ///< Log or folder of a session to replay.

  bool launch = false;
  std::optional<std::filesystem::path> resume;  ///< Session folder to go on with.
  // With launch only:
  RobotFlags robot;
  std::vector<std::filesystem::path> problems;
  std::optional<std::filesystem::path> referee_robot;
  std::vector<std::string> robot_warnings;  ///< What the scene server does not find odd itself.
  bool allow_standing_contacts = false;     ///< Of the referee's robot.
  std::vector<int> pinned;  ///< Processors of the planners, which nothing else uses; empty: all.
  std::optional<std::filesystem::path> out;  ///< None: sessions/<run id>; a replay's: none.
};

}  // namespace planbench
