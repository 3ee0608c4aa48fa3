#pragma once

#include <map>
#include <string>
#include <vector>

#include "results/outcomes.h"
#include "results/statistics.h"

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

}  // namespace planbench
