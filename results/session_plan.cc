#include "results/session_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "common/error.h"

namespace planbench {
namespace {

using Ranges = std::vector<std::pair<int, int>>;  // first and last

Ranges RangesOf(const std::vector<int>& ascending) {
  Ranges ranges;
  for (const int index : ascending) {
    if (!ranges.empty() && ranges.back().second + 1 == index) {
      ranges.back().second = index;
    } else {
      ranges.emplace_back(index, index);
    }
  }
  return ranges;
}

/// Throws InputError for what is not ascending.
std::vector<int> IndicesOf(const Ranges& ranges) {
  std::vector<int> indices;
  for (const auto& [first, last] : ranges) {
    const bool ascends = first >= 0 && first <= last && (indices.empty() || indices.back() < first);
    if (!ascends || last - first >= kMostPlanned - static_cast<int>(indices.size())) {
      throw InputError(fmt::format("[{}, {}] is no range of problems", first, last));
    }
    for (int index = first; index <= last; ++index) indices.push_back(index);
  }
  return indices;
}

/// Throws InputError.
int Checked(const char* name, int value, int most) {
  if (value >= 1 && value <= most) return value;
  throw InputError(fmt::format("{} is {}, which is not from 1 to {}", name, value, most));
}

nlohmann::json ToJson(const PlannedCall& call) {
  nlohmann::json json = {{"sets", nlohmann::json::array()}, {"planners", nlohmann::json::array()}};
  for (const PlannedSet& set : call.sets) {
    json["sets"].push_back({{"name", set.name}, {"problems", RangesOf(set.problems)}});
  }
  for (const PlannedPlanner& planner : call.planners) {
    json["planners"].push_back({{"name", planner.name},
                                {"directions", EnumName(planner.directions)},
                                {"trials", planner.trials}});
  }
  if (call.shard.count > 1) {
    json["shard"] = {{"index", call.shard.index}, {"count", call.shard.count}};
  }
  return json;
}

/// Throws InputError or nlohmann's exceptions.
PlannedCall FromJson(const nlohmann::json& json) {
  PlannedCall call;
  for (const auto& set : json.at("sets")) {
    call.sets.push_back(
        {set.at("name").get<std::string>(), IndicesOf(set.at("problems").get<Ranges>())});
  }
  for (const auto& planner : json.at("planners")) {
    const auto directions = planner.at("directions").get<std::string>();
    const auto known = ParseEnum<Directions>(directions);
    if (!known) throw InputError("'" + directions + "' are no directions");
    call.planners.push_back({planner.at("name").get<std::string>(), *known,
                             Checked("trials", planner.at("trials").get<int>(), kMostPlanned)});
  }
  if (const auto shard = json.find("shard"); shard != json.end()) {
    call.shard.count = Checked("count", shard->at("count").get<int>(), kMostPlanned);
    call.shard.index = Checked("index", shard->at("index").get<int>(), call.shard.count);
  }
  return call;
}

int MostTrials(const PlannedCall& call) {
  int most = 0;
  for (const PlannedPlanner& planner : call.planners) most = std::max(most, planner.trials);
  return most;
}

std::size_t NumProblems(const PlannedCall& call) {
  std::size_t number = 0;
  for (const PlannedSet& set : call.sets) number += set.problems.size();
  return number;
}

/// Calls `visit` with every trial of the call's shard: set, problem's place in it, trial. The first
/// trials of all problems, then the second; of other shards it takes no time.
template <typename Visit>
void ForEachTrial(const PlannedCall& call, const Visit& visit) {
  const std::size_t num_problems = NumProblems(call);
  const std::size_t num_parts = call.NumParts();
  for (auto part = static_cast<std::size_t>(call.shard.index - 1); part < num_parts;
       part += static_cast<std::size_t>(call.shard.count)) {
    std::size_t place = part % num_problems;
    std::size_t set = 0;
    for (; place >= call.sets[set].problems.size(); ++set) place -= call.sets[set].problems.size();
    visit(set, place, static_cast<int>(part / num_problems) + 1);
  }
}

PlannedTrial TrialAt(const PlannedCall& call, std::size_t set, std::size_t place, int trial) {
  return {call.sets[set].name, call.sets[set].problems[place], trial};
}

/// Calls `visit` with every run of the call and whether its trial's other one may make it needless.
template <typename Visit>
void ForEachRun(const PlannedCall& call, const Visit& visit) {
  ForEachTrial(call, [&](std::size_t set, std::size_t place, int number) {
    const PlannedTrial trial = TrialAt(call, set, place, number);
    for (const PlannedPlanner& planner : call.planners) {
      if (number > planner.trials) continue;
      const bool is_auto = planner.directions == Directions::kAuto;
      if (planner.directions != Directions::kBackward) {
        visit(PlannedRun{trial, planner.name, Direction::kForward}, false);
      }
      if (planner.directions != Directions::kForward) {
        visit(PlannedRun{trial, planner.name, Direction::kBackward}, is_auto);
      }
    }
  });
}

/// The whole that a shard is of, so that those of one whole are equal.
PlannedCall WholeOf(PlannedCall call) {
  call.shard = {};
  std::sort(call.planners.begin(), call.planners.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return call;
}

std::string Describe(const PlannedCall& whole) {
  std::vector<std::string> sets;
  for (const PlannedSet& set : whole.sets) {
    std::vector<std::string> ranges;
    for (const auto& [first, last] : RangesOf(set.problems)) {
      ranges.push_back(first == last ? fmt::format("{}", first)
                                     : fmt::format("{}-{}", first, last));
    }
    sets.push_back(fmt::format("{} {}", set.name, fmt::join(ranges, ",")));
  }
  std::vector<std::string> planners;
  for (const PlannedPlanner& planner : whole.planners) {
    planners.push_back(fmt::format("{} ({}, {} trial{})", planner.name,
                                   EnumName(planner.directions), planner.trials,
                                   planner.trials == 1 ? "" : "s"));
  }
  return fmt::format("{} by {}", fmt::join(sets, " and "), fmt::join(planners, " and "));
}

}  // namespace

std::size_t PlannedCall::NumParts() const {
  return NumProblems(*this) * static_cast<std::size_t>(MostTrials(*this));
}

std::vector<PlannedTrial> PlannedCall::Trials() const {
  std::vector<std::tuple<std::size_t, std::size_t, int>> places;
  ForEachTrial(*this, [&](std::size_t set, std::size_t place, int trial) {
    places.emplace_back(set, place, trial);
  });
  std::sort(places.begin(), places.end());
  std::vector<PlannedTrial> trials;
  for (const auto& [set, place, trial] : places) {
    trials.push_back(TrialAt(*this, set, place, trial));
  }
  return trials;
}

void AddCalls(const SessionPlan& more, SessionPlan* plan) {
  for (const PlannedCall& call : more) {
    if (std::find(plan->begin(), plan->end(), call) == plan->end()) plan->push_back(call);
  }
}

std::string PlanText(const SessionPlan& plan) {
  nlohmann::json calls = nlohmann::json::array();
  for (const PlannedCall& call : plan) calls.push_back(ToJson(call));
  return calls.dump();
}

std::optional<SessionPlan> ReadPlan(const std::map<std::string, std::string>& flags) {
  const auto text = flags.find(kPlanSetting);
  if (text == flags.end()) return std::nullopt;
  SessionPlan plan;
  const auto refuse = [](const char* reason) {
    return InputError(
        fmt::format("the setting {} is none that the driver wrote: {}", kPlanSetting, reason));
  };
  try {
    const auto calls = nlohmann::json::parse(text->second);
    for (const auto& call : calls) plan.push_back(FromJson(call));
  } catch (const nlohmann::json::exception& error) {
    throw refuse(error.what());
  } catch (const InputError& error) {
    throw refuse(error.what());
  }
  return plan;
}

std::map<PlannedRun, bool> RunsOf(const SessionPlan& plan) {
  std::map<PlannedRun, bool> runs;
  for (const PlannedCall& call : plan) {
    ForEachRun(call, [&](const PlannedRun& run, bool may_be_needless) {
      runs.emplace(run, may_be_needless);
    });
  }
  return runs;
}

std::string LeftOutName(const std::string& problem_set, int problem_index) {
  return fmt::format("{} {}", problem_set, problem_index);
}

std::set<std::string> ProblemsOf(const SessionPlan& plan) {
  std::set<std::pair<std::string, int>> problems;
  for (const PlannedCall& call : plan) {
    ForEachTrial(call, [&](std::size_t set, std::size_t place, int /*trial*/) {
      problems.emplace(call.sets[set].name, call.sets[set].problems[place]);
    });
  }
  std::set<std::string> names;
  for (const auto& [set, index] : problems) names.insert(LeftOutName(set, index));
  return names;
}

int CountOwed(const SessionPlan& plan, const std::map<PlannedRun, bool>& made,
              const std::map<std::string, std::string>& left_out) {
  int num_owed = 0;
  for (const auto& [run, may_be_needless] : RunsOf(plan)) {
    const PlannedTrial& trial = run.trial;
    if (made.contains(run)) continue;
    if (left_out.contains(LeftOutName(trial.problem_set, trial.problem_index))) continue;
    const auto first = made.find({trial, run.planner, Direction::kForward});
    if (may_be_needless && first != made.end() && first->second) continue;
    ++num_owed;
  }
  return num_owed;
}

std::vector<std::string> MissingShards(const SessionPlan& plan) {
  const std::map<PlannedRun, bool> planned = RunsOf(plan);
  std::vector<std::pair<PlannedCall, std::set<int>>> wholes;  // and into how many they are divided
  for (const PlannedCall& call : plan) {
    if (call.shard.count == 1) continue;
    PlannedCall whole = WholeOf(call);
    auto known = std::find_if(wholes.begin(), wholes.end(),
                              [&](const auto& one) { return one.first == whole; });
    if (known == wholes.end()) known = wholes.emplace(known, std::move(whole), std::set<int>());
    known->second.insert(call.shard.count);
  }
  std::vector<std::string> lines;
  for (const auto& [whole, counts] : wholes) {
    std::vector<std::string> missing;
    for (const int count : counts) {
      PlannedCall part = whole;
      const auto num_parts =
          std::min<std::size_t>(static_cast<std::size_t>(count), whole.NumParts());
      for (part.shard = {1, count}; static_cast<std::size_t>(part.shard.index) <= num_parts;
           ++part.shard.index) {
        bool all_planned = true;
        ForEachRun(part, [&](const PlannedRun& run, bool /*may_be_needless*/) {
          all_planned = all_planned && planned.contains(run);
        });
        if (!all_planned) missing.push_back(fmt::format("{}/{}", part.shard.index, count));
      }
    }
    if (missing.empty()) continue;
    lines.push_back(fmt::format("{} of {}", fmt::join(missing, ", "), Describe(whole)));
  }
  return lines;
}

std::optional<DirectionsDifference> FindDirectionsDifference(const SessionPlan& first,
                                                             const SessionPlan& second) {
  std::map<std::string, Directions> asked;
  for (const PlannedCall& call : first) {
    for (const PlannedPlanner& one : call.planners) asked.emplace(one.name, one.directions);
  }
  for (const PlannedCall& call : second) {
    for (const PlannedPlanner& one : call.planners) {
      const auto before = asked.find(one.name);
      if (before == asked.end() || before->second == one.directions) continue;
      return DirectionsDifference{one.name, before->second, one.directions};
    }
  }
  return std::nullopt;
}

}  // namespace planbench
