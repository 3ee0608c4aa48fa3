#include "results/paired.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace planbench {
namespace {

void RequirePairs(const std::vector<double>& first, const std::vector<double>& second) {
  if (first.size() != second.size()) {
    throw std::invalid_argument("paired values: not as many of both");
  }
}

/// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014). Resampling takes billions of numbers of a large
/// comparison, most of the time of which a Mersenne Twister would take.
class RandomBits {
 public:
  explicit RandomBits(std::uint64_t seed) : state_(seed) {}
  std::uint64_t operator()() {
    std::uint64_t bits = state_ += 0x9e3779b97f4a7c15U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31U);
  }

 private:
  std::uint64_t state_;
};

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
  RatioEstimate estimate{std::exp(Mean(logs)), {}, static_cast<int>(logs.size())};
  constexpr std::size_t kFewestPairs = 6;
  if (logs.size() < kFewestPairs) return estimate;

  // Half of a random number's bits are enough for an index: two values are drawn at once, and
  // summed apart, since an addition that waits for the last one is what would take the time.
  RandomBits random(seed);
  const std::size_t n = logs.size();
  const auto value = [&](std::uint64_t bits) { return logs[(bits * n) >> 32U]; };
  std::vector<double> means(static_cast<std::size_t>(num_resamples));
  for (double& mean : means) {
    double first_sum = 0, second_sum = 0;
    for (std::size_t i = 0; i + 1 < n; i += 2) {
      const std::uint64_t bits = random();
      first_sum += value(bits >> 32U);
      second_sum += value(bits & 0xffffffffU);
    }
    if (n % 2 == 1) first_sum += value(random() >> 32U);
    mean = (first_sum + second_sum) / static_cast<double>(n);
  }
  std::sort(means.begin(), means.end());
  constexpr double kTail = (1 - kConfidence) / 2;
  estimate.interval = {std::exp(Quantile(means, kTail)), std::exp(Quantile(means, 1 - kTail))};
  return estimate;
}

}  // namespace planbench
