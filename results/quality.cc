#include "results/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace planbench {
namespace {

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return Quantile(values, 0.5);
}

}  // namespace

Summary SummarizeByProblem(const ValuesByProblem& values) {
  std::vector<double> medians;
  for (const auto& [problem, of_runs] : values) medians.push_back(Median(of_runs));
  return Summarize(std::move(medians));
}

std::optional<RatioEstimate> CompareByProblem(const ValuesByProblem& first,
                                              const ValuesByProblem& second) {
  std::vector<double> of_first, of_second;
  for (const auto& [problem, values] : first) {
    const auto other = second.find(problem);
    if (other == second.end()) continue;
    const double a = Median(values), b = Median(other->second);
    if (!(a > 0 && b > 0)) continue;
    of_first.push_back(a);
    of_second.push_back(b);
  }
  return EstimateRatio(of_first, of_second);
}

std::vector<const StoredRun*> ConfirmedRuns(const ComparedContestant& contestant,
                                            const std::string& problem_set) {
  std::vector<const StoredRun*> attempts;
  for (const StoredRun* run : contestant.runs) {
    if (run->problem_set == problem_set) attempts.push_back(run);
  }
  return ConfirmedRuns(attempts);
}

ValuesByProblem MeasuredByProblem(const ComparedContestant& contestant,
                                  const std::string& problem_set, const std::string& measure,
                                  bool raw) {
  ValuesByProblem values;
  for (const StoredRun* run : ConfirmedRuns(contestant, problem_set)) {
    if (OwesToOverrun(run->odd_times_s)) continue;
    const auto value = FindMeasure(raw ? run->measures : run->measures_simple, measure);
    if (value) values[run->problem_index].push_back(*value);
  }
  return values;
}

std::string RejectedSimplifiedNote(const std::string& contestant,
                                   const std::vector<std::optional<bool>>& verdicts) {
  const auto rejected = std::count(verdicts.begin(), verdicts.end(), std::optional(false));
  if (rejected == 0) return "";
  const auto none = std::count(verdicts.begin(), verdicts.end(), std::nullopt);
  return fmt::format(
      "{}: the referee rejected {} of {} simplified paths of confirmed runs: no "
      "measure of path quality counts them.",
      contestant, rejected, std::ssize(verdicts) - none);
}

std::optional<double> CheckingSpread(const ComparedContestant& contestant) {
  std::map<std::tuple<std::string, int, Direction>, std::vector<double>> costs_s;
  for (const StoredRun* run : contestant.runs) {
    const double cost_s = run->phases.collision_s / run->configurations_checked;
    if (!run->confirmed() || !(cost_s > 0) || !std::isfinite(cost_s)) continue;
    costs_s[{run->problem_set, run->problem_index, run->direction}].push_back(cost_s);
  }
  std::vector<double> spreads;
  for (const auto& [problem, costs] : costs_s) {
    const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
    if (costs.size() > 1) spreads.push_back(*most / *least);
  }
  if (spreads.empty()) return std::nullopt;
  return Median(std::move(spreads));
}

PhaseTimes MeanPhases(const std::vector<const StoredRun*>& runs) {
  PhaseTimes mean;
  const auto add = [&](double PhaseTimes::*phase, const auto& counts) {
    std::size_t number = 0;
    for (const StoredRun* run : runs) {
      if (!counts(run->phases)) continue;
      mean.*phase += run->phases.*phase;
      ++number;
    }
    if (number > 0) mean.*phase /= static_cast<double>(number);
  };
  for (const auto phase : {&PhaseTimes::setup_s, &PhaseTimes::collision_s, &PhaseTimes::guidance_s,
                           &PhaseTimes::search_s}) {
    add(phase, [](const PhaseTimes& phases) { return phases.AreTold(); });
  }
  add(&PhaseTimes::simplification_s,
      [](const PhaseTimes& phases) { return phases.Simplification().has_value(); });
  return mean;
}

}  // namespace planbench
