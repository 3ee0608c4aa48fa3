#include "benchmark_driver/driver_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "collision/collision_model.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/name_value.h"
#include "planning/path_judge.h"
#include "results/recorded_flags.h"
#include "results/session_plan.h"
#include "robot_model/shipped_robots.h"

namespace planbench {
namespace {

/// A flag that takes the names of an enum.
template <typename Enum, typename Target>
CLI::Option* AddEnum(CLI::App* app, const std::string& flag, Target* target,
                     const std::string& help) {
  std::vector<std::string> names;
  for (const Enum value : EnumValues<Enum>()) names.emplace_back(EnumName(value));
  return app
      ->add_option_function<std::string>(
          flag, [target](const std::string& name) { *target = ParseEnum<Enum>(name).value(); },
          help)
      ->check(CLI::IsMember(names));
}

/// A flag that takes names with commas between, no two alike; `take` gets them.
template <typename Take>
CLI::Option* AddNames(CLI::App* app, const std::string& flag, Take take, const std::string& help) {
  const auto take_distinct = [flag, take](const std::vector<std::string>& names) {
    std::set<std::string> seen;
    for (const std::string& name : names) {
      if (name.empty()) throw InputError(flag + ": a name is empty");
      if (!seen.insert(name).second) throw InputError(flag + ": '" + name + "' occurs twice");
    }
    take(names);
  };
  return app->add_option_function<std::vector<std::string>>(flag, take_distinct, help)
      ->delimiter(',')
      ->allow_extra_args(false);
}

int ParseIndex(const std::string& text, const std::string& whole, const std::string& flag) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) {
    throw InputError(flag + " " + whole + ": '" + text + "' is no number");
  }
  return value;
}

void TakeCommands(const std::vector<std::string>& commands, LineUpFlags* line_up) {
  for (const std::string& command : commands) {
    line_up->commands.push_back(SplitNameValue(command, "--planner-command"));
  }
}

void TakeSettings(const std::vector<std::string>& settings, LineUpFlags* line_up) {
  for (const std::string& setting : settings) {
    constexpr char kForm[] = "NAME.KEY=VALUE";
    const std::string key = SplitNameValue(setting, "--set", kForm).first;
    const std::size_t dot = key.find('.');
    if (dot == 0 || dot == std::string::npos || dot + 1 == key.size()) {
      throw InputError("--set '" + setting + "': expected " + kForm);
    }
    line_up->settings.emplace_back(setting.substr(0, dot), setting.substr(dot + 1));
  }
}

/// Processors that this process may use, some to be left for all but the planners.
std::vector<int> ParsePin(const std::string& text) {
  std::vector<int> processors = ParseRange(text, "--pin");
  const std::vector<int> usable = UsableProcessors();
  for (const int processor : processors) {
    if (!std::binary_search(usable.begin(), usable.end(), processor)) {
      throw InputError(fmt::format("--pin {}: there is no processor {}; usable are {}", text,
                                   processor, fmt::join(usable, ",")));
    }
  }
  if (processors.size() == usable.size()) {
    throw InputError("--pin " + text + ": none of the processors is left for the other processes");
  }
  return processors;
}

void AddLaunchFlags(CLI::App* app, CLI::Option* resume, DriverOptions* options) {
  CLI::Option* launch = app->add_flag(
      "--launch", options->launch,
      "start scene server, planners and logger, and stop them at the end; on a port that is free, "
      "whatever $LCM_DEFAULT_URL says, but for --lcm-url");
  const auto with_launch = [launch](CLI::Option* option) {
    return option->needs(launch)->allow_extra_args(false)->group("With --launch");
  };
  using Texts = std::vector<std::string>;
  const std::vector<CLI::Option*> robot_flags = options->robot.AddTo(app);
  for (CLI::Option* flag : robot_flags) with_launch(flag);
  launch->needs(robot_flags.front());
  with_launch(app->add_option("--problems", options->problems, "problem set folder; repeatable"));
  app->callback([options] {
    if (options->launch && !options->replay && options->problems.empty()) {
      throw CLI::RequiresError("--launch", "--problems");
    }
  });
  with_launch(
      app->add_option("--referee-robot", options->referee_robot,
                      "robot folder, the name of a robot that ships, or a folder with one .urdf "
                      "file, whose meshes judge every path too"));
  with_launch(app->add_flag("--allow-standing-contacts", options->allow_standing_contacts,
                            "links of the referee's robot that touch in every configuration may; "
                            "default: they end the session before it begins"));
  with_launch(app->add_option_function<std::string>(
      "--pin", [=](const std::string& text) { options->pinned = ParsePin(text); },
      "processors of the planners, e.g. 2-3: all else keeps off them; default: no matter which"));
  with_launch(app->add_option("--problems-per-process", options->problems_per_process,
                              "start each planner anew after so many problems, so that no process "
                              "is faster by chance on all of them; default: never"))
      ->check(CLI::Range(1, kMostPlanned));
  with_launch(
      app->add_option("--out", options->out, "session folder; default: sessions/<date and time>"))
      ->excludes(resume);
  with_launch(app->add_option_function<Texts>(
      "--planner-command", [=](const Texts& texts) { TakeCommands(texts, &options->line_up); },
      "NAME=COMMAND: how to start a planner that is not planbench's own; the bus is in its "
      "LCM_DEFAULT_URL; repeatable"));
  with_launch(app->add_option_function<Texts>(
      "--set", [=](const Texts& texts) { TakeSettings(texts, &options->line_up); },
      "NAME.KEY=VALUE: setting KEY of planner NAME; repeatable"));
}

