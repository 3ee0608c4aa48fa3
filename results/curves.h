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
/// One step for each time at which the share rises, ascending; none if nothing was solved. Failed
/// runs are never solved, whenever they ended: the last share is that of SummarizeSuccess.
std::vector<SolvedBy> SolvedOverTime(const Outcomes& outcomes);

/// A step of a performance profile.
struct ProfileStep {
  double ratio = 1;  ///< Time of the contestant over the best one's on the same problem.
  double share = 0;  ///< Of the problems on which the contestant is within the ratio.
};
/// Performance profiles (Dolan and Moré 2002) by contestant, over the problems that all of them
/// tried; one that nobody solved counts against all. One step for each ratio at which the share
/// rises, ascending.
std::map<std::string, std::vector<ProfileStep>> PerformanceProfiles(
    const std::map<std::string, Outcomes>& contestants);

/// Quartiles over the runs of what they have in hand at a time. Nothing where so many of the runs
/// have no solution yet that the quartile is infinite.
struct AnytimeStep {
  double time_s = 0;
  std::optional<double> lower, median, upper;
};
/// How the solutions of an anytime planner improve.
struct AnytimeCurves {
  /// Cost over the lowest that any of the runs found on the same problem: costs of different
  /// problems do not compare.
  std::vector<AnytimeStep> cost;
  std::vector<AnytimeStep> bound;  ///< Proven, of the cost over the optimum.
};
/// Of runs of one contestant, at kAnytimeSteps times between the first solution and the last
/// improvement, each so many times the one before. Both empty unless a run improved its solution;
/// the bound's empty unless there are any.
inline constexpr int kAnytimeSteps = 60;
AnytimeCurves ImprovementOverTime(const std::vector<const StoredRun*>& runs);

}  // namespace planbench
