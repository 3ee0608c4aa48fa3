#include "report/session_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/lookup.h"
#include "messaging/session_conditions.h"
#include "results/comparison.h"
#include "results/quality.h"
#include "results/reproduce.h"

namespace planbench {
namespace {

/// NaN, which is shown as nothing, for none.
double OrNothing(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Settings by name, of the contestant of that name; none without one.
std::map<std::string, std::string> SettingsOf(const StoredSession& session,
                                              const std::string& contestant) {
  for (const StoredContestant& one : session.contestants) {
    if (one.name == contestant) return ParseSettings(one.settings);
  }
  return {};
}

/// Names of settings, of the contestants that several sessions have.
std::map<std::string, std::set<std::string>> SettingsByContestant(
    const ComparedSessions& compared) {
  std::map<std::string, std::set<std::size_t>> sessions;
  for (const ComparedContestant& one : compared.contestants()) {
    sessions[one.own_name].insert(one.session);
  }
  std::map<std::string, std::set<std::string>> names;
  for (const auto& [contestant, in] : sessions) {
    if (in.size() < 2) continue;
    for (const std::size_t session : in) {
      for (const auto& [name, value] : SettingsOf(compared.sessions()[session], contestant)) {
        names[contestant].insert(name);
      }
    }
  }
  return names;
}

}  // namespace

Table SessionTable(const ComparedSessions& compared, bool only_different) {
  Table table{"sessions", only_different ? "Where the sessions differ" : "Sessions", "", {}, {}};
  table.columns.push_back({"field", ""});
  // By field, in the order of the table; a session without it has "".
  std::vector<std::pair<std::string, std::vector<std::string>>> fields;
  const auto add = [&](const std::string& name, const auto& value_of, const auto& is_same) {
    std::vector<std::string> values;
    for (const StoredSession& session : compared.sessions()) values.push_back(value_of(session));
    const bool same = std::all_of(values.begin(), values.end(), [&](const std::string& value) {
      return is_same(value, values.front());
    });
    if (!same || !only_different) fields.emplace_back(name, std::move(values));
  };
  const auto field = [&](const std::string& name, const auto& value_of) {
    add(name, value_of, std::equal_to<>());
  };
  // Of flags and settings, in which numbers are numbers.
  const auto setting = [&](const std::string& name, const auto& value_of) {
    add(name, value_of, IsSameSetting);
  };
  const auto member = [](std::string StoredSession::*text) {
    return [text](const StoredSession& session) { return session.*text; };
  };
  field("session", member(&StoredSession::run_id));
  field("begun", member(&StoredSession::date));
  field("version", member(&StoredSession::version));
  field("commit", member(&StoredSession::commit));
  field("host", member(&StoredSession::host));
  field("processor", member(&StoredSession::cpu));
  std::set<std::string> told;
  for (const StoredSession& session : compared.sessions()) {
    for (const auto& [name, value] : session.machine) told.insert(name);
  }
  told.erase("cpu");  // that of the session
  for (const std::string& name : told) {
    setting(name, [&](const StoredSession& session) {
      return Lookup(session.machine, name).value_or("");
    });
  }
  field("robot", member(&StoredSession::robot));
  field("seed", member(&StoredSession::seed));
  std::set<std::string> flags;
  for (const StoredSession& session : compared.sessions()) {
    for (const auto& [flag, value] : session.flags) flags.insert(flag);
  }
  for (const std::string& flag : flags) {
    if (!IsFlag(flag)) continue;
    if (!only_different && flag != "time" && flag != "trials") continue;
    setting("--" + flag,
            [&](const StoredSession& session) { return Lookup(session.flags, flag).value_or(""); });
  }
  if (only_different) {
    for (const auto& contestant : SettingsByContestant(compared)) {
      for (const std::string& key : contestant.second) {
        setting(fmt::format("{}: {}", contestant.first, key), [&](const StoredSession& session) {
          return Lookup(SettingsOf(session, contestant.first), key).value_or("");
        });
      }
    }
  }
  if (!only_different) {
    field("command",
          [](const StoredSession& session) { return ReproducingCommand(session.flags); });
  }
  for (std::size_t i = 0; i < compared.sessions().size(); ++i) {
    table.columns.push_back({fmt::format("session_{}", i + 1), compared.session_names()[i]});
  }
  for (auto& [name, values] : fields) {
    std::vector<Cell> row = {name};
    row.insert(row.end(), values.begin(), values.end());
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table ChangeTable(const ComparedSessions& compared) {
  Table table{
      "changes",
      "What changed from session to session",
      "Contestants of one name, on the problems that both sessions have, against the session that "
      "was begun first. Both: problems solved in both, in more than 0 s. Time ratio: of these, "
      "geometric mean of after / before, with Student's 95 % interval. p: signed-rank test of "
      "problem by problem, adjusted for all rows (Holm). Faster or slower: beyond chance at the "
      "5 % level; too few problems: that could not be shown of so few.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"before", "before"},
       {"after", "after"},
       {"change", "change"},
       {"problems", "problems", Style::kCount},
       {"confirmed_before_percent", "confirmed before, % [95 %]", Style::kShare, true},
       {"confirmed_after_percent", "confirmed after, % [95 %]", Style::kShare, true},
       {"problems_in_ratio", "both", Style::kCount},
       {"time_ratio", "time ratio [95 %]", Style::kRatio, true},
       {"p_holm", "p (Holm)", Style::kPValue}},
      {}};
  constexpr std::size_t kChange = 4;
  const auto begun = [&](const ComparedContestant& one) -> const std::string& {
    return compared.sessions()[one.session].date;
  };
  std::vector<PairedComparison> results;
  const auto confirmed = [](const Outcomes& outcomes) {
    const SuccessSummary s = SummarizeSuccess(outcomes);
    return Percent(s.share, s.interval);
  };
  // Not by rank, which would tear the sessions of a contestant apart.
  std::vector<std::reference_wrapper<const ComparedContestant>> contestants(
      compared.contestants().begin(), compared.contestants().end());
  std::stable_sort(contestants.begin(), contestants.end(),
                   [&](const ComparedContestant& a, const ComparedContestant& b) {
                     return std::tie(a.own_name, begun(a)) < std::tie(b.own_name, begun(b));
                   });
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    for (const ComparedContestant& after : contestants) {
      const ComparedContestant* before = nullptr;
      for (const ComparedContestant& one : compared.contestants()) {
        const bool is_other = one.own_name == after.own_name && one.session != after.session;
        if (!is_other || !by_contestant.contains(one.name)) continue;
        if (begun(one) < begun(after) && (before == nullptr || begun(one) < begun(*before))) {
          before = &one;
        }
      }
      if (before == nullptr || !by_contestant.contains(after.name)) continue;
      std::map<std::string, Outcomes> common;
      for (const auto* one : {before, &after}) common[one->name] = by_contestant.at(one->name);
      common = OnCommonProblems(std::move(common));
      const Outcomes& old_outcomes = common.at(before->name);
      const Outcomes& new_outcomes = common.at(after.name);
      const PairedComparison result = Compare(new_outcomes, old_outcomes);
      if (result.num_problems == 0) continue;
      table.rows.push_back(
          {set, after.own_name, compared.session_names()[before->session],
           compared.session_names()[after.session], std::string(), result.num_problems,
           confirmed(old_outcomes), confirmed(new_outcomes), result.num_in_ratio(),
           result.ratio ? Cell(Estimate{result.ratio->mean, result.ratio->interval}) : Cell()});
      results.push_back(result);
    }
  }
  const std::vector<double> adjusted = AdjustedPValues(results);
  const int fewest = FewestDifferences(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SignedRankTest& test = results[i].test;
    const char* change = adjusted[i] <= kTestLevel
                             ? (test.negative > test.positive ? "faster" : "slower")
                         : results[i].num_problems < fewest ? "too few problems"
                                                            : "not shown";
    table.rows[i][kChange] = std::string(change);
    table.rows[i].emplace_back(adjusted[i]);
  }
  table.note = fmt::format("{}{}{}{}", kProblemTimeNote, table.note, ZeroTimesNote(results),
                           NearRatiosNote(results));
  return table;
}

Table ConditionTable(const ComparedSessions& compared) {
  Table table{"conditions",
              "Conditions of the measurement",
              "Spread: longest over shortest time among the trials of a problem, its median over "
              "the problems whose trials were all confirmed: the luck of the draw and the noise of "
              "the machine. Noise: likewise of what a checked configuration cost on average, in "
              "which luck counts little, among the confirmed attempts at a problem in one "
              "direction. Both need several trials of a problem, which a "
              "contestant whose path does not depend on the seed has none of. Load before: of the "
              "machine over the minute before a run, the session's own included; median. Waited: "
              "what threads of the planner waited for a processor, summed over them, and what a "
              "hypervisor took, in per cent of the time from request to answer, summed over the "
              "runs; several threads that wait at once can make it more than 100. Disturbed: runs "
              "that lost more than --max-disturbance so; repeated: had "
              "been, and were made again.",
              {{"session", "session"},
               {"contestant", "contestant"},
               {"attempts", "attempts", Style::kCount},
               {"no_answer", "no answer", Style::kCount},
               {"spread", "spread of trials", Style::kNumber},
               {"noise", "noise of the machine", Style::kNumber},
               {"load_before", "load before", Style::kNumber},
               {"waiting_percent", "waited, %", Style::kNumber},
               {"disturbed", "disturbed", Style::kCount},
               {"repeated", "repeated", Style::kCount}},
              {}};
  for (const ComparedContestant& contestant : compared.contestants()) {
    const auto silent =
        std::count_if(contestant.runs.begin(), contestant.runs.end(),
                      [](auto* run) { return run->status == PlanStatus::kNoAnswer; });
    std::vector<double> loads;
    double waiting_s = 0, measured_s = 0;
    for (const StoredRun* run : contestant.runs) {
      if (run->load_before) loads.push_back(*run->load_before);
      if (!run->waiting_s) continue;
      waiting_s += *run->waiting_s + run->steal_s.value_or(0);
      measured_s += run->roundtrip_time_s;
    }
    const auto disturbed = std::count_if(contestant.runs.begin(), contestant.runs.end(),
                                         [](auto* run) { return run->disturbed; });
    const auto repeated = std::count_if(contestant.runs.begin(), contestant.runs.end(),
                                        [](auto* run) { return run->repeats > 0; });
    table.rows.push_back({compared.session_names()[contestant.session], contestant.name,
                          static_cast<int>(contestant.runs.size()), static_cast<int>(silent),
                          OrNothing(TrialSpread(compared.pooled().at(contestant.name))),
                          OrNothing(CheckingSpread(contestant)), Summarize(std::move(loads)).median,
                          100 * waiting_s / measured_s, static_cast<int>(disturbed),
                          static_cast<int>(repeated)});
  }
  return table;
}

}  // namespace planbench
