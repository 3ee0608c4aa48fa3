#include "benchmark_driver/session_results.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "results/training.h"

namespace planbench {
namespace {

Attempt AttemptOf(const RunRow& run) {
  Attempt attempt;
  attempt.problem_set = *run.problem_set;
  attempt.problem_index = run.problem_index;
  attempt.contestant = *run.contestant;
  attempt.trial = run.trial;
  attempt.direction = run.direction;
  attempt.status = run.status;
  attempt.claimed = run.claimed;
  attempt.time_s = run.time_s;
  attempt.time_limit_s = run.time_limit_s;
  return attempt;
}

/// Set, contestant, problem, trial and direction.
using AttemptKey = std::tuple<std::string, std::string, int, int, Direction>;

AttemptKey KeyOf(const RunRow& run, Direction direction) {
  return {*run.problem_set, *run.contestant, run.problem_index, run.trial, direction};
}

}  // namespace

std::string ContestantResults::label() const {
  return is_trained ? contestant->name + " " + kTrained : contestant->name;
}

std::string SessionResults::LabelOf(const Contestant& contestant) const {
  std::vector<std::string> trained_on;
  std::size_t num_tried = 0;
  for (const SetResults& set : sets_) {
    for (const ContestantResults& one : set.contestants) {
      if (one.contestant->name != contestant.name) continue;
      ++num_tried;
      if (one.is_trained) trained_on.push_back(set.name);
    }
  }
  const std::string mark = TrainedMark(trained_on, num_tried);
  return mark.empty() ? contestant.name : contestant.name + " " + mark;
}

SessionResults::SessionResults(const SessionConditions& conditions, const RunRows& runs,
                               const std::vector<Attempt>& references)
    : contestants_(conditions.contestants) {
  const auto add_contestant = [this](const std::string& planner, const std::string& name) {
    const auto has_name = [&](const Contestant& one) { return one.name == name; };
    if (std::any_of(contestants_.begin(), contestants_.end(), has_name)) return;
    Contestant& contestant = contestants_.emplace_back();
    contestant.planner = planner;
    contestant.name = name;
  };
  std::vector<const RunRow*> ordered;
  std::vector<Attempt> attempts;
  std::set<std::pair<std::string, int>> problems;
  std::set<AttemptKey> made;
  for (const RunRow& run : runs.rows()) {
    if (run.asked) made.insert(KeyOf(run, run.direction));
  }
  for (const RunRow& run : runs.rows()) {
    if (!run.asked) {
      ++num_not_asked_;
      why_not_asked_.Add(*run.message);
      continue;
    }
    if (run.needs_other && !made.contains(KeyOf(run, Opposite(run.direction)))) {
      ++num_awaiting_;
      continue;
    }
    ordered.push_back(&run);
    attempts.push_back(AttemptOf(run));
    problems.emplace(*run.problem_set, run.problem_index);
    add_contestant(*run.planner, *run.contestant);
  }
  std::set<std::string> reference_names;
  for (const Attempt& attempt : references) {
    if (!problems.contains({attempt.problem_set, attempt.problem_index})) continue;
    attempts.push_back(attempt);
    reference_names.insert(attempt.contestant);
    add_contestant("", attempt.contestant);
  }
  const auto key = [](const RunRow* run) {
    return std::tie(run->problem_index, run->trial, run->direction);
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
      std::copy_if(ordered.begin(), ordered.end(), std::back_inserter(one.runs),
                   [&](const RunRow* run) {
                     return *run->problem_set == set && *run->contestant == contestant.name;
                   });
      one.is_trained = std::any_of(one.runs.begin(), one.runs.end(),
                                   [](const RunRow* run) { return run->trained; });
    }
  }
}

}  // namespace planbench
