#include "benchmark_driver/replay_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark_driver/await_nodes.h"
#include "benchmark_driver/launcher.h"
#include "benchmark_driver/machine.h"
#include "benchmark_driver/new_session_folder.h"
#include "benchmark_driver/replay.h"
#include "benchmark_driver/supervisor.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/file_kind.h"
#include "common/lookup.h"
#include "common/sibling_program.h"
#include "common/standard_output.h"
#include "messaging/lcm_url.h"
#include "messaging/node_announcer.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"
#include "robot_model/shipped_robots.h"

namespace planbench {
namespace {

/// What the flags leave open: the planners of the log, started by the commands of then.
void Complete(const std::vector<SessionMessage>& sessions, const std::vector<std::string>& asked,
              LineUpFlags* flags) {
  if (flags->planners.empty()) flags->planners = asked;
  if (flags->file || sessions.empty()) return;
  for (const Contestant& contestant : sessions.back().conditions.contestants) {
    const auto is_it = [&](const auto& command) { return command.first == contestant.planner; };
    if (!contestant.command.empty() &&
        std::find(flags->planners.begin(), flags->planners.end(), contestant.planner) !=
            flags->planners.end() &&
        std::none_of(flags->commands.begin(), flags->commands.end(), is_it)) {
      flags->commands.emplace_back(contestant.planner, contestant.command);
    }
  }
}

/// Of the session that the log tells of last; nothing if it does not tell, or of all.
std::optional<int> ProblemsPerProcess(const RecordedSession& recorded) {
  if (recorded.sessions.empty()) return std::nullopt;
  const std::string text =
      Lookup(recorded.sessions.back().settings, "problems-per-process").value_or("");
  const char* const end = text.data() + text.size();
  int problems = 0;
  const auto [last, error] = std::from_chars(text.data(), end, problems);
  const bool is_number = error == std::errc() && last == end && problems > 0;
  return is_number ? std::optional(problems) : std::nullopt;
}

}  // namespace

int ReplaySession(const DriverOptions& given_options, const std::string& run_id,
                  const std::string& lcm_url, bool lcm_url_given,
                  const std::function<bool()>& interrupted) {
  DriverOptions options = given_options;
  const std::filesystem::path& given = options.replay.value();
  const std::filesystem::path log = IsFolder(given) ? FindEventLog(given) : given;
  if (!IsFile(log)) throw InputError(log.string() + ": there is no such event log");
  RecordedSession recorded = ReadRecords(log);
  std::map<std::string, Scene> scenes = ReadScenes(log, &recorded.passed_over);
  for (const std::string& line : recorded.passed_over) spdlog::warn("{}", line);
  const std::string cpu = DescribeMachine(options.kernel).at("cpu");
  if (const auto line = DescribeInstructionDifference(recorded.sessions, cpu)) {
    spdlog::warn("--replay: {}", *line);
  }
  // All at once: what is made again is compared with it, path by path.
  std::vector<RunRecordMessage> runs;
  for (const RecordedRun& run : recorded.runs) runs.push_back(ReadRecord(run.place));
  const std::vector<std::string> asked = PlannersAsked(runs);
  if (asked.empty()) {
    throw InputError(log.string() + ": holds no run that could be made again");
  }
  const std::vector<std::string> missing_runs = MissingRuns(log.string(), recorded);
  Complete(recorded.sessions, asked, &options.line_up);
  std::vector<LineUpEntry> line_up = MakeLineUp(
      options.line_up,
      options.launch ? std::optional(FindRobotFolder(options.robot.folder)) : std::nullopt);
  // First paths are in the requests.
  std::erase_if(line_up, [](const LineUpEntry& entry) { return entry.finds_first_paths_only; });
  ModelsByPlanner models;
  for (const RunRecordMessage& run : runs) {
    models[run.planner].insert(run.request.collision_model);
  }
  std::vector<std::string> planners;
  for (const LineUpEntry& entry : line_up) planners.push_back(entry.contestant.planner);

  std::string url = lcm_url;
  std::filesystem::path folder;
  if (options.launch) {
    const bool tells_line_up = !options.line_up.file && !recorded.sessions.empty();
    RequirePrograms(
        line_up, ProgramFolder(),
        tells_line_up ? Lookup(recorded.sessions.back().settings, "lineup").value_or("") : "");
    if (!lcm_url_given) url = LcmUrl(FreeUdpPort());
    folder = options.out.value_or(std::filesystem::path("sessions") / run_id);
    folder = std::filesystem::absolute(folder).lexically_normal();
  }
  Bus bus(url);
  NodeRegistry registry(&bus);
  // Declared before what uses the processes, so that they are stopped last, whatever is thrown.
  std::optional<NewSessionFolder> new_folder;
  std::optional<Supervisor> supervisor;
  Replay replay(&bus, &registry, run_id, std::move(runs), std::move(scenes), planners,
                std::max(PlannerClient::Terms().patience, options.TimeToComeBack()),
                options.launch ? ProblemsPerProcess(recorded) : std::nullopt,
                [&](const std::string& planner) { supervisor->Renew(planner); });
  if (options.launch) new_folder.emplace(folder);
  std::optional<ProcessStopper> stopper;
  Subscription children;
  bus.Start();
  if (options.launch) {
    if (lcm_url_given) RequireEmptyBus(&bus);
    supervisor.emplace();
    children = WatchChildren(&bus, line_up, &*supervisor);
    stopper.emplace(line_up, &bus, &*supervisor);
    // The driver hands out the log's scenes; a planner may need more of a scene server than that.
    if (!options.problems.empty()) LaunchSceneServer(options, folder / "logs", url, &*supervisor);
    LaunchPlanners(options, line_up, models, folder / "logs", url, &*supervisor);
  }
  const NodeStatusMessage self = MakeNodeStatus("driver", NodeKind::kDriver);
  const NodeAnnouncer announcer(&bus, [&] { return self; });
  const auto stop = [&] {
    announcer.ThrowIfDisplaced();
    if (supervisor) supervisor->ThrowIfHopeless();
    return interrupted();
  };
  AwaitNodes(
      &registry, options.DiscoveryTimeout(),
      [&] {
        std::vector<std::string> missing;
        for (const std::string& planner : planners) {
          if (registry.Find(planner, NodeKind::kPlanner)) continue;
          missing.push_back("a planner named '" + planner + "'");
        }
        const bool may_lack_server = options.launch && options.problems.empty() && !missing.empty();
        return fmt::format("{}{}", fmt::join(missing, ", "),
                           may_lack_server ? " (one that needs a scene server: --problems, as the "
                                             "session had it, starts that too)"
                                           : "");
      },
      [&] {
        if (stop()) throw std::runtime_error("interrupted");
      });
  announcer.AwaitPlace();
  if (new_folder) new_folder->Keep();

  const bool agree = replay.Run(stop, [](const std::string& line) {
    WriteOut(fmt::format("{}\n", line));
    std::fflush(stdout);
  });
  if (stopper) stopper->Stop();
  if (interrupted()) WriteOut("Interrupted: what follows is incomplete.\n");
  WriteOut(fmt::format("\n{}", replay.Table()));
  for (const std::string& line : missing_runs) WriteOut(fmt::format("{}\n", line));
  std::fflush(stdout);
  return agree ? kExitOk : kExitFailed;
}

}  // namespace planbench
