#include "results/session_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/error.h"

namespace planbench {
namespace {

using Ranges = std::vector<std::pair<int, int>>;  // first and last

constexpr int kMostPlanned = 1'000'000;  // the driver's flags take no more, either

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

/// Calls `visit` with every run of the call and whether its trial's other one may make it needless.
template <typename Visit>
void ForEachRun(const PlannedCall& call, const Visit& visit) {
  for (const PlannedTrial& trial : call.Trials()) {
    for (const PlannedPlanner& planner : call.planners) {
      if (trial.trial > planner.trials) continue;
      const bool is_auto = planner.directions == Directions::kAuto;
      if (planner.directions != Directions::kBackward) {
        visit(PlannedRun{trial, planner.name, Direction::kForward}, false);
      }
      if (planner.directions != Directions::kForward) {
        visit(PlannedRun{trial, planner.name, Direction::kBackward}, is_auto);
      }
    }
  }
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

std::size_t PlannedCall::NumProblems() const {
  std::size_t number = 0;
  for (const PlannedSet& set : sets) number += set.problems.size();
  return number;
}

int PlannedCall::MostTrials() const {
  int most = 0;
  for (const PlannedPlanner& planner : planners) most = std::max(most, planner.trials);
  return most;
}

int PlannedCall::ShardOf(std::size_t problem, int trial) const {
  const std::size_t part = static_cast<std::size_t>(trial - 1) * NumProblems() + problem;
  return static_cast<int>(part % static_cast<std::size_t>(shard.count)) + 1;
}

std::vector<PlannedTrial> PlannedCall::Trials() const {
  std::vector<PlannedTrial> trials;
  const int most = MostTrials();
  std::size_t problem = 0;
  for (const PlannedSet& set : sets) {
    for (const int index : set.problems) {
      for (int trial = 1; trial <= most; ++trial) {
        if (ShardOf(problem, trial) == shard.index) trials.push_back({set.name, index, trial});
      }
      ++problem;
    }
  }
  return trials;
}

std::optional<Directions> PlannedCall::DirectionsOf(std::string_view planner,
                                                    const PlannedTrial& trial) const {
  const auto asked = std::find_if(planners.begin(), planners.end(),
                                  [&](const auto& one) { return one.name == planner; });
  if (asked == planners.end() || trial.trial < 1 || trial.trial > asked->trials) {
    return std::nullopt;
  }
  std::size_t before = 0;
  for (const PlannedSet& set : sets) {
    if (set.name == trial.problem_set) {
      const auto place =
          std::lower_bound(set.problems.begin(), set.problems.end(), trial.problem_index);
      if (place == set.problems.end() || *place != trial.problem_index) return std::nullopt;
      const std::size_t problem = before + static_cast<std::size_t>(place - set.problems.begin());
      if (ShardOf(problem, trial.trial) != shard.index) return std::nullopt;
      return asked->directions;
    }
    before += set.problems.size();
  }
  return std::nullopt;
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

int CountOwed(const SessionPlan& plan, const std::map<PlannedRun, bool>& made,
              const std::map<std::string, std::string>& left_out) {
  std::set<PlannedRun> owed;
  for (const PlannedCall& call : plan) {
    ForEachRun(call, [&](const PlannedRun& run, bool may_be_needless) {
      if (made.contains(run)) return;
      const PlannedTrial& trial = run.trial;
      if (left_out.contains(fmt::format("{} {}", trial.problem_set, trial.problem_index))) return;
      const auto first = made.find({trial, run.planner, Direction::kForward});
      if (may_be_needless && first != made.end() && first->second) return;
      owed.insert(run);
    });
  }
  return static_cast<int>(owed.size());
}

std::vector<std::string> MissingShards(const SessionPlan& plan) {
  std::set<PlannedRun> planned;
  std::vector<std::pair<PlannedCall, std::set<int>>> wholes;  // and into how many they are divided
  for (const PlannedCall& call : plan) {
    ForEachRun(call, [&](const PlannedRun& run, bool /*may_be_needless*/) { planned.insert(run); });
    if (call.shard.count == 1) continue;
    PlannedCall whole = WholeOf(call);
    auto known = std::find_if(wholes.begin(), wholes.end(),
                              [&](const auto& one) { return one.first == whole; });
    if (known == wholes.end()) known = wholes.insert(known, {std::move(whole), {}});
    known->second.insert(call.shard.count);
  }
  std::vector<std::string> lines;
  for (const auto& [whole, counts] : wholes) {
    std::vector<std::string> missing;
    for (const int count : counts) {
      PlannedCall part = whole;
      for (part.shard = {1, count}; part.shard.index <= count; ++part.shard.index) {
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
