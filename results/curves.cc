#include "results/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "results/comparison.h"

namespace planbench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

}  // namespace

std::vector<SolvedBy> SolvedOverTime(const Outcomes& outcomes) {
  std::vector<std::pair<double, double>> solved;  // when, and what it adds to the problems solved
  for (const auto& [problem, trials] : outcomes.by_problem) {
    for (const Outcome& trial : trials) {
      if (trial.confirmed()) solved.emplace_back(trial.time_s, 1.0 / trials.size());
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

}  // namespace planbench
