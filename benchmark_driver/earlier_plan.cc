#include "benchmark_driver/earlier_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "benchmark_driver/driver_flags.h"
#include "common/error.h"
#include "results/entrants.h"
#include "results/reproduce.h"
#include "results/shards.h"

namespace planbench {
namespace {

using Flags = std::map<std::string, std::string>;

constexpr char kSetsFlag[] = "sets";

std::vector<std::string> SplitAt(char separator, const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Sets that the session was to run and that are served as they were then; nothing if one is not.
std::optional<std::vector<std::string>> SetsOf(const SessionMessage& session,
                                               const ProblemSetsMessage& served) {
  std::vector<std::string> sets = SplitAt(',', session.settings.at(kSetsFlag));
  if (sets.empty()) {
    for (const auto& [name, content] : session.conditions.problem_sets) sets.push_back(name);
  }
  for (const std::string& name : sets) {
    const auto then = session.conditions.problem_sets.find(name);
    if (then == session.conditions.problem_sets.end() ||
        std::none_of(served.sets.begin(), served.sets.end(), [&](const ProblemSetSummary& now) {
          return now.name == name && now.content_id == then->second;
        })) {
      return std::nullopt;
    }
  }
  if (sets.empty()) return std::nullopt;
  return sets;
}

/// What the driver that told it had planned; nothing if that is not known. Throws InputError for
/// flags that cannot be.
std::vector<ScheduledRun> PlanOf(const SessionMessage& session, const ProblemSetsMessage& served) {
  const Flags& flags = session.settings;
  for (const char* flag : {kSetsFlag, "problems-range", "trials", kShardFlag, kEntrants}) {
    if (!flags.contains(flag)) return {};
  }
  const auto sets = SetsOf(session, served);
  if (!sets) return {};
  DriverOptions options;
  options.conditions = session.conditions;
  options.conditions.request.run_id = session.run_id;
  options.sets = *sets;
  const std::string& range = flags.at("problems-range");
  if (!range.empty()) options.problem_indices = ParseRange(range);
  const std::string& trials = flags.at("trials");
  std::from_chars(trials.data(), trials.data() + trials.size(), options.trials);

  std::map<std::string, NodeStatusMessage> planners;
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.kind == NodeKind::kPlanner) planners[node.name] = node;
  }
  // The conditions have the contestants of before, too.
  const AskedDirections asked = ParseEntrants(flags.at(kEntrants));
  std::vector<Entrant> entrants;
  for (const Contestant& contestant : session.conditions.contestants) {
    const auto own = asked.find(contestant.planner);
    if (own == asked.end()) continue;
    const auto first = contestant.first_path_of;
    if (!planners.contains(contestant.planner) || (!first.empty() && !planners.contains(first))) {
      return {};
    }
    entrants.push_back(MakeEntrant(contestant, own->second, planners));
  }
  const auto asked_shard = flags.find(kAskedShard);
  const std::string& shards =
      asked_shard == flags.end() ? flags.at(kShardFlag) : asked_shard->second;
  std::vector<ScheduledRun> plan;
  for (const std::string& shard : ParseShards(shards.empty() ? "1/1" : shards)) {
    options.shard = ParseShard(shard);
    for (ScheduledRun& run : MakeSchedule(options, entrants, served)) {
      plan.push_back(std::move(run));
    }
  }
  std::erase_if(plan, [&](const ScheduledRun& run) {
    return session.left_out.contains(fmt::format("{} {}", run.problem_set, run.problem_index));
  });
  return plan;
}

}  // namespace

std::string EntrantsText(const std::vector<Entrant>& entrants) {
  std::vector<std::string> texts;
  for (const Entrant& entrant : entrants) {
    const bool is_forward = entrant.directions == Directions::kAuto && entrant.IsAskedOnce();
    texts.push_back(fmt::format("{}={}", entrant.planner,
                                EnumName(is_forward ? Directions::kForward : entrant.directions)));
  }
  return fmt::format("{}", fmt::join(texts, " "));
}

std::vector<ScheduledRun> EarlierPlan(const std::vector<SessionMessage>& earlier,
                                      const ProblemSetsMessage& served) {
  std::vector<ScheduledRun> all;
  std::set<std::string> known;
  const SessionMessage* before = nullptr;
  for (const SessionMessage& session : earlier) {
    // A call tells of its beginning and of its end, and may repeat both.
    const bool is_same = before != nullptr && before->settings == session.settings &&
                         before->conditions == session.conditions;
    before = &session;
    if (is_same) continue;
    try {
      for (ScheduledRun& run : PlanOf(session, served)) {
        if (known.insert(run.request_id).second) all.push_back(std::move(run));
      }
    } catch (const InputError&) {
      // What it was to make is not known.
    }
  }
  return all;
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

Flags FlagsOfResumed(const Flags& before, Flags now, PlanScope scope,
                     const std::vector<std::string>& sets) {
  if (before.empty() || now.empty()) return now;
  // A session that was merged of shards may be given further ones, and keeps those it has.
  std::set<std::string> shards = ShardsOf(before);
  const std::size_t num_held = shards.size();
  shards.merge(ShardsOf(now));
  const bool adds_shard = num_held > 0 && shards.size() > num_held;
  if (scope == PlanScope::kPart && !adds_shard) {
    now = before;
  } else if (scope != PlanScope::kAll) {
    now[kMergedCommands] = JoinCommands({ReproducingCommand(before), ReproducingCommand(now)});
    now[kSetsFlag] = fmt::format("{}", fmt::join(sets, ","));
    if (num_held > 0) {
      now[kAskedShard] = now[kShardFlag];
      now[kShardFlag] = JoinShards(shards);
    }
  }
  // What was merged is not what went on with it, which holds it all the same.
  now.erase(kMergedParts);
  for (const char* parts : {kHeldParts, kMergedParts}) {
    if (const auto held = before.find(parts); held != before.end()) now[kHeldParts] = held->second;
  }
  return now;
}

}  // namespace planbench
