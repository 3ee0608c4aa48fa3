#include "benchmark_driver/earlier_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "benchmark_driver/driver_flags.h"
#include "common/error.h"
#include "results/reproduce.h"

namespace planbench {
namespace {

using Flags = std::map<std::string, std::string>;

constexpr char kShardFlag[] = "shard";
constexpr char kSetsFlag[] = "sets";

std::vector<std::string> SplitAt(char separator, const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// "ara=auto rrtc=forward" by planner.
std::map<std::string, Directions> ParseEntrants(const std::string& text) {
  std::map<std::string, Directions> directions;
  for (const std::string& entrant : SplitAt(' ', text)) {
    const std::size_t equals = std::min(entrant.find('='), entrant.size() - 1);
    const auto direction = ParseEnum<Directions>(entrant.substr(equals + 1));
    if (direction) directions[entrant.substr(0, equals)] = *direction;
  }
  return directions;
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
  for (const char* flag : {kSetsFlag, "problems-range", "trials", "directions", kShardFlag}) {
    if (!flags.contains(flag)) return {};
  }
  const auto sets = SetsOf(session, served);
  const auto directions = ParseEnum<Directions>(flags.at("directions"));
  if (!sets || !directions) return {};
  DriverOptions options;
  options.conditions = session.conditions;
  options.conditions.request.run_id = session.run_id;
  options.sets = *sets;
  const std::string& range = flags.at("problems-range");
  if (!range.empty()) options.problem_indices = ParseRange(range);
  const std::string& shard = flags.at(kShardFlag);
  if (!shard.empty()) options.shard = ParseShard(shard);
  const std::string& trials = flags.at("trials");
  std::from_chars(trials.data(), trials.data() + trials.size(), options.trials);

  std::map<std::string, NodeStatusMessage> planners;
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.kind == NodeKind::kPlanner) planners[node.name] = node;
  }
  // Sessions of before told of the contestants of their call alone.
  const auto told = flags.find(kEntrants);
  const auto asked = ParseEntrants(told == flags.end() ? "" : told->second);
  std::vector<Entrant> entrants;
  for (const Contestant& contestant : session.conditions.contestants) {
    const auto own = asked.find(contestant.planner);
    if (told != flags.end() && own == asked.end()) continue;
    const auto first = contestant.first_path_of;
    if (!planners.contains(contestant.planner) || (!first.empty() && !planners.contains(first))) {
      return {};
    }
    entrants.push_back(
        MakeEntrant(contestant, own == asked.end() ? *directions : own->second, planners));
  }
  std::vector<ScheduledRun> plan = MakeSchedule(options, entrants, served);
  std::erase_if(plan, [&](const ScheduledRun& run) {
    return session.left_out.contains(fmt::format("{} {}", run.problem_set, run.problem_index));
  });
  return plan;
}

}  // namespace

std::string EntrantsText(const std::vector<Entrant>& entrants) {
  std::vector<std::string> texts;
  for (const Entrant& entrant : entrants) {
    texts.push_back(fmt::format("{}={}", entrant.planner, EnumName(entrant.directions)));
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
      // Of several shards, for one: what they were to make is not known.
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
  if (scope == PlanScope::kAll || before.empty() || now.empty()) return now;
  if (scope == PlanScope::kPart) {
    now = before;
  } else {
    now[kMergedCommands] = JoinCommands({ReproducingCommand(before), ReproducingCommand(now)});
    now[kSetsFlag] = fmt::format("{}", fmt::join(sets, ","));
    // A session that was merged of shards may be given further ones.
    const auto held = before.find(kShardFlag);
    std::string& shard = now[kShardFlag];
    if (held != before.end() && !shard.empty() &&
        (", " + held->second + ", ").find(", " + shard + ", ") == std::string::npos) {
      shard = held->second + ", " + shard;
    }
  }
  now.erase(kMergedParts);  // what was merged, not what went on with it
  return now;
}

}  // namespace planbench
