#include "benchmark_driver/session_contestants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "benchmark_driver/await_nodes.h"
#include "benchmark_driver/contestant_names.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/lookup.h"
#include "common/sibling_program.h"
#include "messaging/codec.h"
#include "planning/path_judge.h"

namespace planbench {
namespace {

/// Planbench's own by its own word, whatever its name on the bus and whoever started it; or by the
/// line-up's, since builds of before do not tell.
bool IsOwn(const NodeStatusMessage& planner, const LineUpEntry& entry) {
  const auto is_ours = [](const std::string& program) { return IsFile(ProgramFolder() / program); };
  return is_ours(Lookup(planner.settings, kProgramSetting).value_or("")) ||
         (entry.contestant.command.empty() && is_ours("planner_" + entry.program));
}

/// Throws InputError for a planner that says more of itself than every record can hold: messages
/// that are not much larger do not come.
void RequireModest(const NodeStatusMessage& planner) {
  constexpr std::size_t kMost = 1'000'000;
  const std::size_t size = Encode(planner).size();
  if (size <= kMost) return;
  throw InputError(fmt::format(
      "the planner '{}' announces itself in {} bytes (algorithm, class, settings), most of which "
      "every record repeats: {} at most",
      planner.name, size, kMost));
}

/// With its conditions, but for its name in tables; throws InputError for planners that do not fit.
void AddContestant(const NodeRegistry& registry, const ProblemSetsMessage& served,
                   const LineUpEntry& entry, DriverOptions* options, FoundPlanners* found) {
  const PlanRequest& request = options->conditions.request;
  Contestant contestant = entry.contestant;
  const std::string& name = entry.contestant.planner;
  const auto planner = registry.Find(name, NodeKind::kPlanner);
  if (!planner) throw InputError("the planner '" + name + "' has left the bus");
  if (IsOwn(*planner, entry)) RequireSameBuild(*planner);
  if (planner->robot_id != served.robot_id) {
    throw InputError(fmt::format(
        "the planner '{}' has another robot than the scene server: '{}' ({}) against '{}' ({})",
        name, planner->robot_name, planner->robot_id, served.robot_name, served.robot_id));
  }
  RequireModest(*planner);
  contestant.collision_model = options->ModelOf(entry);
  if (!contestant.edge_resolution_m) contestant.edge_resolution_m = request.edge_resolution_m;
  if (!contestant.edge_check) contestant.edge_check = request.edge_check;
  const std::string model(EnumName(*contestant.collision_model));
  const auto& models = planner->collision_models;
  if (std::find(models.begin(), models.end(), model) == models.end()) {
    const auto why = planner->unusable_models.find(model);
    throw InputError(fmt::format("--collision-model: the planner '{}' does not offer '{}'{}", name,
                                 model,
                                 why == planner->unusable_models.end() ? "" : ": " + why->second));
  }
  if (contestant.collision_model == CollisionModel::kMeshes) {
    options->conditions.mesh_robot_id = served.mesh_robot_id;
  }
  const Directions directions = entry.directions.value_or(options->directions);
  if (!planner->can_backward &&
      (directions == Directions::kBackward || directions == Directions::kBoth)) {
    throw InputError("--directions: the planner '" + name + "' cannot search backward");
  }
  if (!planner->can_anytime && request.anytime && !entry.finds_first_paths_only) {
    throw InputError(fmt::format(
        "--anytime: the planner '{}' is no anytime planner: leave it out by --planners", name));
  }
  if (!contestant.first_path_of.empty() && !planner->can_improve) {
    throw InputError(fmt::format("first_path_of: the planner '{}' does not improve paths", name));
  }
  (entry.finds_first_paths_only ? found->first_planners : options->conditions.contestants)
      .push_back(std::move(contestant));
  found->planners[name] = *planner;
}

}  // namespace

FoundPlanners CompleteConditions(const NodeRegistry& registry, const ProblemSetsMessage& served,
                                 const std::vector<LineUpEntry>& line_up,
                                 const std::map<std::string, std::string>& names,
                                 DriverOptions* options) {
  SessionConditions& conditions = options->conditions;
  PlanRequest& request = conditions.request;
  request.robot_id = served.robot_id;
  if (!request.edge_resolution_m) request.edge_resolution_m = served.edge_resolution_m;
  if (!request.edge_check) request.edge_check = served.edge_check;
  if (!conditions.referee_step_m) {
    conditions.referee_step_m = DefaultRefereeStep(*request.edge_resolution_m);
  }
  conditions.referee_robot_id = served.referee_robot_id;
  FoundPlanners found;
  for (const LineUpEntry& entry : line_up) AddContestant(registry, served, entry, options, &found);
  const std::map<std::string, std::string> all = ContestantNames(line_up, found.planners, names);
  for (std::vector<Contestant>* contestants : {&conditions.contestants, &found.first_planners}) {
    for (Contestant& one : *contestants) one.name = all.at(one.planner);
  }
  return found;
}

}  // namespace planbench
