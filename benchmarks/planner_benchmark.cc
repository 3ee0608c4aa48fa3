// Runs one planner over problem sets in this process, without the bus: solved, times, effort and
// where the time went, a table row for each set and direction. Every path is judged at the step
// that a session's referee takes by default.
//
//   planner_benchmark --problems DIR [DIR ...] --planner ara|rrtc|trajopt [--set KEY=VALUE ...]
//
// Times are planning times in ms over the solved problems; "time to" is over all problems, those
// that were not solved counting as infinite; counts are medians over all problems that were
// searched.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "messaging/robot_flags.h"
#include "planner_ara/ara_planner.h"
#include "planner_rrtc/rrtc_planner.h"
#include "planner_trajopt/trajopt_planner.h"
#include "planning/path_judge.h"
#include "planning/path_measures.h"
#include "planning/planner_settings.h"
#include "planning/resolve.h"
#include "results/statistics.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

struct Flags {
  RobotFlags robot{.folder = "fetch", .spheres = {}, .package_paths = {}};
  std::vector<std::string> problems;
  std::string planner = "ara";
  std::string config;
  std::vector<std::string> overrides;
  std::string directions = "forward";
  CollisionModel model = CollisionModel::kSpheres;
  double time_limit_s = 10;
  std::optional<double> edge_resolution_m;
  std::optional<EdgeCheck> edge_check;
  std::uint64_t seed = 1;
  int first = 1;
  int last = std::numeric_limits<int>::max();
  int stride = 1;
  int repeat = 1;
  bool anytime = false;
  bool simplify = false;
  bool counters = false;
  std::string csv;
};

/// What came of one problem.
struct Run {
  int index = 0;
  PlanResult result;
  bool referee_valid = false;
  bool simplified_valid = false;
};

std::unique_ptr<Planner> MakePlanner(const Flags& flags, const Robot& robot) {
  const YamlNode settings =
      LoadPlannerSettings(robot, flags.planner, flags.config, flags.overrides);
  if (flags.planner == "ara") return MakeAraPlanner(robot, settings);
  if (flags.planner == "rrtc") return MakeRrtcPlanner(robot, settings);
  return MakeTrajoptPlanner(robot, settings);
}

class Referee {
 public:
  explicit Referee(const Robot& robot) : robot_(robot) {}
  bool Accepts(const PlanRequest& request, const Scene& scene, const Path& path) {
    const PlanningGroup& group = robot_.Group(request.group);
    const ResolvedQuery query = ResolveQuery(robot_, group, request.start, request.goal, "referee");
    std::unique_ptr<CollisionChecker>& checker = checkers_[group.name];
    if (checker == nullptr) checker = MakeCollisionChecker(robot_, group, request.collision_model);
    checker->SetScene(scene, query.base_positions);
    const double step_m =
        DefaultRefereeStep(request.edge_resolution_m.value_or(robot_.edge_resolution_m));
    return JudgePath(checker.get(), path, query.start, query.goals, step_m, false).valid;
  }

 private:
  const Robot& robot_;
  std::map<std::string, std::unique_ptr<CollisionChecker>> checkers_;  // by group
};

