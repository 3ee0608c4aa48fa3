#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/statistics.h"

namespace planbench {

/// How one contestant's times compare with another's on the same problems, problem by problem;
/// infinite: not solved. Throws std::invalid_argument if there are not as many of both.
struct Wins {
  int won = 0;  ///< The first was faster, or alone in solving it.
  int lost = 0;
  int tied = 0;  ///< Equal, or solved by neither.

  /// Share of the problems won, a tie half; NaN if there are none.
  double Share() const;
};
Wins CountWins(const std::vector<double>& first, const std::vector<double>& second);

/// Geometric mean of the ratios first / second with its interval.
struct RatioEstimate {
  double mean = 1;
  std::optional<Interval> interval;  ///< Nothing of fewer than six pairs.
  int num_pairs = 0;
};
/// The mean of the logarithms with Student's t interval, of the pairs in which both are finite;
/// nothing if there are none. Of fewer than six pairs, which no test could tell apart either
/// (FewestDifferences), it would keep its level only if the logarithms were normally distributed.
/// Throws std::invalid_argument for values that are not positive or numbers that differ.
std::optional<RatioEstimate> EstimateRatio(const std::vector<double>& first,
                                           const std::vector<double>& second);

/// What a reader sees of a ratio: `rounded`, unless that reads 1, which is neither faster nor
/// slower, and the ratio is another; then its first decimals that differ from 1 (nine at most).
std::string RatioText(double ratio, const std::string& rounded);

}  // namespace planbench
