#include "benchmark_driver/earlier_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "common/lookup.h"
#include "results/reproduce.h"

namespace planbench {

std::optional<SessionPlan> EarlierPlan(const SessionMessage& last, const PlannedCall& call) {
  std::optional<SessionPlan> plan;
  try {
    plan = ReadPlan(last.settings);
  } catch (const InputError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
  // Of one that made all of it nothing has to be known.
  if (!plan && last.finished) return SessionPlan();
  if (!plan) return std::nullopt;
  if (const auto difference = FindDirectionsDifference(*plan, {call})) {
    throw InputError(fmt::format(
        "--resume: directions of '{}' were {} when the session was begun and are {} now",
        difference->planner, EnumName(difference->first), EnumName(difference->second)));
  }
  return plan;
}

std::vector<std::string> AwaitedShards(const SessionMessage& last,
                                       const std::optional<SessionPlan>& plan) {
  if (!IsMerged(last.settings)) return {};
  if (plan) return MissingShards(*plan);
  if (Lookup(last.settings, kShardFlag).value_or("").empty()) return {};
  return {kUnknownShards};
}

void AddEarlier(const std::vector<SessionMessage>& earlier, SessionConditions* conditions) {
  std::vector<Contestant> all;
  const auto add = [&all](const std::vector<Contestant>& contestants) {
    for (const Contestant& one : contestants) {
      if (std::none_of(all.begin(), all.end(),
                       [&](const Contestant& known) { return known.planner == one.planner; })) {
        all.push_back(one);
      }
    }
  };
  for (const SessionMessage& session : earlier) {
    add(session.conditions.contestants);
    conditions->problem_sets.insert(session.conditions.problem_sets.begin(),
                                    session.conditions.problem_sets.end());
  }
  for (const Contestant& one : conditions->contestants) {
    for (const Contestant& known : all) {
      if (known.name != one.name || known.planner == one.planner) continue;
      throw InputError(fmt::format(
          "--resume: the planner '{}' would have a name that '{}' has in the session: '{}'",
          one.planner, known.planner, one.name));
    }
  }
  add(conditions->contestants);
  conditions->contestants = std::move(all);
}

std::map<std::string, std::string> FlagsOfResumed(const std::map<std::string, std::string>& before,
                                                  std::map<std::string, std::string> now,
                                                  PlanScope scope) {
  if (before.empty() || now.empty()) return now;
  if (scope == PlanScope::kPart) {
    now = before;
  } else if (scope == PlanScope::kOther) {
    now[kMergedCommands] = JoinCommands({ReproducingCommand(before), ReproducingCommand(now)});
  }
  // What was merged is not what went on with it, which holds it all the same.
  now.erase(kMergedParts);
  for (const char* parts : {kHeldParts, kMergedParts}) {
    if (const auto held = Lookup(before, parts)) now[kHeldParts] = *held;
  }
  return now;
}

}  // namespace planbench
