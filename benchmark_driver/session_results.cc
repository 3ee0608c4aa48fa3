#include "benchmark_driver/session_results.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

namespace planbench {
namespace {

Attempt AttemptOf(const RunRecordMessage& record) {
  const PlanResult& result = record.result.result;
  Attempt attempt;
  attempt.problem_set = record.problem_set;
  attempt.problem_index = record.problem_index;
  attempt.contestant = record.contestant;
  attempt.trial = record.trial;
  attempt.direction = record.request.direction;
  attempt.status = record.status;
  attempt.claimed = result.Solves();
  attempt.time_s =
      record.status == PlanStatus::kNoAnswer ? record.roundtrip_time_s : result.planning_time_s;
  attempt.time_limit_s = record.request.time_limit_s;
  return attempt;
}

}  // namespace

SessionResults::SessionResults(const SessionConditions& conditions,
                               const std::vector<RunRecordMessage>& records,
                               const std::vector<Attempt>& references)
    : contestants_(conditions.contestants) {
  const auto add_contestant = [this](const std::string& planner, const std::string& name) {
    const auto has_name = [&](const Contestant& one) { return one.name == name; };
    if (std::any_of(contestants_.begin(), contestants_.end(), has_name)) return;
    Contestant& contestant = contestants_.emplace_back();
    contestant.planner = planner;
    contestant.name = name;
  };
  std::vector<const RunRecordMessage*> ordered;
  std::vector<Attempt> attempts;
  std::set<std::pair<std::string, int>> problems;
  for (const RunRecordMessage& record : records) {
    ordered.push_back(&record);
    attempts.push_back(AttemptOf(record));
    problems.emplace(record.problem_set, record.problem_index);
    add_contestant(record.planner, record.contestant);
  }
  std::set<std::string> reference_names;
  for (const Attempt& attempt : references) {
    if (!problems.contains({attempt.problem_set, attempt.problem_index})) continue;
    attempts.push_back(attempt);
    reference_names.insert(attempt.contestant);
    add_contestant("", attempt.contestant);
  }
  const auto key = [](const RunRecordMessage* record) {
    return std::tie(record->problem_index, record->trial, record->request.direction);
  };
  std::sort(ordered.begin(), ordered.end(),
            [&](const auto* a, const auto* b) { return key(a) < key(b); });
  for (auto& [name, by_contestant] : GroupOutcomes(attempts)) {
    const std::string& set = name;  // clang 14 captures no bindings
    SetResults& results = sets_.emplace_back();
    results.name = set;
    for (const Contestant& contestant : contestants_) {
      const auto found = by_contestant.find(contestant.name);
      if (found == by_contestant.end()) continue;
      ContestantResults& one = results.contestants.emplace_back();
      one.contestant = &contestant;
      one.is_reference = reference_names.contains(contestant.name);
      one.outcomes = std::move(found->second);
      std::copy_if(ordered.begin(), ordered.end(), std::back_inserter(one.records),
                   [&](const RunRecordMessage* record) {
                     return record->problem_set == set && record->contestant == contestant.name;
                   });
    }
  }
}

}  // namespace planbench
