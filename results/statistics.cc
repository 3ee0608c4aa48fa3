#include "results/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace planbench {
namespace {

constexpr double kZ = 1.959963984540054;  // 97.5 % quantile of the standard normal distribution

/// Probability that Student's t lies between -t and t, t = sqrt(degrees) tan(angle): its closed
/// form for whole degrees (Abramowitz and Stegun, 26.7.3 and 26.7.4).
double StudentWithin(int degrees, double angle) {
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? cosine : 1, sum = 0;
  for (int k = odd ? 3 : 2; k <= degrees; k += 2) {
    sum += term;
    term *= cosine * cosine * (k - 1) / k;
  }
  return odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

}  // namespace

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

Interval WilsonInterval(double successes, int trials) {
  if (trials == 0) return {0, 1};
  const double n = trials;
  const double share = successes / n;
  const double center = share + kZ * kZ / (2 * n);
  const double half = kZ * std::sqrt(share * (1 - share) / n + kZ * kZ / (4 * n * n));
  const double scale = 1 + kZ * kZ / n;
  // Exactly, where rounding would leave a trace.
  return {successes == 0 ? 0 : (center - half) / scale,
          successes == trials ? 1 : (center + half) / scale};
}

std::optional<Interval> MedianInterval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const int n = static_cast<int>(values.size());
  // How many values lie below the median is binomial: `below` = P(fewer than k do). Between the
  // k-th value and the k-th from above it lies with probability 1 - 2 `below`.
  double below = 0;
  int k = 0;
  while (k < n / 2) {
    const double log_choose =
        std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
    const double more = below + std::exp(log_choose - n * std::numbers::ln2);
    if (2 * more > 1 - kConfidence) break;
    below = more;
    ++k;
  }
  if (k == 0) return std::nullopt;
  const auto index = static_cast<std::size_t>(k - 1);
  return Interval{values[index], values[values.size() - 1 - index]};
}

double StudentQuantile(int degrees) {
  double below = 0, above = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double angle = (below + above) / 2;
    (StudentWithin(degrees, angle) < kConfidence ? below : above) = angle;
  }
  return std::sqrt(degrees) * std::tan(below);
}

double PenalisedMean(const std::vector<double>& solved_s, const std::vector<double>& limits_s) {
  constexpr double kFactor = 10;
  double sum_s = std::accumulate(solved_s.begin(), solved_s.end(), 0.0);
  for (const double limit_s : limits_s) {
    sum_s += limit_s > 0 ? kFactor * limit_s : std::numeric_limits<double>::quiet_NaN();
  }
  return sum_s / static_cast<double>(solved_s.size() + limits_s.size());
}

}  // namespace planbench
