#include "results/compared_sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "common/numbers.h"
#include "results/awaited_attempts.h"
#include "results/comparison.h"
#include "results/reason_count.h"
#include "results/training.h"

namespace planbench {
namespace {

/// The names that stand for several.
std::set<std::string> Repeated(const std::vector<std::string>& names) {
  std::map<std::string, int> counts;
  for (const std::string& name : names) ++counts[name];
  std::set<std::string> repeated;
  for (const auto& [name, count] : counts) {
    if (count > 1) repeated.insert(name);
  }
  return repeated;
}

/// Calls `extend` with those that are not unique.
void ExtendRepeated(std::vector<std::string>* names,
                    const std::function<std::string(std::size_t)>& extend) {
  const std::set<std::string> repeated = Repeated(*names);
  for (std::size_t i = 0; i < names->size(); ++i) {
    if (repeated.contains((*names)[i])) (*names)[i] += extend(i);
  }
}

std::string Numbered(std::size_t i) { return fmt::format(" #{}", i + 1); }

std::vector<std::string> NameSessions(const std::vector<StoredSession>& sessions) {
  std::vector<std::string> names;
  for (const StoredSession& session : sessions) {
    const std::filesystem::path file = std::filesystem::absolute(session.file);
    names.push_back(file.filename() == "results.sqlite" ? file.parent_path().filename().string()
                                                        : file.filename().string());
  }
  ExtendRepeated(&names, [&](std::size_t i) { return " " + sessions[i].run_id; });
  ExtendRepeated(&names, Numbered);
  return names;
}

/// Scenes of a set's problems, by index, as far as a session tells.
using Scenes = std::map<int, std::string>;

bool AreAlike(const Scenes& one, const Scenes& other) {
  return std::all_of(one.begin(), one.end(), [&](const auto& problem) {
    const auto found = other.find(problem.first);
    return found == other.end() || found->second == problem.second;
  });
}

/// Renames sets that are not what an earlier session calls so; returns their new names.
std::vector<std::string> TellSetsApart(const std::vector<std::string>& session_names,
                                       std::vector<StoredSession>* sessions) {
  std::map<std::string, std::vector<std::pair<std::string, Scenes>>> known;  // By their own name.
  std::vector<std::string> others;
  for (std::size_t s = 0; s < sessions->size(); ++s) {
    std::map<std::string, Scenes> sets;
    for (const StoredRun& run : (*sessions)[s].runs) {
      Scenes& scenes = sets[run.problem_set];
      if (!run.scene_id.empty()) scenes[run.problem_index] = run.scene_id;
    }
    std::map<std::string, std::string> names;
    for (auto& [set, scenes] : sets) {
      auto& versions = known[set];
      const auto found = std::find_if(
          versions.begin(), versions.end(),
          [&, &scenes = scenes](const auto& one) { return AreAlike(scenes, one.second); });
      if (found != versions.end()) {
        names[set] = found->first;
        found->second.merge(scenes);
        continue;
      }
      const bool is_free = versions.empty() && set != kAllSets;
      names[set] = is_free ? set : fmt::format("{} ({})", set, session_names[s]);
      if (!versions.empty()) {
        others.push_back(names[set]);
      } else if (!is_free) {
        (*sessions)[s].warnings.push_back(
            fmt::format("its set '{}' stands as '{}', since all sets together are called so.", set,
                        names[set]));
      }
      versions.emplace_back(names[set], std::move(scenes));
    }
    for (StoredRun& run : (*sessions)[s].runs) run.problem_set = names.at(run.problem_set);
  }
  return others;
}

/// Attempts that await others; how many by session.
std::vector<int> LeaveOutOfEach(std::vector<StoredSession>* sessions) {
  std::vector<int> numbers;
  for (StoredSession& session : *sessions) numbers.push_back(LeaveOutAwaiting(&session));
  return numbers;
}

/// On problems that all contestants tried, `num_contestants` over all sets.
OutcomesBySet CommonOutcomes(const OutcomesBySet& sets, std::size_t num_contestants) {
  OutcomesBySet common;
  for (const auto& [set, by_contestant] : sets) {
    if (by_contestant.size() < num_contestants) continue;
    std::map<std::string, Outcomes> of_all = OnCommonProblems(by_contestant);
    if (!of_all.begin()->second.by_problem.empty()) common[set] = std::move(of_all);
  }
  return common;
}

}  // namespace

bool ComparedContestant::IsTrainedOn(const std::string& problem_set) const {
  const Training training(ParseSettings(settings));
  return std::any_of(runs.begin(), runs.end(), [&](const StoredRun* run) {
    return run->problem_set == problem_set && training.Includes(problem_set, run->scene_id);
  });
}

RankKey RankKeyOf(const Outcomes& outcomes) {
  const auto without_rounding = [](double value) {
    return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
  };
  const double penalised_mean_s = SummarizeTimes(outcomes).penalised_mean_s;
  if (!std::isnan(penalised_mean_s)) return {without_rounding(penalised_mean_s), 0};
  return {kInfinity, -without_rounding(SummarizeSuccess(outcomes).share)};
}

Attempt AttemptOf(const StoredRun& run, const std::string& contestant) {
  Attempt attempt;
  attempt.problem_set = run.problem_set;
  attempt.problem_index = run.problem_index;
  attempt.contestant = contestant;
  attempt.trial = run.trial;
  attempt.direction = run.direction;
  attempt.status = run.status;
  attempt.claimed = run.claimed;
  attempt.time_s = run.time_s.value_or(run.roundtrip_time_s);
  attempt.time_limit_s = run.time_limit_s;
  return attempt;
}

ComparedSessions::ComparedSessions(std::vector<StoredSession> sessions)
    : sessions_(std::move(sessions)),
      num_awaiting_(LeaveOutOfEach(&sessions_)),
      session_names_(NameSessions(sessions_)),
      other_sets_(TellSetsApart(session_names_, &sessions_)) {
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const std::size_t first = contestants_.size();
    for (const StoredContestant& one : sessions_[s].contestants) {
      contestants_.push_back({"", one.name, one.settings, s, 0, {}});
    }
    for (const StoredRun& run : sessions_[s].runs) {
      contestants_[first + run.contestant].runs.push_back(&run);
    }
  }
  for (const ComparedContestant& one : contestants_) {
    if (!one.runs.empty()) continue;
    without_runs_.push_back(one.own_name +
                            (sessions_.size() > 1 ? ", " + session_names_[one.session] : ""));
  }
  std::erase_if(contestants_, [](const auto& one) { return one.runs.empty(); });
  std::vector<std::string> names;
  for (const ComparedContestant& one : contestants_) names.push_back(one.own_name);
  if (sessions_.size() > 1) {
    ExtendRepeated(&names,
                   [&](std::size_t i) { return ", " + session_names_[contestants_[i].session]; });
  }
  ExtendRepeated(&names, Numbered);
  std::vector<Attempt> attempts;
  for (std::size_t i = 0; i < contestants_.size(); ++i) {
    contestants_[i].name = names[i];
    for (const StoredRun* run : contestants_[i].runs) attempts.push_back(AttemptOf(*run, names[i]));
  }
  outcomes_ = GroupOutcomes(attempts);
  pooled_ = PoolSets(outcomes_);
  common_ = CommonOutcomes(outcomes_, pooled_.size());
  pooled_common_ = PoolSets(common_);
  std::map<std::string, RankKey> keys;
  for (const auto& [name, outcomes] : common_.empty() ? pooled_ : pooled_common_) {
    keys[name] = RankKeyOf(outcomes);
  }
  const auto is_better = [&](const auto& a, const auto& b) {
    return keys.at(a.name) < keys.at(b.name);
  };
  std::stable_sort(contestants_.begin(), contestants_.end(), is_better);
  if (common_.empty()) return;
  for (std::size_t i = 0; i < contestants_.size(); ++i) {
    const bool is_alike = i > 0 && !is_better(contestants_[i - 1], contestants_[i]);
    contestants_[i].rank = is_alike ? contestants_[i - 1].rank : static_cast<int>(i) + 1;
  }
}