/// A value of a flag as it is recorded: files and folders hold from wherever the command is given
/// again. Files that settings of planners name begin at the robot's folder, not here.
std::string Recorded(const std::string& flag, const std::string& value) {
  static const std::set<std::string> kPaths = {"lineup", "out",    "problems", "referee-robot",
                                               "replay", "resume", "robot",    "spheres"};
  static const std::set<std::string> kNamedPaths = {"package-path", "reference"};
  const bool is_named = kNamedPaths.contains(flag);
  if (!is_named && !kPaths.contains(flag)) return value;
  const std::size_t begin = is_named ? value.find('=') + 1 : 0;
  const std::filesystem::path path = value.substr(begin);
  const bool is_shipped_robot =
      (flag == "robot" && !IsRobotFolder(path)) || (flag == "referee-robot" && !IsFolder(path));
  if (path.empty() || is_shipped_robot) return value;
  return value.substr(0, begin) + std::filesystem::absolute(path).lexically_normal().string();
}

}  // namespace

std::vector<int> ParseRange(const std::string& text, const std::string& flag) {
  std::set<int> indices;
  std::istringstream parts(text + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t dash = part.find('-');
    const int first = ParseIndex(part.substr(0, dash), text, flag);
    const int last =
        dash == std::string::npos ? first : ParseIndex(part.substr(dash + 1), text, flag);
    if (last < first || last - first >= kMostPlanned) {
      throw InputError(flag + " " + text + ": '" + part + "' is no range");
    }
    for (int i = first; i <= last; ++i) indices.insert(i);
  }
  return {indices.begin(), indices.end()};
}

Shard ParseShard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_index] = std::from_chars(text.data(), end, shard.index);
  const bool divided = bad_index == std::errc() && slash != end && *slash == '/';
  const auto [rest, bad_count] = std::from_chars(divided ? slash + 1 : end, end, shard.count);
  if (!divided || bad_count != std::errc() || rest != end || shard.index < 1 ||
      shard.index > shard.count || shard.count > kMostPlanned) {
    throw InputError(
        fmt::format("--shard {}: expected I/N, I from 1 to N, N at most {}", text, kMostPlanned));
  }
  return shard;
}

