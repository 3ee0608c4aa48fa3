#pragma once

#include <vector>

namespace planbench {

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

}  // namespace planbench
