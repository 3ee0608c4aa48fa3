#include "results/curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/numbers.h"
#include "results/comparison.h"

namespace planbench {
namespace {

/// Problems that all contestants tried, each with its shortest time.
std::map<int, double> BestTimes(const std::map<std::string, Outcomes>& contestants) {
  std::map<int, double> best;
  if (contestants.empty()) return best;
  for (const auto& [problem, trials] : contestants.begin()->second.by_problem) {
    double shortest = kInfinity;
    bool common = true;
    for (const auto& [name, outcomes] : contestants) {
      const auto found = outcomes.by_problem.find(problem);
      if (found == outcomes.by_problem.end()) {
        common = false;
      } else {
        shortest = std::min(shortest, ProblemTime(found->second));
      }
    }
    if (common) best[problem] = shortest;
  }
  return best;
}

/// The value of `improvement` that a run has at a time; infinite before there is one.
double InHand(const std::vector<PlanProgress>& progress, double time_s,
              double PlanProgress::*value) {
  double found = kInfinity;
  for (const PlanProgress& one : progress) {
    if (one.elapsed_s > time_s) break;
    if (one.*value > 0) found = one.*value;
  }
  return found;
}

AnytimeStep StepOf(double time_s, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto quartile = [&](double q) -> std::optional<double> {
    // Interpolation next to an infinite value would not be a number.
    const auto above =
        static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size() - 1)));
    if (!std::isfinite(values[above])) return std::nullopt;
    return Quantile(values, q);
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
  double sum = 0;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    // Sums of thirds must not end above the number of problems.
    sum = std::min(sum + solved[i].second, static_cast<double>(num_problems));
    if (i + 1 < solved.size() && solved[i + 1].first == solved[i].first) continue;
    steps.push_back({solved[i].first, sum / num_problems, WilsonInterval(sum, num_problems)});
  }
  return steps;
}

std::map<std::string, std::vector<ProfileStep>> PerformanceProfiles(
    const std::map<std::string, Outcomes>& contestants) {
  const std::map<int, double> best = BestTimes(contestants);
  std::map<std::string, std::vector<ProfileStep>> profiles;
  for (const auto& [name, outcomes] : contestants) {
    std::vector<double> ratios;
    for (const auto& [problem, shortest] : best) {
      const double time = ProblemTime(outcomes.by_problem.at(problem));
      if (std::isfinite(time)) ratios.push_back(time / shortest);
    }
    std::sort(ratios.begin(), ratios.end());
    std::vector<ProfileStep>& steps = profiles[name];
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      if (i + 1 < ratios.size() && ratios[i + 1] == ratios[i]) continue;
      steps.push_back({ratios[i], static_cast<double>(i + 1) / static_cast<double>(best.size())});
    }
  }
  return profiles;
}

AnytimeCurves ImprovementOverTime(const std::vector<const StoredRun*>& runs) {
  double first_s = kInfinity, last_s = 0;
  bool improved = false, bounded = false;
  std::map<int, double> best;  // cost by problem
  for (const StoredRun* run : runs) {
    improved = improved || run->progress.size() > 1;
    for (const PlanProgress& one : run->progress) {
      if (one.elapsed_s > 0) first_s = std::min(first_s, one.elapsed_s);
      last_s = std::max(last_s, one.elapsed_s);
      bounded = bounded || one.epsilon > 0;
      if (!(one.cost > 0)) continue;
      double& lowest = best.try_emplace(run->problem_index, one.cost).first->second;
      lowest = std::min(lowest, one.cost);
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
    std::vector<double> costs, bounds;
    for (const StoredRun* run : runs) {
      const double cost = InHand(run->progress, time_s, &PlanProgress::cost);
      const auto lowest = best.find(run->problem_index);
      costs.push_back(lowest == best.end() ? kInfinity : cost / lowest->second);
      bounds.push_back(InHand(run->progress, time_s, &PlanProgress::epsilon));
    }
    curves.cost.push_back(StepOf(time_s, std::move(costs)));
    if (bounded) curves.bound.push_back(StepOf(time_s, std::move(bounds)));
  }
  return curves;
}

}  // namespace planbench
