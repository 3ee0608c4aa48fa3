#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"
#include "benchmark_driver/run_executor.h"
#include "benchmark_driver/session_planners.h"
#include "benchmark_driver/supervisor.h"
#include "messaging/bus.h"

namespace planbench {

/// The name of the scene server that is launched.
inline constexpr char kSceneServer[] = "scene_server";

/// Checks that every contestant has a program: planner_PROGRAM in `program_folder`, or a command.
/// Throws InputError. `line_up_then`: the file of the line-up with which what is made again was
/// made, if that is not given now.
void RequirePrograms(const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& program_folder,
                     const std::string& line_up_then = "");

/// Throws InputError if a planbench process is live on the bus: what is launched wants it for
/// itself.
void RequireEmptyBus(Bus* bus);

/// By planner, the collision models that it is asked to check with.
using ModelsByPlanner = std::map<std::string, std::set<CollisionModel>>;

/// Starts the planners as children on the bus `lcm_url`, with their output in <logs>/NAME.log; the
/// folder exists. The programs are those beside this one; each prepares its `models` (one at least)
/// alone.
void LaunchPlanners(const DriverOptions& options, const std::vector<LineUpEntry>& line_up,
                    const ModelsByPlanner& models, const std::filesystem::path& logs,
                    const std::string& lcm_url, Supervisor* supervisor);

/// The same for the scene server.
void LaunchSceneServer(const DriverOptions& options, const std::filesystem::path& logs,
                       const std::string& lcm_url, Supervisor* supervisor);

/// What was launched by these, while `supervisor` lasts.
SupervisedServer SceneServerOf(Supervisor* supervisor);
SupervisedPlanners PlannersOf(Supervisor* supervisor);

/// The same for scene server, planners and logger, with their output in <session>/logs/, which
/// exists.
void LaunchProcesses(const DriverOptions& options, const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& session_folder, const std::string& lcm_url,
                     Supervisor* supervisor);

/// Tells the supervisor which of its children are heard, so that one that stops is started again
/// (of a planner that a command started it is another process that is heard), and which come up,
/// but for the logger, which is to stay up: a request may be what they die of. And whether this
/// process is heard: a driver that announces itself.
Subscription WatchChildren(Bus* bus, const std::vector<LineUpEntry>& line_up,
                           Supervisor* supervisor);

/// Stops what was launched, when it goes at the latest: however a session ends.
class ProcessStopper {
 public:
  ProcessStopper(const std::vector<LineUpEntry>& line_up, Bus* bus, Supervisor* supervisor);
  ~ProcessStopper();
  ProcessStopper(const ProcessStopper&) = delete;
  ProcessStopper& operator=(const ProcessStopper&) = delete;

  /// Planners and scene server first, the logger last, so that it stores what was still under way.
  /// Planners of commands that are live on the bus all the same are named. Once.
  void Stop();

 private:
  std::vector<std::string> planners_;
  std::set<std::string> foreign_;  // of commands
  Bus* bus_;
  Supervisor* supervisor_;
  bool stopped_ = false;
};

}  // namespace planbench
