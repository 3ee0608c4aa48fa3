#include "results/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace planbench {
namespace {

/// P(the sum of the ranks with a positive sign is at most `sum`), each sign a fair coin. Ranks and
/// sum are doubled, so that the means of ties are whole numbers.
double ExactTail(const std::vector<int>& doubled_ranks, int doubled_sum) {
  // probability[s]: that the signs so far give the sum s. Powers of two, so that nothing is lost
  // to rounding.
  std::vector<double> probability(static_cast<std::size_t>(doubled_sum) + 1, 0);
  probability[0] = 1;
  for (const int rank : doubled_ranks) {
    for (int s = doubled_sum; s >= 0; --s) {
      const auto at = static_cast<std::size_t>(s);
      const double with = s >= rank ? probability[at - static_cast<std::size_t>(rank)] : 0;
      probability[at] = (probability[at] + with) / 2;
    }
  }
  double tail = 0;
  for (const double p : probability) tail += p;
  return tail;
}

}  // namespace

SignedRankTest TestSignedRanks(const std::vector<double>& differences) {
  std::vector<double> sorted;
  for (const double difference : differences) {
    if (std::isnan(difference)) throw std::invalid_argument("signed ranks: a difference is NaN");
    if (difference != 0) sorted.push_back(difference);
  }
  std::sort(sorted.begin(), sorted.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });

  SignedRankTest test;
  test.num_differences = static_cast<int>(sorted.size());
  const double n = test.num_differences;
  const auto num_zero = static_cast<double>(differences.size()) - n;
  double signed_ranks = 0, all_ranks = num_zero * (num_zero + 1) / 2;  // Pratt's
  std::vector<int> doubled_ranks;
  double variance = n * (n + 1) * (2 * n + 1) / 24;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    const auto ties = static_cast<double>(end - begin);
    const int doubled_rank = static_cast<int>(begin + 1 + end);  // of ranks begin + 1 to end
    variance -= (ties * ties * ties - ties) / 48;
    for (std::size_t i = begin; i < end; ++i) {
      (sorted[i] > 0 ? test.positive : test.negative) += doubled_rank / 2.0;
      const double rank = num_zero + doubled_rank / 2.0;
      signed_ranks += std::copysign(rank, sorted[i]);
      all_ranks += rank;
      doubled_ranks.push_back(doubled_rank);
    }
  }
  if (test.num_differences == 0) return test;
  test.rank_biserial = signed_ranks / all_ranks;

  const double smaller = std::min(test.positive, test.negative);
  if (test.num_differences <= kExactDifferences) {
    test.p_value = std::min(1.0, 2 * ExactTail(doubled_ranks, static_cast<int>(2 * smaller)));
  } else {
    const double distance = std::max(0.0, n * (n + 1) / 4 - smaller - 0.5);
    test.p_value = std::erfc(distance / std::sqrt(2 * variance));
  }
  return test;
}

int FewestDifferences(std::size_t num_tests) {
  int n = 1;
  while (static_cast<double>(num_tests) * std::ldexp(1.0, 1 - n) > kTestLevel) ++n;
  return n;
}

std::vector<double> AdjustPValues(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double scaled = static_cast<double>(order.size() - i) * p_values[order[i]];
    largest = std::max(largest, std::min(scaled, 1.0));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace planbench