std::vector<Run> RunSet(const Flags& flags, const Robot& robot, const ProblemSet& set,
                        Direction direction, Planner* planner, Referee* referee) {
  std::vector<Run> runs;
  for (const ProblemFiles& files : set.problems) {
    if (files.index < flags.first || files.index > flags.last) continue;
    if ((files.index - flags.first) % flags.stride != 0) continue;
    const Problem problem = ReadProblem(files.scene, files.request, robot);
    PlanRequest request;
    request.request_id = fmt::format("{} {}", set.name, files.index);
    request.group = problem.group;
    request.start = problem.start;
    request.goal = problem.goal;
    request.direction = direction;
    request.time_limit_s = flags.time_limit_s;
    request.seed = flags.seed;
    request.collision_model = flags.model;
    request.edge_resolution_m = flags.edge_resolution_m;
    request.edge_check = flags.edge_check;
    request.anytime = flags.anytime;
    request.simplify = flags.simplify;
    Run run{files.index, planner->Plan(request, problem.scene, nullptr), false, false};
    for (int i = 1; i < flags.repeat; ++i) {
      PlanResult again = planner->Plan(request, problem.scene, nullptr);
      if (again.planning_time_s < run.result.planning_time_s) run.result = std::move(again);
    }
    if (run.result.status == PlanStatus::kInvalidRequest) throw InputError(run.result.message);
    if (run.result.status == PlanStatus::kSolved) {
      run.referee_valid = referee->Accepts(request, problem.scene, run.result.path);
      if (flags.simplify) {
        run.simplified_valid = referee->Accepts(request, problem.scene, run.result.simplified_path);
      }
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

bool WasSearched(const Run& run) {
  return run.result.status != PlanStatus::kStartInvalid &&
         run.result.status != PlanStatus::kGoalInvalid;
}

void PrintHeader() {
  fmt::print(
      "{:24} {:8} {:>4} {:>6} {:>5} {:>5} | {:>8} {:>8} {:>8} {:>8} | {:>8} {:>8} | {:>8} "
      "{:>9} | {:>5} {:>5} {:>5} {:>5} | {:>6} {:>7}\n",
      "set", "search", "num", "solved", "bad", "ends", "median", "mean", "95 %", "max", "t to 50%",
      "t to 95%", "edges", "configs", "setup", "coll", "guide", "rest", "length", "us/cfg");
}

void PrintRow(const std::string& set, const std::string& direction, const std::vector<Run>& runs,
              const JointSpace& space, bool with_counters) {
  std::vector<double> solved_ms, all_ms, edges, configurations, lengths;
  std::map<std::string, std::vector<double>> counters;
  PhaseTimes sum;
  double total_s = 0;
  double num_configurations = 0;
  int num_refused = 0;
  int num_unsolvable = 0;
  for (const Run& run : runs) {
    const PlanResult& result = run.result;
    const bool solved = result.status == PlanStatus::kSolved;
    all_ms.push_back(solved ? 1e3 * result.planning_time_s
                            : std::numeric_limits<double>::infinity());
    if (!WasSearched(run)) {
      ++num_unsolvable;
      continue;
    }
    if (solved) {
      solved_ms.push_back(all_ms.back());
      lengths.push_back(PathLength(space, result.path));
      if (!run.referee_valid) ++num_refused;
    }
    edges.push_back(result.counters.at("edges_checked"));
    configurations.push_back(result.counters.at("configurations_checked"));
    for (const auto& [name, value] : result.counters) counters[name].push_back(value);
    num_configurations += configurations.back();
    total_s += result.total_time_s;
    sum.setup_s += result.phases.setup_s;
    sum.collision_s += result.phases.collision_s;
    sum.guidance_s += result.phases.guidance_s;
    sum.search_s += result.phases.search_s;
  }
  const auto share = [&](double seconds) { return 100 * seconds / total_s; };
  const auto median = [](const std::vector<double>& values) { return Summarize(values).median; };
  const Summary solved = Summarize(solved_ms);
  const Summary all = Summarize(all_ms);
  std::sort(solved_ms.begin(), solved_ms.end());
  fmt::print(
      "{:24} {:8} {:>4} {:>6} {:>5} {:>5} | {:>8.2f} {:>8.2f} {:>8.2f} {:>8.1f} | {:>8.2f} "
      "{:>8.2f} | {:>8.0f} {:>9.0f} | {:>4.0f}% {:>4.0f}% {:>4.0f}% {:>4.0f}% | {:>6.2f} "
      "{:>7.3f}\n",
      set, direction, runs.size(), solved_ms.size(), num_refused, num_unsolvable, solved.median,
      solved.mean, solved.percentile_95, Quantile(solved_ms, 1), all.median, all.percentile_95,
      median(edges), median(configurations), share(sum.setup_s), share(sum.collision_s),
      share(sum.guidance_s), share(sum.search_s), median(lengths),
      1e6 * sum.collision_s / num_configurations);
  if (with_counters) {
    for (const auto& [name, values] : counters) {
      const Summary counts = Summarize(values);
      fmt::print("    {:28} median {:.6g}, mean {:.6g}, 95 % {:.6g}\n", name, counts.median,
                 counts.mean, counts.percentile_95);
    }
  }
  std::fflush(stdout);
}

void PrintSimplification(const std::vector<Run>& runs, const JointSpace& space) {
  std::vector<double> ms, lengths, waypoints;
  int num_refused = 0;
  for (const Run& run : runs) {
    if (run.result.status != PlanStatus::kSolved) continue;
    ms.push_back(1e3 * run.result.phases.simplification_s);
    lengths.push_back(PathLength(space, run.result.simplified_path));
    waypoints.push_back(static_cast<double>(run.result.simplified_path.size()));
    if (!run.simplified_valid) ++num_refused;
  }
  const Summary times = Summarize(ms);
  const Summary length = Summarize(lengths);
  fmt::print(
      "    simplified: {} refused; ms median {:.3f}, mean {:.3f}, 95 % {:.3f}; length median "
      "{:.2f}, mean {:.2f}; waypoints median {:.0f}\n",
      num_refused, times.median, times.mean, times.percentile_95, length.median, length.mean,
      Summarize(waypoints).median);
}

void WriteCsv(std::ofstream* csv, const std::string& set, const std::string& direction,
              const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const PlanResult& result = run.result;
    std::vector<std::string> counters;
    for (const auto& [name, value] : result.counters) {
      counters.push_back(fmt::format("{}={}", name, value));
    }
    *csv << fmt::format("{},{},{},{},{},{:.3f},{:.3f},{},{},{:.6g},{:.6g},{}\n", set, direction,
                        run.index, EnumName(result.status), run.referee_valid ? 1 : 0,
                        1e3 * result.planning_time_s, 1e3 * result.phases.collision_s,
                        result.path.size(), result.progress.size(), result.epsilon, result.cost,
                        fmt::join(counters, " "));
  }
}

int Main(int argc, char** argv) {
  Flags flags;
  CLI::App app("One planner over problem sets, without the bus", "planner_benchmark");
  app.add_option("--problems", flags.problems, "Folders of problem sets")->required();
  flags.robot.AddTo(&app).front()->capture_default_str();
  app.add_option("--planner", flags.planner, "Which to run")
      ->check(CLI::IsMember({"ara", "rrtc", "trajopt"}))
      ->capture_default_str();
  app.add_option("--config", flags.config, "Settings file; default: the robot folder's");
  app.add_option("--set", flags.overrides, "KEY=VALUE: overrides a setting; repeatable")
      ->allow_extra_args(false);
  app.add_option("--directions", flags.directions, "Which to run")
      ->check(CLI::IsMember({"forward", "backward", "both"}))
      ->capture_default_str();
  app.add_option("--model", flags.model, "Collision model; default: spheres")
      ->transform(OneOf<CollisionModel>());
  app.add_option("--time", flags.time_limit_s, "Limit of a request, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--edge-check", flags.edge_check, "Method; default: the robot's")
      ->transform(OneOf<EdgeCheck>());
  app.add_option("--edge-resolution", flags.edge_resolution_m, "m; default: the robot's");
  app.add_option("--seed", flags.seed, "Seed of every request")->capture_default_str();
  app.add_option("--first", flags.first, "First problem's number")->capture_default_str();
  app.add_option("--last", flags.last, "Last problem's number");
  app.add_option("--stride", flags.stride, "Every how many-th problem")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--repeat", flags.repeat, "Runs of every request, of which the fastest counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--anytime", flags.anytime, "Improve until the time limit");
  app.add_flag("--simplify", flags.simplify,
               "Simplify the paths, and tell of it in a line of its own");
  app.add_flag("--counters", flags.counters, "Also print the planner's own counts");
  app.add_option("--csv", flags.csv, "File for a line a run");
  return RunCommand(&app, argc, argv, [&] {
    const Robot robot = flags.robot.Load();
    const std::unique_ptr<Planner> planner = MakePlanner(flags, robot);
    Referee referee(robot);
    std::ofstream csv;
    if (!flags.csv.empty()) {
      csv.open(flags.csv);
      if (!csv) throw InputError(flags.csv + ": cannot be written");
      csv << "set,direction,problem,status,referee_valid,planning_ms,collision_ms,waypoints,"
             "solutions,epsilon,cost,counters\n";
    }
    PrintHeader();
    const JointSpace& space = robot.groups.front().space;
    for (const Direction direction : EnumValues<Direction>()) {
      const std::string name(EnumName(direction));
      if (flags.directions != "both" && flags.directions != name) continue;
      std::vector<Run> all;
      for (const std::string& folder : flags.problems) {
        const ProblemSet set = ListProblemSet(folder);
        std::vector<Run> runs = RunSet(flags, robot, set, direction, planner.get(), &referee);
        if (runs.empty()) throw InputError(folder + ": no problem in the range asked for");
        PrintRow(set.name, name, runs, space, flags.counters);
        if (flags.simplify) PrintSimplification(runs, space);
        if (csv.is_open()) WriteCsv(&csv, set.name, name, runs);
        std::move(runs.begin(), runs.end(), std::back_inserter(all));
      }
      if (flags.problems.size() > 1) {
        PrintRow("all", name, all, space, flags.counters);
        if (flags.simplify) PrintSimplification(all, space);
      }
    }
    return kExitOk;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
