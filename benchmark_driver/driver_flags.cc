#include "benchmark_driver/driver_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <set>

#include "common/error.h"
#include "common/name_value.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

std::vector<std::string> SplitList(const std::string& text, const std::string& flag) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size() && !text.empty()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    if (parts.back().empty()) throw InputError(flag + " " + text + ": an entry is empty");
    begin = end + 1;
  }
  std::set<std::string> seen;
  for (const std::string& part : parts) {
    if (!seen.insert(part).second) throw InputError(flag + ": '" + part + "' occurs twice");
  }
  return parts;
}

int ParseIndex(const std::string& text, const std::string& whole) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) {
    throw InputError("--problems-range " + whole + ": '" + text + "' is no problem index");
  }
  return value;
}

}  // namespace

std::vector<int> ParseRange(const std::string& text) {
  constexpr int kMost = 1'000'000;
  std::set<int> indices;
  for (const std::string& part : SplitList(text, "--problems-range")) {
    const std::size_t dash = part.find('-');
    const int first = ParseIndex(part.substr(0, dash), text);
    const int last = dash == std::string::npos ? first : ParseIndex(part.substr(dash + 1), text);
    if (last < first || last - first >= kMost) {
      throw InputError("--problems-range " + text + ": '" + part + "' is no range");
    }
    for (int i = first; i <= last; ++i) indices.insert(i);
  }
  return {indices.begin(), indices.end()};
}

void DriverFlags::AddTo(CLI::App* app) {
  app->add_option("--sets", sets_, "problem sets, comma-separated; default: all that are served");
  app->add_option("--problems-range", range_, "problem indices, e.g. 1-20 or 1-5,8; default: all");
  app->add_option("--planners", planners_, "planners by name, comma-separated")
      ->capture_default_str();
  app->add_option("--directions", directions_, "forward, backward or both")->capture_default_str();
  app->add_option("--time", options_.time_limit_s, "time limit of a request, s")
      ->capture_default_str();
  app->add_option("--trials", options_.trials, "runs of each problem, seeds counting up")
      ->capture_default_str();
  app->add_option("--seed", options_.seed, "seed of the first trial")
      ->check(CLI::NonNegativeNumber)  // CLI11 would wrap it
      ->capture_default_str();
  app->add_option("--collision-model", collision_model_, EnumChoices<CollisionModel>())
      ->capture_default_str();
  app->add_option(
      "--edge-resolution", options_.edge_resolution_m,
      "largest motion of any point between samples of an edge, m; default: the robot's");
  app->add_option("--edge-check", edge_check_,
                  "fixed: edges are free at samples; certified: proven free; default: the robot's");
  app->add_option("--referee-step", options_.referee_step_m,
                  "the same for the referee; default: half the edge resolution");
  app->add_flag("--anytime", options_.anytime,
                "let anytime planners improve until the time limit; default: first solution");
  app->add_flag("!--no-simplify", options_.simplify, "do not ask for simplified paths");
  app->add_flag("!--no-clearance", options_.clearance, "do not measure clearance of paths");
  app->add_flag("--parallel", options_.parallel,
                "let the planners work at once, each on its own request");
  app->add_option("--discovery-timeout", options_.discovery_timeout_s,
                  "how long to wait for the other processes, s")
      ->capture_default_str();
  app->add_option("--resume", options_.resume,
                  "session folder to go on with: finished runs are not run again");

  CLI::Option* launch = app->add_flag(
      "--launch", options_.launch,
      "start scene server, planners and logger on a private port, and stop them at the end");
  const auto with_launch = [launch](CLI::Option* option) {
    option->needs(launch)->group("With --launch");
    return option;
  };
  with_launch(app->add_option("--robot", options_.robot, "robot folder"));
  with_launch(app->add_option("--problems", problems_, "problem set folder; repeatable")
                  ->allow_extra_args(false));
  with_launch(app->add_option("--referee-robot", options_.referee_robot,
                              "folder of a mesh robot that judges paths too"));
  with_launch(app->add_option("--package-path", options_.package_paths,
                              "NAME=DIR: folder that package://NAME/ stands for; repeatable")
                  ->allow_extra_args(false));
  with_launch(
      app->add_option("--out", options_.out, "session folder; default: sessions/<date and time>"));
  with_launch(app->add_option("--planner-command", planner_commands_,
                              "NAME=COMMAND: how to start a planner that is not planbench's own; "
                              "the bus is in its LCM_DEFAULT_URL; repeatable")
                  ->allow_extra_args(false));
  with_launch(app->add_option("--set", planner_settings_,
                              "NAME.KEY=VALUE: setting KEY of planner NAME; repeatable")
                  ->allow_extra_args(false));
}

