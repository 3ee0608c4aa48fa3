#include "results/paired.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include "common/random.h"

namespace planbench {
namespace {

void RequirePairs(const std::vector<double>& first, const std::vector<double>& second) {
  if (first.size() != second.size()) {
    throw std::invalid_argument("paired values: not as many of both");
  }
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double Wins::Share() const {
  const int problems = won + lost + tied;
  if (problems == 0) return std::numeric_limits<double>::quiet_NaN();
  return (won + 0.5 * tied) / problems;
}

Wins CountWins(const std::vector<double>& first, const std::vector<double>& second) {
  RequirePairs(first, second);
  Wins wins;
  for (std::size_t i = 0; i < first.size(); ++i) {
    ++(first[i] < second[i] ? wins.won : first[i] > second[i] ? wins.lost : wins.tied);
  }
  return wins;
}

std::optional<RatioEstimate> EstimateRatio(const std::vector<double>& first,
                                           const std::vector<double>& second, std::uint64_t seed,
                                           int num_resamples) {
  RequirePairs(first, second);
  std::vector<double> logs;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!(first[i] > 0) || !(second[i] > 0)) {
      throw std::invalid_argument("ratio of paired values: one is not positive");
    }
    if (std::isfinite(first[i]) && std::isfinite(second[i])) {
      logs.push_back(std::log(first[i] / second[i]));
    }
  }
  if (logs.empty()) return std::nullopt;

  std::mt19937_64 random(seed);
  const auto n = static_cast<double>(logs.size());
  std::vector<double> means(static_cast<std::size_t>(num_resamples));
  for (double& mean : means) {
    double sum = 0;
    for (std::size_t i = 0; i < logs.size(); ++i) {
      sum += logs[static_cast<std::size_t>(n * UniformFraction(&random))];
    }
    mean = sum / n;
  }
  std::sort(means.begin(), means.end());
  constexpr double kTail = (1 - kConfidence) / 2;
  return RatioEstimate{std::exp(Mean(logs)),
                       {std::exp(Quantile(means, kTail)), std::exp(Quantile(means, 1 - kTail))}};
}

}  // namespace planbench
