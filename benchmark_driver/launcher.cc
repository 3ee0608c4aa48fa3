#include "benchmark_driver/launcher.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include "common/error.h"
#include "common/sibling_program.h"
#include "messaging/channels.h"
#include "messaging/node_registry.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

constexpr char kLogger[] = "logger";

/// Shell text that runs the command $1 and ends as it ends. When told to end, as the kernel does
/// when the driver is killed, it passes that on to its whole group: the kernel knows the driver's
/// children only, and a command may have children of its own. Those that do not end then are killed
/// 3 s later if the driver, who would do it, has gone: then this shell has another parent.
constexpr char kRunCommand[] = R"(
sh -c "$1" &
child=$!
trap 'trap : TERM
  kill -TERM 0
  (sleep 3
  { read -r _ _ _ parent _ </proc/$$/stat; } 2>/dev/null
  [ "$parent" = "$PPID" ] || kill -KILL 0) &' TERM
while :; do
  wait "$child"
  code=$?
  # Waiting also ends when the trap has run.
  kill -0 "$child" 2>/dev/null || exit "$code"
done)";

constexpr std::string_view kPlannerPrefix = "planner_";

/// Names of the planners whose programs are in `folder`, ascending.
std::set<std::string> PlannersIn(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with(kPlannerPrefix)) names.insert(file.substr(kPlannerPrefix.size()));
  }
  return names;
}

std::string Program(const std::string& name) { return SiblingProgram(name).string(); }

ChildSpec Child(const std::string& name, std::vector<std::string> arguments,
                const std::filesystem::path& logs, const std::string& lcm_url) {
  return {name, std::move(arguments), {{"LCM_DEFAULT_URL", lcm_url}}, logs / (name + ".log")};
}

std::vector<std::string> WithRobot(const std::string& program, const RobotFlags& robot) {
  std::vector<std::string> arguments = robot.Arguments();
  arguments.insert(arguments.begin(), Program(program));
  return arguments;
}

/// Every process of planbench that is heard on the bus within `patience`.
std::vector<NodeStatusMessage> WhoAnswers(Bus* bus, std::chrono::milliseconds patience) {
  NodeRegistry registry(bus);
  registry.Discover("driver");
  std::this_thread::sleep_for(patience);
  return registry.Live();
}

std::string Named(const NodeStatusMessage& node) {
  return fmt::format("{} '{}' (host {}, pid {})", EnumName(node.kind), node.name, node.host,
                     node.pid);
}

}  // namespace

void RequirePrograms(const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& program_folder, const std::string& line_up_then) {
  const std::set<std::string> known = PlannersIn(program_folder);
  for (const LineUpEntry& entry : line_up) {
    if (!entry.contestant.command.empty() || known.contains(entry.program)) continue;
    const std::string advice =
        line_up_then.empty() ? fmt::format("others are started by --planner-command {}=COMMAND",
                                           entry.contestant.planner)
                             : fmt::format("the session was made with --lineup {}: give it again",
                                           ShellQuoted(line_up_then));
    throw InputError(fmt::format("unknown planner '{}'; known are: {}; {}", entry.program,
                                 fmt::join(known, ", "), advice));
  }
}

void RequireEmptyBus(Bus* bus) {
  const std::vector<NodeStatusMessage> live = WhoAnswers(bus, std::chrono::milliseconds(700));
  if (live.empty()) return;
  throw InputError(
      fmt::format("another session is on {}: the {} is live; choose another port with --lcm-url, "
                  "or leave it to --launch",
                  bus->url(), Named(live.front())));
}

void LaunchPlanners(const DriverOptions& options, const std::vector<LineUpEntry>& line_up,
                    const ModelsByPlanner& models, const std::filesystem::path& logs,
                    const std::string& lcm_url, Supervisor* supervisor) {
  for (const LineUpEntry& entry : line_up) {
    const std::string& planner = entry.contestant.planner;
    std::vector<std::string> arguments;
    if (!entry.contestant.command.empty()) {
      arguments = {"/bin/sh", "-c", kRunCommand, "sh", entry.contestant.command};
    } else {
      arguments = WithRobot(std::string(kPlannerPrefix) + entry.program, options.robot);
      std::vector<std::string_view> its_models;
      for (const CollisionModel model : models.at(planner)) its_models.push_back(EnumName(model));
      arguments.insert(arguments.end(), {"--name", planner, "--collision-models",
                                         fmt::format("{}", fmt::join(its_models, ","))});
      if (entry.config) arguments.insert(arguments.end(), {"--config", entry.config->string()});
      for (const std::string& setting : entry.settings) {
        arguments.insert(arguments.end(), {"--set", setting});
      }
      for (const auto& [key, origin] : entry.origins) {
        arguments.insert(arguments.end(), {"--set-origin", key + "=" + origin});
      }
    }
    ChildSpec child = Child(planner, std::move(arguments), logs, lcm_url);
    child.processors = options.pinned;
    supervisor->Start(std::move(child));
  }
}

