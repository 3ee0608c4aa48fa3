#include "results/curves.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "common/numbers.h"
#include "planning/path_measures.h"
#include "results/compared_sessions.h"
#include "results/comparison.h"

namespace planbench {
namespace {

/// Problems that all contestants tried, each with its shortest time, unless one is 0.
std::map<int, double> BestTimes(const std::map<std::string, Outcomes>& contestants) {
  std::map<int, double> best;
  if (contestants.empty()) return best;
  for (const auto& [problem, trials] : contestants.begin()->second.by_problem) {
    double shortest = kInfinity;
    bool counts = true;
    for (const auto& [name, outcomes] : contestants) {
      const auto found = outcomes.by_problem.find(problem);
      if (found == outcomes.by_problem.end() || TookNoTime(found->second)) {
        counts = false;
      } else {
        shortest = std::min(shortest, ProblemTime(found->second));
      }
    }
    if (counts) best[problem] = shortest;
  }
  return best;
}

/// The improvements of a run by its time limit, if that is known. A path in hand when that came may
/// have been told of later: the first one is.
std::span<const PlanProgress> InTime(const StoredRun& run) {
  const std::span<const PlanProgress> all = run.progress;
  if (run.time_limit_s == 0) return all;
  const auto is_late = [&](const PlanProgress& one) {
    return &one != all.data() && IsLate(one.elapsed_s, run.time_limit_s);
  };
  return {all.begin(), std::ranges::find_if(all, is_late)};
}

/// A contestant's trial at a problem.
struct ImprovingTrial {
  const StoredRun* run = nullptr;  ///< That of the confirmed path; null without one.
  double delay_s = 0;              ///< What failed attempts before it took.

  /// The value of an improvement that there is at a time; infinite before there is one.
  double InHand(double time_s, double PlanProgress::*value) const {
    double found = kInfinity;
    if (run == nullptr) return found;
    for (const PlanProgress& one : InTime(*run)) {
      if (delay_s + one.elapsed_s > time_s) break;
      // A cost of 0, which has a bound, is one (TellsCost).
      if (one.*value > 0 || one.epsilon > 0) found = one.*value;
    }
    return found;
  }
};

/// Trials by problem index.
std::map<int, std::vector<ImprovingTrial>> FoldRuns(const std::vector<const StoredRun*>& runs) {
  std::map<std::pair<int, int>, std::pair<const StoredRun*, const StoredRun*>> attempts;
  for (const StoredRun* run : runs) {
    auto& [forward, backward] = attempts[{run->problem_index, run->trial}];
    (run->direction == Direction::kForward ? forward : backward) = run;
  }
  std::map<int, std::vector<ImprovingTrial>> by_problem;
  for (const auto& [problem_and_trial, directions] : attempts) {
    const auto& [forward, backward] = directions;
    Attempt first, second;
    if (forward != nullptr) first = AttemptOf(*forward, "");
    if (backward != nullptr) second = AttemptOf(*backward, "");
    const Outcome outcome = FoldAttempts(forward != nullptr ? &first : nullptr,
                                         backward != nullptr ? &second : nullptr);
    ImprovingTrial& trial = by_problem[problem_and_trial.first].emplace_back();
    if (!outcome.confirmed()) continue;
    trial.run = outcome.kind == Outcome::Kind::kForward ? forward : backward;
    trial.delay_s = outcome.time_s - outcome.solving_time_s;
  }
  return by_problem;
}

/// Of ascending values, some of which may be infinite.
double QuantileInHand(const std::vector<double>& ascending, double q) {
  // Interpolation next to an infinite value would not be a number.
  const auto above =
      static_cast<std::size_t>(std::ceil(q * static_cast<double>(ascending.size() - 1)));
  return std::isfinite(ascending[above]) ? Quantile(ascending, q) : kInfinity;
}

/// `value`: of an improvement; of each problem over that of `units`, if there are any.
AnytimeStep StepAt(double time_s, const std::map<int, std::vector<ImprovingTrial>>& by_problem,
                   double PlanProgress::*value, const LowestCosts* units) {
  std::vector<double> of_problems;
  for (const auto& [problem, trials] : by_problem) {
    std::vector<double> of_trials;
    for (const ImprovingTrial& trial : trials) of_trials.push_back(trial.InHand(time_s, value));
    std::sort(of_trials.begin(), of_trials.end());
    double in_hand = QuantileInHand(of_trials, 0.5);
    if (units != nullptr && std::isfinite(in_hand)) {
      const double unit = units->at(problem);
      in_hand = in_hand == unit ? 1 : in_hand / unit;
    }
    of_problems.push_back(in_hand);
  }
  std::sort(of_problems.begin(), of_problems.end());
  const auto quartile = [&](double q) -> std::optional<double> {
    const double found = QuantileInHand(of_problems, q);
    return std::isfinite(found) ? std::optional(found) : std::nullopt;
  };
  return {time_s, quartile(0.25), quartile(0.5), quartile(0.75)};
}

}  // namespace

std::vector<SolvedBy> SolvedOverTime(const Outcomes& outcomes) {
  std::vector<std::pair<double, double>> solved;  // when, and what it adds to the problems solved
  for (const auto& [problem, trials] : outcomes.by_problem) {
    for (const Outcome& trial : trials) {
      if (trial.confirmed())
        solved.emplace_back(trial.time_s, 1.0 / static_cast<double>(trials.size()));
    }
  }
  std::sort(solved.begin(), solved.end());
  const int num_problems = static_cast<int>(outcomes.by_problem.size());
  std::vector<SolvedBy> steps;
  if (num_problems > 0) steps.push_back({0, 0, WilsonInterval(0, num_problems)});
  double sum = 0;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    // Sums of thirds must not end above the number of problems.
    sum = std::min(sum + solved[i].second, static_cast<double>(num_problems));
    if (i + 1 < solved.size() && solved[i + 1].first == solved[i].first) continue;
    steps.push_back({solved[i].first, sum / num_problems, WilsonInterval(sum, num_problems)});
  }
  return steps;
}

