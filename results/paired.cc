#include "results/paired.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
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
                                           const std::vector<double>& second) {
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
  const double mean = Mean(logs);
  RatioEstimate estimate{std::exp(mean), {}, static_cast<int>(logs.size())};
  constexpr std::size_t kFewestPairs = 6;
  if (logs.size() < kFewestPairs) return estimate;
  double sum_of_squares = 0;
  for (const double log : logs) sum_of_squares += (log - mean) * (log - mean);
  const int degrees = estimate.num_pairs - 1;
  const double half =
      StudentQuantile(degrees) * std::sqrt(sum_of_squares / degrees / estimate.num_pairs);
  estimate.interval = {std::exp(mean - half), std::exp(mean + half)};
  return estimate;
}

std::string RatioText(double ratio, const std::string& rounded) {
  const auto reads_one = [](const std::string& text) {
    return std::strtod(text.c_str(), nullptr) == 1;
  };
  std::string text = rounded;
  for (int decimals = 3; decimals <= 9 && reads_one(text); ++decimals) {
    text = fmt::format("{:.{}f}", ratio, decimals);
  }
  return reads_one(text) ? rounded : text;
}

}  // namespace planbench