void LaunchSceneServer(const DriverOptions& options, const std::filesystem::path& logs,
                       const std::string& lcm_url, Supervisor* supervisor) {
  std::vector<std::string> server = WithRobot(kSceneServer, options.robot);
  for (const std::filesystem::path& folder : options.problems) {
    server.insert(server.end(), {"--problems", folder.string()});
  }
  if (options.referee_robot) {
    server.insert(server.end(), {"--referee-robot", options.referee_robot->string()});
    if (options.allow_standing_contacts) server.emplace_back("--allow-standing-contacts");
  }
  supervisor->Start(Child(kSceneServer, std::move(server), logs, lcm_url));
}

SupervisedServer SceneServerOf(Supervisor* supervisor) {
  return {[supervisor] { return supervisor->NumFailuresAtWork(kSceneServer); },
          [supervisor] { supervisor->StartAgain(kSceneServer); }};
}

SupervisedPlanners PlannersOf(Supervisor* supervisor) {
  return {[supervisor](const std::string& planner) { supervisor->Renew(planner); },
          [supervisor](const std::string& planner, auto since) {
            return supervisor->HowEnded(planner, since);
          }};
}

void LaunchProcesses(const DriverOptions& options, const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& session_folder, const std::string& lcm_url,
                     Supervisor* supervisor) {
  const std::filesystem::path logs = session_folder / "logs";

  ChildSpec logger =
      Child(kLogger, {Program("logger"), "--out", session_folder.string()}, logs, lcm_url);
  if (options.resume) logger.arguments.emplace_back("--resume");
  logger.when_again = {"--resume"};
  supervisor->Start(std::move(logger));

  LaunchSceneServer(options, logs, lcm_url, supervisor);
  ModelsByPlanner models;
  for (const LineUpEntry& entry : line_up) {
    models[entry.contestant.planner] = {options.ModelOf(entry)};
  }
  LaunchPlanners(options, line_up, models, logs, lcm_url, supervisor);
}

Subscription WatchChildren(Bus* bus, const std::vector<LineUpEntry>& line_up,
                           Supervisor* supervisor) {
  // Whether they are started by a command: then the child is another process.
  std::map<std::pair<NodeKind, std::string>, bool> children;
  children[{NodeKind::kSceneServer, kSceneServer}] = false;
  children[{NodeKind::kLogger, kLogger}] = false;
  for (const LineUpEntry& entry : line_up) {
    children[{NodeKind::kPlanner, entry.contestant.planner}] = !entry.contestant.command.empty();
  }
  return bus->Subscribe<NodeStatusMessage>(
      channel::kNodeStatus,
      [supervisor, children = std::move(children),
       instances = std::map<std::string, std::string>()](const NodeStatusMessage& status) mutable {
        const auto pid = static_cast<pid_t>(status.pid);
        if (status.kind == NodeKind::kDriver && pid == getpid()) supervisor->HeardMyself();
        const auto child = children.find({status.kind, status.name});
        if (child == children.end()) return;
        std::string& instance = instances[status.name];
        const bool is_new = std::exchange(instance, status.instance) != status.instance;
        if (is_new && status.kind != NodeKind::kLogger) {
          supervisor->CameUp(status.name, child->second ? std::nullopt : std::optional(pid));
        }
        supervisor->Heard(status.name, pid);
      });
}

ProcessStopper::ProcessStopper(const std::vector<LineUpEntry>& line_up, Bus* bus,
                               Supervisor* supervisor)
    : bus_(bus), supervisor_(supervisor) {
  for (const LineUpEntry& entry : line_up) {
    planners_.push_back(entry.contestant.planner);
    if (!entry.contestant.command.empty()) foreign_.insert(entry.contestant.planner);
  }
}

ProcessStopper::~ProcessStopper() {
  try {
    Stop();
  } catch (const std::exception& error) {
    spdlog::error("what still runs is not known: {}", error.what());
  }
}

void ProcessStopper::Stop() {
  if (std::exchange(stopped_, true)) return;
  std::vector<std::string> order = planners_;
  order.insert(order.end(), {kSceneServer, kLogger});
  supervisor_->StopAll(order);
  // Our own do not leave their process group: there is nobody to wait for.
  if (foreign_.empty()) return;
  // Four of its announcements, however loaded the machine is.
  for (const NodeStatusMessage& node : WhoAnswers(bus_, std::chrono::seconds(2))) {
    if (node.kind != NodeKind::kPlanner || !foreign_.contains(node.name)) continue;
    spdlog::warn("the {} still runs: its command has taken it out of its process group; end it",
                 Named(node));
  }
}

}  // namespace planbench