void AddDriverFlags(CLI::App* app, DriverOptions* options) {
  SessionConditions& conditions = options->conditions;
  PlanRequest& request = conditions.request;
  AddNames(
      app, "--sets", [=](const auto& names) { options->sets = names; },
      "problem sets, comma-separated; default: all that are served");
  app->add_option_function<std::string>(
      "--problems-range",
      [=](const std::string& text) { options->problem_indices = ParseRange(text); },
      "problem indices, e.g. 1-20 or 1-5,8; default: all");
  app->add_option_function<std::string>(
      "--shard", [=](const std::string& text) { options->shard = ParseShard(text); },
      "I/N: the I-th of N parts of the session, which report --merge joins");
  app->add_option("--lineup", options->line_up.file,
                  "file of contestants: planners, their settings and conditions");
  AddNames(
      app, "--planners", [=](const auto& names) { options->line_up.planners = names; },
      "those of the line-up, or without one planners by name, comma-separated; default: all of the "
      "line-up, or ara,rrtc");
  AddEnum<Directions>(app, "--directions", &options->directions,
                      "in which to search; auto: forward, then backward if that failed, but once "
                      "if a planner searches from both ends anyway")
      ->default_str(std::string(EnumName(options->directions)));
  app->add_option("--time", request.time_limit_s, "time limit of a request, s")
      ->check(Positive(1e6))  // 11 days, and far from what a clock can count
      ->capture_default_str();
  app->add_option(
         "--trials", options->trials,
         "runs of each problem; planners whose answer does not depend on the seed make one")
      ->check(CLI::Range(1, kMostPlanned))
      ->capture_default_str();
  app->add_option("--seed", request.seed,
                  "seed of the session; every problem, direction and trial has a seed made of it")
      ->check(AnySeed())
      ->capture_default_str();
  AddEnum<CollisionModel>(app, "--collision-model", &request.collision_model, kCollisionModelsHelp)
      ->default_str(std::string(EnumName(request.collision_model)));
  app->add_option(
         "--edge-resolution", request.edge_resolution_m,
         "largest motion of any point between samples of an edge, m; default: the robot's; "
         "planners that sample edges by a rule of their own do not heed it, which the "
         "tables say")
      ->check(Within(kFinestEdgeResolution, kCoarsestEdgeResolution));
  AddEnum<EdgeCheck>(
      app, "--edge-check", &request.edge_check,
      "fixed: edges are free at samples; certified: proven free; default: the robot's");
  app->add_option("--referee-step", conditions.referee_step_m,
                  fmt::format("the same for the referee; default: half the edge resolution, {} m "
                              "at least; paths of more than {:.0f} samples are not judged, and "
                              "their runs count as missing",
                              kFinestDefaultRefereeStep, kMaxPathSamples))
      ->check(Within(kFinestEdgeResolution, kCoarsestEdgeResolution));
  app->add_flag("--anytime", request.anytime,
                "let anytime planners improve until the time limit; default: first solution");
  app->add_flag("!--no-simplify", request.simplify, "do not ask for simplified paths");
  app->add_flag("!--no-clearance", conditions.with_clearance, "do not measure clearance of paths");
  app->add_flag("--parallel", conditions.parallel,
                "let the planners work at once, each on its own request");
  app->add_option("--max-disturbance", options->max_disturbance,
                  "share of a run's time beyond which it is marked as disturbed: that its planner "
                  "waited for a processor, or the hypervisor had the processors")
      ->check(Positive(1))
      ->capture_default_str();
  app->add_flag(
      "--repeat-disturbed", options->repeat_disturbed,
      "make disturbed runs again at the end, twice at most, each recorded in the place of "
      "the one before");
  app->add_option("--discovery-timeout", options->discovery_timeout_s,
                  "how long to wait for the other processes, s; default: 5, with --launch 60; "
                  "beyond a minute for one that has gone later, too, beyond 10 minutes for one "
                  "answer of the scene server")
      ->check(Positive(1e6));
  app->add_option_function<std::vector<std::string>>(
         "--reference",
         [=](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             options->references.push_back(SplitNameValue(text, "--reference", "NAME=FILE"));
           }
         },
         "NAME=FILE: results from elsewhere (CSV or OMPL's, docs/lineups.md) to stand in the "
         "tables; "
         "repeatable")
      ->allow_extra_args(false);
  app->add_flag("--skip-bad-problems", options->skip_bad_problems,
                "leave out problems that cannot be read; default: end before the first run");
  CLI::Option* resume = app->add_option(
      "--resume", options->resume,
      "session folder to go on with: runs whose planner was asked are not run again");
  AddLaunchFlags(app, resume, options);
  CLI::Option* replay = app->add_option(
      "--replay", options->replay,
      "event log, or folder, of a session whose requests are made again, of live planners or with "
      "--launch; tells which answers differ. --planners chooses; what a request says is the log's");
  // All but who answers, how they are started and where they are found.
  const std::set<std::string> taken = {"help",
                                       "version",
                                       "replay",
                                       "lcm-url",
                                       "planners",
                                       "lineup",
                                       "launch",
                                       "robot",
                                       "out",
                                       "set",
                                       "package-path",
                                       "planner-command",
                                       "discovery-timeout",
                                       "problems"};
  for (CLI::Option* option : app->get_options()) {
    if (!taken.contains(option->get_single_name())) replay->excludes(option);
  }
}

std::map<std::string, std::string> FlagsOf(const CLI::App& app) {
  std::map<std::string, std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    if (option == app.get_help_ptr() || option == app.get_version_ptr()) continue;
    const bool given = option->count() > 0;
    const bool takes_value = option->get_items_expected_max() > 0;
    const std::string& name = option->get_single_name();
    if (!takes_value) {
      flags[name] = given ? "true" : "false";
    } else if (!given) {
      flags[name] = option->get_default_str();
    } else {
      std::vector<std::string> values = option->results();
      for (std::string& value : values) value = Recorded(name, value);
      flags[name] = TakesSeveralValues(name) ? JoinFlagValues(values)
                                             : fmt::format("{}", fmt::join(values, ","));
    }
  }
  return flags;
}

}  // namespace planbench