DriverOptions DriverFlags::Parse() const {
  DriverOptions options = options_;
  options.sets = SplitList(sets_, "--sets");
  options.problem_indices = ParseRange(range_);
  options.planners = SplitList(planners_, "--planners");
  if (options.planners.empty()) throw InputError("--planners: at least one is needed");
  std::map<std::string, std::string> by_channel;
  for (const std::string& planner : options.planners) {
    const auto [same, is_new] = by_channel.emplace(PlannerChannels(planner).request, planner);
    if (!is_new) {
      throw InputError("--planners: '" + same->second + "' and '" + planner +
                       "' would share their channels (" + same->first + ")");
    }
  }
  if (directions_ == "both") {
    options.directions = {Direction::kForward, Direction::kBackward};
  } else if (const auto direction = ParseEnum<Direction>(directions_)) {
    options.directions = {*direction};
  } else {
    throw InputError("--directions " + directions_ + ": expected forward, backward or both");
  }
  const auto model = ParseEnum<CollisionModel>(collision_model_);
  if (!model) {
    throw InputError("--collision-model " + collision_model_ + ": expected " +
                     EnumChoices<CollisionModel>());
  }
  options.collision_model = *model;
  const auto require_positive = [](double value, const char* flag) {
    if (!std::isfinite(value) || value <= 0) {
      throw InputError(fmt::format("{} {}: must be greater than zero", flag, value));
    }
  };
  require_positive(options.time_limit_s, "--time");
  constexpr double kLongest = 1e6;  // 11 days, and far from what a clock can count
  if (options.time_limit_s > kLongest) {
    throw InputError(
        fmt::format("--time {}: must be at most {} s", options.time_limit_s, kLongest));
  }
  require_positive(options.trials, "--trials");
  require_positive(options.discovery_timeout_s, "--discovery-timeout");
  if (options.edge_resolution_m != 0) {
    require_positive(options.edge_resolution_m, "--edge-resolution");
  }
  if (!edge_check_.empty()) {
    options.edge_check = ParseEnum<EdgeCheck>(edge_check_);
    if (!options.edge_check) {
      throw InputError("--edge-check " + edge_check_ + ": expected " + EnumChoices<EdgeCheck>());
    }
  }
  if (options.referee_step_m != 0) require_positive(options.referee_step_m, "--referee-step");
  for (const std::string& command : planner_commands_) {
    const auto [name, line] = SplitNameValue(command, "--planner-command");
    if (!options.planner_commands.emplace(name, line).second) {
      throw InputError("--planner-command: '" + name + "' is given twice");
    }
  }
  for (const std::string& setting : planner_settings_) {
    constexpr char kForm[] = "NAME.KEY=VALUE";
    const std::string key = SplitNameValue(setting, "--set", kForm).first;
    const std::size_t dot = key.find('.');
    if (dot == 0 || dot == std::string::npos || dot + 1 == key.size()) {
      throw InputError("--set '" + setting + "': expected " + kForm);
    }
    options.planner_settings.emplace_back(setting.substr(0, dot), setting.substr(dot + 1));
  }
  for (const std::string& folder : problems_) options.problems.emplace_back(folder);
  if (options.launch) {
    if (options.robot.empty()) throw InputError("--launch needs --robot");
    if (options.problems.empty()) throw InputError("--launch needs --problems");
    if (!options.resume.empty() && !options.out.empty()) {
      throw InputError("--resume names the session folder; --out cannot be given as well");
    }
  }
  return options;
}

std::map<std::string, std::string> DriverFlags::AsSettings(const DriverOptions& options) const {
  std::map<std::string, std::string> settings = {
      {"sets", sets_},
      {"problems_range", range_},
      {"planners", planners_},
      {"directions", directions_},
      {"time_limit_s", fmt::format("{}", options.time_limit_s)},
      {"trials", fmt::format("{}", options.trials)},
      {"seed", fmt::format("{}", options.seed)},
      {"collision_model", collision_model_},
      {"edge_resolution_m", fmt::format("{}", options.edge_resolution_m)},
      {"edge_check", edge_check_},
      {"referee_step_m", fmt::format("{}", options.referee_step_m)},
      {"anytime", options.anytime ? "true" : "false"},
      {"simplify", options.simplify ? "true" : "false"},
      {"clearance", options.clearance ? "true" : "false"},
      {"parallel", options.parallel ? "true" : "false"},
      {"launch", options.launch ? "true" : "false"},
  };
  if (options.launch) {
    settings["robot"] = options.robot.string();
    settings["problems"] = fmt::format("{}", fmt::join(problems_, ","));
    settings["referee_robot"] = options.referee_robot.string();
    settings["planner_commands"] = fmt::format("{}", fmt::join(planner_commands_, ","));
    settings["planner_settings"] = fmt::format("{}", fmt::join(planner_settings_, ","));
  }
  return settings;
}

}  // namespace planbench
