#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/outcomes.h"
#include "results/paired.h"
#include "results/signed_rank.h"
#include "results/statistics.h"

namespace planbench {

/// How often a contestant solved the problems of a set.
struct SuccessSummary {
  int num_problems = 0;
  int num_runs = 0;   ///< Problems times trials.
  int claimed = 0;    ///< Runs in which the planner says that it found a path.
  int confirmed = 0;  ///< Runs whose path the referee confirmed.
  std::map<Outcome::Kind, int> kinds;
  double share = 0;          ///< Confirmed, mean over the problems of the share of their trials.
  double claimed_share = 0;  ///< Claimed, likewise.
  /// Wilson's, for as many cases as there are problems: trials of one problem are not independent.
  Interval interval;
};
SuccessSummary SummarizeSuccess(const Outcomes& outcomes);

/// How long a contestant took on a set. A problem is solved if a trial of it is, and counts once,
/// by the median of the trials that solved it; others are left out but for the penalised mean.
struct TimeSummary {
  Summary solved_s;  ///< Over problems.
  std::optional<Interval> median_interval_s;
  Summary solving_s;  ///< The same of the attempt that found the path alone.
  /// Over runs; one without a confirmed path is ten of Outcome's time limits. NaN if one of these
  /// is not known.
  double penalised_mean_s = 0;
};
TimeSummary SummarizeTimes(const Outcomes& outcomes);

/// How far the trials of one problem lie apart: the longest time over the shortest, its median over
/// the problems whose trials, two at least, are all confirmed. Nothing if there is no such problem.
std::optional<double> TrialSpread(const Outcomes& outcomes);

/// A problem's time: the median over its trials, those without a confirmed path being longer than
/// any; positive, or infinite. 1 ns is what stands for a time of 0, as of a clock that read the
/// same twice: shorter than any other, and no time to divide by. It is finite if more than half of
/// the trials are confirmed: then the problem is solved in the median.
double ProblemTime(const std::vector<Outcome>& trials);
/// Whether it stands for a time of 0: such problems have no ratio.
bool TookNoTime(const std::vector<Outcome>& trials);

/// Two contestants on the problems of a set that both tried, by each problem's time: what is solved
/// here is so in the median.
struct PairedComparison {
  int num_problems = 0;
  Wins wins;                           ///< Of the first.
  std::optional<RatioEstimate> ratio;  ///< First / second, of problems that both so solved.
  int num_zero = 0;     ///< Others that both solved, left out of the ratio: a time is 0.
  SignedRankTest test;  ///< Of the logarithms' differences.

  int num_in_ratio() const { return ratio ? ratio->num_pairs : 0; }  ///< Problems.
};
PairedComparison Compare(const Outcomes& first, const Outcomes& second);

/// The comparisons' p-values adjusted for all of them (AdjustPValues), in their order.
std::vector<double> AdjustedPValues(const std::vector<PairedComparison>& family);

/// What stands below every table of such comparisons: what they go by.
inline constexpr char kProblemTimeNote[] =
    "A problem is solved here, in the median, if more than half of its trials have a confirmed "
    "path; its time is the median of all trials, those without being longer than any. ";

/// What stands below a table of ratios of which some problems are left out since a time is 0, a
/// blank before it; "" if none are.
std::string ZeroTimesNote(const std::vector<PairedComparison>& rows);

/// Whether a ratio with an interval is so near 1 (5 %) that one process of a planner may be as far
/// from the next of the same planner.
bool IsNearOne(const PairedComparison& pair);
/// What stands below a table with such ratios, a blank before it; "" if there are none.
std::string NearRatiosNote(const std::vector<PairedComparison>& rows);

}  // namespace planbench
