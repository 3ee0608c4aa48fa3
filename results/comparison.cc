#include "results/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace planbench {
namespace {

std::vector<double> SortedTimes(const std::vector<Outcome>& trials, double Outcome::*time,
                                bool only_confirmed) {
  std::vector<double> times;
  for (const Outcome& trial : trials) {
    if (!only_confirmed || trial.confirmed()) times.push_back(trial.*time);
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// Of each problem that was solved, the median time of the trials that solved it.
std::vector<double> SolvedTimes(const Outcomes& outcomes, double Outcome::*time) {
  std::vector<double> times;
  for (const auto& [problem, trials] : outcomes.by_problem) {
    const std::vector<double> solved = SortedTimes(trials, time, true);
    if (!solved.empty()) times.push_back(Quantile(solved, 0.5));
  }
  return times;
}

double MedianTime(const std::vector<Outcome>& trials) {
  return Quantile(SortedTimes(trials, &Outcome::time_s, false), 0.5);
}

/// log(a / b) for positive a and b, either or both infinite.
double LogRatio(double a, double b) { return a == b ? 0 : std::log(a) - std::log(b); }

}  // namespace

double ProblemTime(const std::vector<Outcome>& trials) {
  return std::max(MedianTime(trials), 1e-9);
}

bool TookNoTime(const std::vector<Outcome>& trials) { return MedianTime(trials) == 0; }

SuccessSummary SummarizeSuccess(const Outcomes& outcomes) {
  SuccessSummary summary;
  summary.num_problems = static_cast<int>(outcomes.by_problem.size());
  summary.num_runs = outcomes.num_runs();
  double sum_of_shares = 0, sum_claimed = 0;
  for (const auto& [problem, trials] : outcomes.by_problem) {
    int claimed = 0, confirmed = 0;
    for (const Outcome& trial : trials) {
      claimed += trial.claimed;
      ++summary.kinds[trial.kind];
      confirmed += trial.confirmed();
    }
    summary.claimed += claimed;
    summary.confirmed += confirmed;
    sum_claimed += static_cast<double>(claimed) / static_cast<double>(trials.size());
    sum_of_shares += static_cast<double>(confirmed) / static_cast<double>(trials.size());
  }
  summary.claimed_share = sum_claimed / summary.num_problems;
  summary.share = sum_of_shares / summary.num_problems;
  summary.interval = WilsonInterval(sum_of_shares, summary.num_problems);
  return summary;
}

TimeSummary SummarizeTimes(const Outcomes& outcomes) {
  TimeSummary summary;
  const std::vector<double> times = SolvedTimes(outcomes, &Outcome::time_s);
  summary.median_interval_s = MedianInterval(times);
  summary.solved_s = Summarize(times);
  summary.solving_s = Summarize(SolvedTimes(outcomes, &Outcome::solving_time_s));
  std::vector<double> solved_s, limits_s;
  for (const auto& [problem, trials] : outcomes.by_problem) {
    for (const Outcome& trial : trials) {
      (trial.confirmed() ? solved_s : limits_s)
          .push_back(trial.confirmed() ? trial.time_s : trial.time_limit_s);
    }
  }
  summary.penalised_mean_s = PenalisedMean(solved_s, limits_s);
  return summary;
}

std::optional<double> TrialSpread(const Outcomes& outcomes) {
  std::vector<double> spreads;
  for (const auto& [problem, trials] : outcomes.by_problem) {
    const std::vector<double> times = SortedTimes(trials, &Outcome::time_s, true);
    if (trials.size() < 2 || times.size() < trials.size() || times.front() <= 0) continue;
    spreads.push_back(times.back() / times.front());
  }
  if (spreads.empty()) return std::nullopt;
  return Summarize(std::move(spreads)).median;
}

PairedComparison Compare(const Outcomes& first, const Outcomes& second) {
  PairedComparison comparison;
  std::vector<double> times_first, times_second, differences;
  std::vector<double> divided_first, divided_second;
  for (const auto& [problem, trials] : first.by_problem) {
    const auto other = second.by_problem.find(problem);
    if (other == second.by_problem.end()) continue;
    times_first.push_back(ProblemTime(trials));
    times_second.push_back(ProblemTime(other->second));
    differences.push_back(LogRatio(times_first.back(), times_second.back()));
    if (!std::isfinite(times_first.back()) || !std::isfinite(times_second.back())) continue;
    if (TookNoTime(trials) || TookNoTime(other->second)) {
      ++comparison.num_zero;
      continue;
    }
    divided_first.push_back(times_first.back());
    divided_second.push_back(times_second.back());
  }
  comparison.num_problems = static_cast<int>(times_first.size());
  comparison.wins = CountWins(times_first, times_second);
  comparison.ratio = EstimateRatio(divided_first, divided_second);
  comparison.test = TestSignedRanks(differences);
  return comparison;
}

std::vector<double> AdjustedPValues(const std::vector<PairedComparison>& family) {
  std::vector<double> p_values;
  for (const PairedComparison& one : family) p_values.push_back(one.test.p_value);
  return AdjustPValues(p_values);
}

std::string ZeroTimesNote(const std::vector<PairedComparison>& rows) {
  int num_zero = 0, num_rows = 0;
  for (const PairedComparison& row : rows) {
    num_zero += row.num_zero;
    num_rows += row.num_zero > 0;
  }
  if (num_zero == 0) return "";
  return fmt::format(
      " Left out of the ratios of {} row{}, since a time is 0: {} problem{} that both solved "
      "in the median.",
      num_rows, num_rows == 1 ? "" : "s", num_zero, num_zero == 1 ? "" : "s");
}

bool IsNearOne(const PairedComparison& pair) {
  constexpr double kNear = 1.05;
  return pair.ratio && pair.ratio->interval && pair.ratio->mean <= kNear &&
         1 / pair.ratio->mean <= kNear;
}

std::string NearRatiosNote(const std::vector<PairedComparison>& rows) {
  if (std::none_of(rows.begin(), rows.end(), IsNearOne)) return "";
  return " Ratios within 5 % of 1, and their p, may be of these processes rather than of the "
         "planners: several sessions tell.";
}

}  // namespace planbench
