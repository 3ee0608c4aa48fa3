#pragma once

#include <optional>
#include <vector>

namespace planbench {

/// A confidence interval; every one here is of 95 %.
struct Interval {
  double lower = 0;
  double upper = 0;
};
inline constexpr double kConfidence = 0.95;

/// Summary of a sample.
struct Summary {
  int count = 0;
  double mean = 0;
  double median = 0;
  double lower_quartile = 0;
  double upper_quartile = 0;
  double percentile_95 = 0;
};

/// Quantile q in [0, 1] of ascending values, by linear interpolation between order statistics
/// (Hyndman and Fan's type 7, the default of NumPy and R); NaN if there are none.
double Quantile(const std::vector<double>& ascending, double q);

/// NaN in every field but count if the sample is empty.
Summary Summarize(std::vector<double> values);

/// Of a share that `successes` of `trials` were observed of: Wilson's score interval (1927), which
/// keeps its level for few trials and shares near 0 and 1 too. `successes` may be a sum of shares,
/// each in [0, 1], of independent cases: no variance of such a mean is greater. [0, 1] if nothing
/// was tried.
Interval WilsonInterval(double successes, int trials);

/// Of the median, whatever the distribution: the narrowest pair of order statistics, equally far
/// from both ends, that encloses it with at least the level. Nothing if even the extremes do not
/// (fewer than six values). Values may be infinite.
std::optional<Interval> MedianInterval(std::vector<double> values);

/// How far, in standard errors, Student's t interval of kConfidence reaches to either side: the
/// 97.5 % quantile of the distribution with `degrees` (of freedom, at least 1).
double StudentQuantile(int degrees);

/// Mean time of solved and failed runs, each failed one counted as ten times its limit (PAR-10 of
/// the algorithm-selection literature); NaN if there are none, or if a limit is not known (0).
double PenalisedMean(const std::vector<double>& solved_s, const std::vector<double>& limits_s);

}  // namespace planbench
