#include "benchmark_driver/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace planbench {

double Quantile(const std::vector<double>& ascending, double q) {
  if (ascending.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = q * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  const double share = position - static_cast<double>(below);
  // Between infinite values (clearances in an empty scene) there is nothing to interpolate.
  if (share == 0 || ascending[below] == ascending[above]) return ascending[below];
  return std::lerp(ascending[below], ascending[above], share);
}

Summary Summarize(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Summary summary;
  summary.count = static_cast<int>(values.size());
  summary.mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  summary.median = Quantile(values, 0.5);
  summary.lower_quartile = Quantile(values, 0.25);
  summary.upper_quartile = Quantile(values, 0.75);
  summary.percentile_95 = Quantile(values, 0.95);
  return summary;
}

}  // namespace planbench
