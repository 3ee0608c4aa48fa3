#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/outcomes.h"
#include "results/statistics.h"
#include "results/stored_session.h"

namespace planbench {

/// A step of the share of problems that are solved by a time.
struct SolvedBy {
  double time_s = 0;
  double share = 0;   ///< Mean over the problems of the share of their trials solved by then.
  Interval interval;  ///< Wilson's for as many cases as there are problems, of each time by itself.
};
/// From share 0 at time 0 on, one step for each time at which the share rises, ascending; none
/// without problems. Failed runs are never solved, whenever they ended: the last share is that of
/// SummarizeSuccess.
std::vector<SolvedBy> SolvedOverTime(const Outcomes& outcomes);

/// A step of a performance profile.
struct ProfileStep {
  double ratio = 1;  ///< Time of the contestant over the best one's on the same problem.
  double share = 0;  ///< Of the problems on which the contestant is within the ratio.
};
/// Performance profiles (Dolan and Moré 2002), over the problems that all contestants tried; one
/// that nobody solved counts against all, one of which a time is 0 is left out.
struct PerformanceProfiles {
  int num_problems = 0;  ///< That they are over.
  /// One step for each ratio at which the share rises, ascending.
  std::map<std::string, std::vector<ProfileStep>> by_contestant;
};
PerformanceProfiles ProfileTimes(const std::map<std::string, Outcomes>& contestants);

/// Quartiles over the problems of what there is in hand at a time. A problem counts once, by the
/// median of its trials. Nothing where so many have no solution yet that the quartile is infinite.
struct AnytimeStep {
  double time_s = 0;
  std::optional<double> lower, median, upper;
};
/// How the solutions of an anytime planner improve.
struct AnytimeCurves {
  /// Cost over a lowest one of the same problem: costs of different problems do not compare.
  std::vector<AnytimeStep> cost;
  std::vector<AnytimeStep> bound;  ///< Proven, of the cost over the optimum.
};
/// Whether the costs that runs of one contestant tell of their improvements are lengths of paths as
/// the referee measures them, and so compare with those of others: the last one is, in most of the
/// confirmed runs that have both.
bool CostsAreLengths(const std::vector<const StoredRun*>& runs);

/// Lowest costs by problem index.
using LowestCosts = std::map<int, double>;
/// That confirmed runs on one set tell of their improvements by the time limit; 0 where the start
/// is in the goal.
LowestCosts FindLowestCosts(const std::vector<const StoredRun*>& runs);

/// Of runs of one contestant on one set, at kAnytimeSteps times between the first solution and the
/// last improvement by the time limit, each so many times the one before. The attempts at a problem
/// are folded as everywhere (FoldAttempts): without a confirmed path there is nothing in hand, and
/// failed attempts before it take their time. Costs are over those of `lowest`; 0 over 0 is 1. Both
/// empty unless a confirmed run improved its solution; the bound's empty unless there are any.
inline constexpr int kAnytimeSteps = 60;
AnytimeCurves ImprovementOverTime(const std::vector<const StoredRun*>& runs,
                                  const LowestCosts& lowest);

}  // namespace planbench
