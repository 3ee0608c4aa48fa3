#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

#include "results/statistics.h"

// What the statistics of the report are, as their definitions have it: by counting, by enumeration.

namespace planbench {

inline double QuantileOf(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const double low = std::floor(at);
  const double below = values[static_cast<std::size_t>(low)];
  const double above = values[std::min(static_cast<std::size_t>(low) + 1, values.size() - 1)];
  return at == low || below == above ? below : below + (at - low) * (above - below);
}

inline double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The shares that a score test does not reject at 5 %: what Wilson's interval is, found by
/// bisection.
inline Interval ScoreInterval(double share, int n) {
  const auto bound = [&](double rejected) {
    double accepted = share;
    for (int i = 0; i < 200; ++i) {
      const double middle = (accepted + rejected) / 2;
      const bool accepts =
          std::pow(share - middle, 2) <= std::pow(1.959963984540054, 2) * middle * (1 - middle) / n;
      (accepts ? accepted : rejected) = middle;
    }
    return accepted;
  };
  return {bound(0), bound(1)};
}

/// Order statistics between which the median lies with 95 %, by Pascal's triangle.
inline std::optional<Interval> OrderInterval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> row = {1};
  for (std::size_t n = 0; n < values.size(); ++n) {
    row.push_back(0);
    for (std::size_t i = row.size() - 1; i > 0; --i) row[i] = (row[i] + row[i - 1]) / 2;
    row[0] /= 2;
  }
  std::optional<Interval> narrowest;
  double outside = 0;
  for (std::size_t k = 0; 2 * k + 1 < values.size(); ++k) {
    outside += 2 * row[k];
    if (outside > 0.05) break;
    narrowest = Interval{values[k], values[values.size() - 1 - k]};
  }
  return narrowest;
}

/// Ranks of the absolute differences that are not 0, ties sharing their mean; with their signs.
inline std::vector<double> SignedRanks(std::vector<double> differences) {
  std::erase(differences, 0.0);
  std::vector<double> ranks;
  for (const double one : differences) {
    double below = 0, equal = 0;
    for (const double other : differences) {
      below += std::abs(other) < std::abs(one);
      equal += std::abs(other) == std::abs(one);
    }
    ranks.push_back(std::copysign(below + (equal + 1) / 2, one));
  }
  return ranks;
}

/// Of all ways to give the ranks signs, the share that is as one-sided or more, both sides.
inline double ProbabilityBySigns(const std::vector<double>& ranks) {
  double positive = 0, negative = 0;
  for (const double rank : ranks) (rank > 0 ? positive : negative) += std::abs(rank);
  const double smaller = std::min(positive, negative);
  int extreme = 0;
  const unsigned num_ways = 1U << ranks.size();
  for (unsigned way = 0; way < num_ways; ++way) {
    double sum = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      if ((way >> i & 1U) != 0) sum += std::abs(ranks[i]);
    }
    extreme += sum <= smaller + 1e-9;
  }
  return std::min(1.0, 2.0 * extreme / num_ways);
}

/// Student's interval of a mean; 97.5 % quantiles by degrees of freedom, from a table.
inline Interval StudentInterval(const std::vector<double>& values) {
  static const std::map<std::size_t, double> kQuantiles = {
      {5, 2.570582},  {6, 2.446912},  {7, 2.364624},  {8, 2.306004},  {9, 2.262157}, {10, 2.228139},
      {11, 2.200985}, {12, 2.178813}, {13, 2.160369}, {14, 2.144787}, {15, 2.131450}};
  const double mean = MeanOf(values);
  double sum = 0;
  for (const double value : values) sum += std::pow(value - mean, 2);
  const auto n = static_cast<double>(values.size());
  const double half = kQuantiles.at(values.size() - 1) * std::sqrt(sum / (n * (n - 1)));
  return {mean - half, mean + half};
}

}  // namespace planbench
