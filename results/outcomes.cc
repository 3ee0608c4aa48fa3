#include "results/outcomes.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "common/numbers.h"

namespace planbench {
namespace {

bool Solved(const Attempt* attempt) {
  return attempt != nullptr && attempt->status == PlanStatus::kSolved;
}

Outcome::Kind KindOfUnsolved(const Attempt* forward, const Attempt* backward) {
  using enum PlanStatus;
  const auto either_is = [&](std::initializer_list<PlanStatus> statuses) {
    const auto is = [&](const Attempt* attempt) {
      return attempt != nullptr &&
             std::find(statuses.begin(), statuses.end(), attempt->status) != statuses.end();
    };
    return is(forward) || is(backward);
  };
  if (either_is({kInvalidPath})) return Outcome::Kind::kRejected;
  if (either_is({kStartInvalid, kGoalInvalid})) return Outcome::Kind::kUnsolvable;
  if (either_is({kNoAnswer})) return Outcome::Kind::kNoAnswer;
  if (either_is({kInvalidRequest, kCancelled})) return Outcome::Kind::kRefused;
  return Outcome::Kind::kFailure;
}

}  // namespace

std::vector<std::string> DescribeOddTimes(const std::string& contestant,
                                          const std::vector<OddTimesFound>& runs) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kNumOddTimes; ++i) {
    int num_odd = 0;
    double largest_s = 0;
    for (const OddTimesFound& run : runs) {
      num_odd += run[i] > 0;
      largest_s = std::max(largest_s, run[i]);
    }
    if (num_odd == 0) continue;
    lines.push_back(fmt::format("{}: {} of {} runs {}.", contestant, num_odd, runs.size(),
                                fmt::format(fmt::runtime(kOddTimes[i].text), largest_s)));
  }
  return lines;
}

Outcome FoldAttempts(const Attempt* forward, const Attempt* backward) {
  Outcome outcome;
  outcome.claimed =
      (forward != nullptr && forward->claimed) || (backward != nullptr && backward->claimed);
  if (Solved(forward)) {
    outcome.kind = Outcome::Kind::kForward;
    outcome.time_s = outcome.solving_time_s = forward->time_s;
  } else if (Solved(backward)) {
    outcome.kind = Outcome::Kind::kBackward;
    outcome.solving_time_s = backward->time_s;
    outcome.time_s = backward->time_s + (forward != nullptr ? forward->time_s : 0);
  } else {
    outcome.kind = KindOfUnsolved(forward, backward);
    outcome.time_s = outcome.solving_time_s = kInfinity;
  }
  return outcome;
}

int Outcomes::num_runs() const {
  std::size_t count = 0;
  for (const auto& [problem, trials] : by_problem) count += trials.size();
  return static_cast<int>(count);
}

std::map<std::string, Outcomes> OnCommonProblems(std::map<std::string, Outcomes> contestants) {
  std::map<int, std::size_t> num_tried;
  for (const auto& [name, outcomes] : contestants) {
    for (const auto& [problem, trials] : outcomes.by_problem) ++num_tried[problem];
  }
  const std::size_t num_contestants = contestants.size();
  for (auto& [name, outcomes] : contestants) {
    std::erase_if(outcomes.by_problem, [&](const auto& problem) {
      return num_tried.at(problem.first) < num_contestants;
    });
  }
  return contestants;
}

OutcomesBySet GroupOutcomes(const std::vector<Attempt>& attempts) {
  struct Pair {
    const Attempt* forward = nullptr;
    const Attempt* backward = nullptr;
  };
  std::map<std::tuple<std::string, std::string, int, int>, Pair> pairs;
  std::map<std::pair<std::string, int>, double> limits;
  for (const Attempt& attempt : attempts) {
    double& limit = limits[{attempt.problem_set, attempt.problem_index}];
    limit = std::max(limit, attempt.time_limit_s);
    Pair& pair =
        pairs[{attempt.problem_set, attempt.contestant, attempt.problem_index, attempt.trial}];
    (attempt.direction == Direction::kForward ? pair.forward : pair.backward) = &attempt;
  }
  OutcomesBySet sets;
  for (const auto& [key, pair] : pairs) {
    const auto& [set, contestant, problem, trial] = key;
    Outcomes& outcomes = sets[set][contestant];
    Outcome& outcome =
        outcomes.by_problem[problem].emplace_back(FoldAttempts(pair.forward, pair.backward));
    outcome.trial = trial;
    outcome.time_limit_s = limits.at({set, problem});
    for (const Attempt* attempt : {pair.forward, pair.backward}) {
      if (attempt == nullptr) continue;
      outcomes.time_limit_s = std::max(outcomes.time_limit_s, attempt->time_limit_s);
    }
  }
  return sets;
}

std::map<std::string, Outcomes> PoolSets(const OutcomesBySet& sets) {
  std::map<std::string, Outcomes> pooled;
  int next = 0;
  for (const auto& [set, contestants] : sets) {
    std::map<int, int> numbers;  // by index
    for (const auto& [contestant, outcomes] : contestants) {
      for (const auto& [index, trials] : outcomes.by_problem) numbers[index] = 0;
    }
    for (auto& [index, number] : numbers) number = next++;
    for (const auto& [contestant, outcomes] : contestants) {
      Outcomes& all = pooled[contestant];
      all.time_limit_s = std::max(all.time_limit_s, outcomes.time_limit_s);
      for (const auto& [index, trials] : outcomes.by_problem) {
        all.by_problem[numbers.at(index)] = trials;
      }
    }
  }
  return pooled;
}

}  // namespace planbench