const ComparedContestant& ContestantCalled(const ComparedSessions& compared,
                                           const std::string& name) {
  const auto& all = compared.contestants();
  return *std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

int NumCommonProblems(const ComparedSessions& compared) {
  const auto& common = compared.pooled_common();
  return common.empty() ? 0 : static_cast<int>(common.begin()->second.by_problem.size());
}

bool TriedDifferentProblems(const ComparedSessions& compared) {
  return std::any_of(compared.pooled().begin(), compared.pooled().end(), [&](const auto& one) {
    const auto common = compared.pooled_common().find(one.first);
    return common == compared.pooled_common().end() ||
           common->second.by_problem.size() < one.second.by_problem.size();
  });
}

std::vector<FailureGroup> GroupFailures(const ComparedContestant& contestant,
                                        const std::string& problem_set) {
  std::map<std::pair<PlanStatus, std::string>, FailureGroup> groups;
  for (const StoredRun* run : contestant.runs) {
    if (run->confirmed() || run->problem_set != problem_set) continue;
    FailureGroup& group = groups[{run->status, WithoutFigures(run->message)}];
    group.status = run->status;
    if (group.num_runs++ == 0) group.reason = run->message;
    ++group.problems[run->problem_index];
  }
  std::vector<FailureGroup> sorted;
  for (auto& [key, group] : groups) sorted.push_back(std::move(group));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.num_runs > b.num_runs; });
  return sorted;
}

}  // namespace planbench