PerformanceProfiles ProfileTimes(const std::map<std::string, Outcomes>& contestants) {
  const std::map<int, double> best = BestTimes(contestants);
  PerformanceProfiles profiles{.num_problems = static_cast<int>(best.size()), .by_contestant = {}};
  for (const auto& [name, outcomes] : contestants) {
    std::vector<double> ratios;
    for (const auto& [problem, shortest] : best) {
      const double time = ProblemTime(outcomes.by_problem.at(problem));
      if (std::isfinite(time)) ratios.push_back(time / shortest);
    }
    std::sort(ratios.begin(), ratios.end());
    std::vector<ProfileStep>& steps = profiles.by_contestant[name];
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      if (i + 1 < ratios.size() && ratios[i + 1] == ratios[i]) continue;
      steps.push_back({ratios[i], static_cast<double>(i + 1) / static_cast<double>(best.size())});
    }
  }
  return profiles;
}

bool CostsAreLengths(const std::vector<const StoredRun*>& runs) {
  constexpr double kRounding = 1e-6;
  int known = 0, equal = 0;
  for (const StoredRun* run : runs) {
    const auto length = FindMeasure(run->measures, "path_length");
    if (!run->confirmed() || run->progress.empty() || !length) continue;
    ++known;
    equal += std::abs(run->progress.back().cost - *length) <= kRounding * *length;
  }
  return 2 * equal > known;
}

LowestCosts FindLowestCosts(const std::vector<const StoredRun*>& runs) {
  LowestCosts lowest;
  for (const StoredRun* run : runs) {
    if (!run->confirmed()) continue;
    for (const PlanProgress& one : InTime(*run)) {
      if (!(one.cost > 0 || one.epsilon > 0)) continue;
      double& cost = lowest.try_emplace(run->problem_index, one.cost).first->second;
      cost = std::min(cost, one.cost);
    }
  }
  return lowest;
}

AnytimeCurves ImprovementOverTime(const std::vector<const StoredRun*>& runs,
                                  const LowestCosts& lowest) {
  const std::map<int, std::vector<ImprovingTrial>> by_problem = FoldRuns(runs);
  double first_s = kInfinity, last_s = 0;
  bool improved = false, bounded = false;
  for (const auto& [problem, trials] : by_problem) {
    for (const ImprovingTrial& trial : trials) {
      if (trial.run == nullptr) continue;
      const std::span<const PlanProgress> progress = InTime(*trial.run);
      improved = improved || progress.size() > 1;
      for (const PlanProgress& one : progress) {
        const double time_s = trial.delay_s + one.elapsed_s;
        if (time_s > 0) first_s = std::min(first_s, time_s);
        last_s = std::max(last_s, time_s);
        bounded = bounded || one.epsilon > 0;
      }
    }
  }
  AnytimeCurves curves;
  if (!improved || !(first_s < last_s)) return curves;
  for (int i = 0; i < kAnytimeSteps; ++i) {
    // The last one is exact, so that it is the last improvement's.
    const double time_s =
        i + 1 == kAnytimeSteps
            ? last_s
            : first_s * std::pow(last_s / first_s, static_cast<double>(i) / (kAnytimeSteps - 1));
    curves.cost.push_back(StepAt(time_s, by_problem, &PlanProgress::cost, &lowest));
    if (bounded) {
      curves.bound.push_back(StepAt(time_s, by_problem, &PlanProgress::epsilon, nullptr));
    }
  }
  return curves;
}

}  // namespace planbench
