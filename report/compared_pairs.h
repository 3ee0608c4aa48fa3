#pragma once

#include <string>
#include <vector>

#include "results/compared_sessions.h"
#include "results/comparison.h"

namespace planbench {

/// One contestant against another on one set, or on all.
struct ComparedPair {
  std::string set;
  std::string first;
  std::string second;
  PairedComparison result;
  double adjusted_p = 1;  ///< Holm's, over the pairs of the set.
};
/// All pairs that tried a problem in common, those that rank higher first.
std::vector<ComparedPair> ComparePairs(const ComparedSessions& compared);

}  // namespace planbench
