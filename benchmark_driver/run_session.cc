#include "benchmark_driver/run_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "benchmark_driver/driver.h"
#include "benchmark_driver/launcher.h"
#include "benchmark_driver/log_folder.h"
#include "benchmark_driver/new_session_folder.h"
#include "benchmark_driver/replay_session.h"
#include "benchmark_driver/resume.h"
#include "benchmark_driver/supervisor.h"
#include "benchmark_driver/tables.h"
#include "collision/collision_checker.h"
#include "collision/link_geometry.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/sibling_program.h"
#include "common/standard_output.h"
#include "common/write_file.h"
#include "messaging/lcm_url.h"
#include "messaging/node_announcer.h"
#include "messaging/program.h"
#include "results/compared_sessions.h"
#include "results/imported_results.h"
#include "results/reproduce.h"
#include "robot_model/robot_folder.h"
#include "robot_model/shipped_robots.h"

namespace planbench {
namespace {

void Warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

/// Says what is odd about the robots, once for all the processes that load them and as soon as it
/// is known, and returns what no other says, of the sizes of their geometry. Throws InputError if
/// the robot lacks the geometry of a contestant's collision model.
std::vector<std::string> CheckRobots(const DriverOptions& options,
                                     const std::vector<LineUpEntry>& line_up) {
  std::vector<std::string> odd_sizes;
  const auto warn_of_sizes = [&](const Robot& of, const std::vector<LinkGeometry>& links) {
    for (const std::string& line : OddSizes(of, links)) {
      if (std::ranges::find(odd_sizes, line) != odd_sizes.end()) continue;  // of both robots
      odd_sizes.push_back(line);
      Warn({line});
    }
  };
  const Robot robot = options.robot.Load();
  Warn(robot.warnings);
  std::set<CollisionModel> checked;
  for (const LineUpEntry& entry : line_up) {
    const CollisionModel model = options.ModelOf(entry);
    if (!checked.insert(model).second) continue;
    try {
      if (model == CollisionModel::kMeshes) {
        // Without the time and the memory that a checker of it takes.
        const std::vector<LinkGeometry> links = LoadLinkGeometry(robot);
        warn_of_sizes(robot, links);
        RequireSolid(robot, links);
      } else {
        MakeCollisionChecker(robot, robot.Group(""), model);
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("--collision-model {} (of '{}'): {}", EnumName(model),
                                   entry.contestant.planner, error.what()));
    }
  }
  if (options.referee_robot) {
    const Robot referee = LoadRefereeRobot(*options.referee_robot, robot, options.robot.Packages());
    Warn(referee.warnings);
    warn_of_sizes(referee, LoadLinkGeometry(referee));
  }
  return odd_sizes;
}

std::vector<StoredSession> ReadReferences(const DriverOptions& options) {
  std::vector<StoredSession> references;
  std::vector<std::string> warnings;
  for (const auto& [name, file] : options.references) {
    references.push_back(
        ImportResults(file, name, options.conditions.request.time_limit_s, &warnings));
  }
  Warn(warnings);
  return references;
}

/// Throws InputError for results that would be taken for those of a contestant or of another file,
/// or that would be in no table.
std::vector<Attempt> AttemptsOf(const DriverOptions& options, std::vector<StoredSession> references,
                                const SessionConditions& conditions) {
  ProblemsBySet problems;  // of which the tables take those that have runs
  for (const auto& [set, content] : conditions.problem_sets) problems[set];
  std::vector<std::string> warnings;
  for (StoredSession& reference : references) KeepProblems(problems, &reference, &warnings);
  Warn(warnings);
  std::vector<std::string> names;
  for (const auto& [name, file] : options.references) names.push_back(name);
  references = JoinImports(names, std::move(references));
  std::set<std::string> contestants;
  for (const Contestant& contestant : conditions.contestants) contestants.insert(contestant.name);
  RequireOtherNames(contestants, references);
  std::vector<Attempt> attempts;
  for (const StoredSession& reference : references) {
    for (const StoredRun& run : reference.runs) {
      attempts.push_back(AttemptOf(run, reference.contestants[run.contestant].name));
    }
  }
  return attempts;
}

/// Leaves processors to the planners.
void KeepOff(const std::vector<int>& pinned) {
  std::vector<int> others = UsableProcessors();
  std::erase_if(others, [&](int processor) {
    return std::binary_search(pinned.begin(), pinned.end(), processor);
  });
  if (!UseProcessors(others)) throw std::runtime_error("--pin: the processors cannot be chosen");
}

void WriteTables(const std::filesystem::path& file, const std::string& tables) {
  try {
    WriteFile(file, tables);
  } catch (const InputError& error) {
    spdlog::error("{}", error.what());
  }
}

}  // namespace

int RunSession(const DriverOptions& given_options, const std::map<std::string, std::string>& flags,
               const std::string& lcm_url, bool lcm_url_given,
               const std::function<bool()>& interrupted) {
  DriverOptions options = given_options;
  std::string& run_id = options.conditions.request.run_id;
  run_id = NewRunId();
  if (options.replay) {
    return ReplaySession(options, run_id, lcm_url, lcm_url_given, interrupted);
  }
  EarlierSession earlier;
  if (options.resume) {
    if (options.launch) AwaitLoggersEnd(*options.resume);
    earlier = ReadEarlierSession(*options.resume);
    if (!earlier.sessions.empty()) run_id = earlier.sessions.back().run_id;
  }

  // By which it goes on that was planned before.
  const auto earlier_flags = earlier.sessions.empty() ? std::map<std::string, std::string>()
                                                      : earlier.sessions.back().settings;

  std::vector<StoredSession> references = ReadReferences(options);
  std::string url = lcm_url;
  std::filesystem::path session_folder;
  const std::vector<LineUpEntry> line_up = MakeLineUp(
      options.line_up,
      options.launch ? std::optional(FindRobotFolder(options.robot.folder)) : std::nullopt);
  if (options.conditions.parallel) RequireNoFirstPaths(line_up);
  if (options.launch) {
    RequirePrograms(line_up, ProgramFolder());
    options.robot_warnings = CheckRobots(options, line_up);
    if (!lcm_url_given) url = LcmUrl(FreeUdpPort());
    session_folder = options.resume ? *options.resume
                     : options.out  ? *options.out
                                    : std::filesystem::path("sessions") / run_id;
    session_folder = std::filesystem::absolute(session_folder).lexically_normal();
    // Whose disk has to have room for them anyway.
    options.record_folder = session_folder;
  }

  if (!options.pinned.empty()) KeepOff(options.pinned);
  Bus bus(url);
  // Goes, if it has to, when nobody writes there any more.
  std::optional<NewSessionFolder> new_folder;
  if (options.launch && !options.resume) new_folder.emplace(session_folder);
  if (options.launch && options.resume) {
    MakeLogFolder(session_folder);  // merged sessions have none, nor those of a logger by itself
    RequireWritableLogs(session_folder);
  }
  // Declared before what uses the processes, so that they are stopped last, whatever is thrown.
  std::unique_ptr<Supervisor> supervisor;
  std::optional<ProcessStopper> stopper;
  bus.Start();
  if (options.launch) {
    if (lcm_url_given) RequireEmptyBus(&bus);
    supervisor = std::make_unique<Supervisor>();
    stopper.emplace(line_up, &bus, supervisor.get());
    LaunchProcesses(options, line_up, session_folder, url, supervisor.get());
  }

  NodeStatusMessage self = MakeNodeStatus("driver", NodeKind::kDriver);
  self.settings = DescribeMachine(options.kernel);
  if (!options.pinned.empty()) {
    self.settings["planners' processors"] = fmt::format("{}", fmt::join(options.pinned, ","));
  }
  NodeAnnouncer announcer(&bus, [&] { return self; });
  const auto watch = [&] {
    announcer.ThrowIfDisplaced();
    if (supervisor) supervisor->ThrowIfHopeless();
    if (interrupted()) throw std::runtime_error("interrupted");
  };
  std::set<std::string> planners;
  for (const LineUpEntry& entry : line_up) planners.insert(entry.contestant.planner);
  Subscription children;
  std::optional<SupervisedServer> server;
  SupervisedPlanners supervised;
  if (supervisor) {
    children = WatchChildren(&bus, line_up, supervisor.get());
    server = SceneServerOf(supervisor.get());
    supervised = PlannersOf(supervisor.get());
  }
  Driver driver(&bus, options, line_up, flags, std::move(earlier));
  driver.Discover(options.launch, watch, std::move(server), {}, std::move(supervised));
  announcer.AwaitPlace();
  const std::vector<Attempt> reference_attempts =
      AttemptsOf(options, std::move(references), driver.conditions());
  if (new_folder) new_folder->Keep();
  if (options.launch) spdlog::info("session folder {}, bus {}", session_folder.string(), url);
  // A folder that was removed or moved is not gone on with there.
  const auto tell_how_to_go_on = [&] {
    std::error_code ignored;
    if (!supervisor || !std::filesystem::exists(session_folder, ignored)) return;
    WriteOut(fmt::format("Go on with: {}\n", ResumingCommand(flags, session_folder)));
  };
  bool complete = false;
  try {
    complete = driver.Run(interrupted, [&] {
      announcer.ThrowIfDisplaced();
      if (!supervisor) return;
      supervisor->ThrowIfHopeless(planners);
      for (const auto& [name, reason] : supervisor->Hopeless()) driver.GiveUp(name, reason);
    });
  } catch (...) {
    tell_how_to_go_on();
    throw;
  }

  const int num_missing = driver.num_runs() - static_cast<int>(driver.runs().size());
  const SessionTables tables =
      MakeTables(driver.conditions(), driver.runs(), reference_attempts, num_missing,
                 driver.left_out(), driver.num_owed(), driver.num_to_repeat(),
                 options.problems_per_process, driver.referee_misfits());
  if (stopper) {
    stopper->Stop();
    WriteTables(session_folder / "tables.txt", tables.full);
    WriteOut(fmt::format("Session folder: {}\n", session_folder.string()));
  }
  if (interrupted()) WriteOut("Interrupted: what follows is incomplete.\n");
  if (!complete || driver.num_not_asked() > driver.num_unjudgeable()) tell_how_to_go_on();
  WriteOut(fmt::format("\n{}", tables.brief));
  std::fflush(stdout);
  for (const std::string& line : driver.Shortcomings()) spdlog::error("{}", line);
  for (const std::string& line : driver.UnaskedRunLines()) spdlog::error("{}", line);
  if (const int number = driver.num_not_asked(); supervisor && number > 0 && !interrupted()) {
    spdlog::warn("{} could not be asked for or judged: {}",
                 number == 1 ? "1 run" : fmt::format("{} runs", number),
                 WhatMakesThem(number, driver.num_unjudgeable()));
  }
  if (driver.num_owed() > 0 || driver.num_owed_repeats() > 0) {
    spdlog::warn(
        "{}",
        DescribeOwed(driver.num_owed(), driver.num_owed_unjudgeable(), driver.num_owed_repeats(),
                     ResumingCommand(earlier_flags, std::filesystem::absolute(*options.resume))));
  }
  if (const std::vector<std::string>& awaited = driver.awaited_shards(); !awaited.empty()) {
    spdlog::warn("the session is not finished; shards missing: {}", fmt::join(awaited, "; "));
  }
  const bool made_all = complete && driver.num_not_asked() == 0 && driver.given_up().empty();
  return made_all ? kExitOk : kExitFailed;
}

}  // namespace planbench
