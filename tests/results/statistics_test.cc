#include "results/statistics.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>

#include "common/numbers.h"

namespace planbench {
namespace {

TEST(QuantileTest, InterpolatesLinearlyBetweenOrderStatistics) {
  // As numpy.quantile([1, 2, 4, 8], q).
  const std::vector<double> values = {1, 2, 4, 8};
  EXPECT_DOUBLE_EQ(Quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.5), 3);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.75), 5);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.95), 7.4);
  EXPECT_DOUBLE_EQ(Quantile(values, 1), 8);
}

TEST(QuantileTest, OfOneValueIsThatValue) {
  for (const double q : {0.0, 0.3, 1.0}) EXPECT_EQ(Quantile({5}, q), 5);
}

TEST(QuantileTest, OfNothingIsNotANumber) { EXPECT_TRUE(std::isnan(Quantile({}, 0.5))); }

TEST(QuantileTest, InfiniteValuesAreValues) {
  EXPECT_EQ(Quantile({1, 2, kInfinity}, 0.5), 2);
  EXPECT_EQ(Quantile({1, kInfinity, kInfinity}, 0.5), kInfinity);
  EXPECT_EQ(Quantile({kInfinity, kInfinity}, 0.5), kInfinity);
  EXPECT_EQ(Quantile({1, kInfinity}, 0.5), kInfinity);
}

TEST(SummarizeTest, NeedsNoOrder) {
  const Summary summary = Summarize({8, 1, 4, 2});
  EXPECT_EQ(summary.count, 4);
  EXPECT_DOUBLE_EQ(summary.mean, 3.75);
  EXPECT_DOUBLE_EQ(summary.median, 3);
  EXPECT_DOUBLE_EQ(summary.lower_quartile, 1.75);
  EXPECT_DOUBLE_EQ(summary.upper_quartile, 5);
  EXPECT_DOUBLE_EQ(summary.percentile_95, 7.4);
}

TEST(SummarizeTest, OfNothingCountsNothing) {
  const Summary summary = Summarize({});
  EXPECT_EQ(summary.count, 0);
  for (const double value : {summary.mean, summary.median, summary.lower_quartile,
                             summary.upper_quartile, summary.percentile_95}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(WilsonIntervalTest, IsThePublishedOne) {
  // Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in Medicine
  // 17 (1998), table I, method 3.
  struct Case {
    int successes, trials;
    double lower, upper;
  };
  for (const Case& c : {Case{81, 263, 0.2553, 0.3662}, Case{15, 148, 0.0624, 0.1605},
                        Case{0, 20, 0, 0.1611}, Case{1, 29, 0.0061, 0.1718}}) {
    const Interval interval = WilsonInterval(c.successes, c.trials);
    EXPECT_NEAR(interval.lower, c.lower, 5e-5) << c.successes << "/" << c.trials;
    EXPECT_NEAR(interval.upper, c.upper, 5e-5) << c.successes << "/" << c.trials;
  }
}

TEST(WilsonIntervalTest, EndsAreWhereTheNormalTestJustRejects) {
  for (const int trials : {1, 7, 100, 300}) {
    for (int successes = 0; successes <= trials; ++successes) {
      const Interval interval = WilsonInterval(successes, trials);
      const double share = static_cast<double>(successes) / trials;
      for (const double end : {interval.lower, interval.upper}) {
        if (end == 0 || end == 1) continue;
        const double z = std::abs(share - end) / std::sqrt(end * (1 - end) / trials);
        EXPECT_NEAR(std::erfc(z / std::sqrt(2)), 0.05, 1e-9) << successes << "/" << trials;
      }
      EXPECT_LE(interval.lower, share);
      EXPECT_GE(interval.upper, share);
    }
  }
}

TEST(WilsonIntervalTest, WithoutTrialsEverythingIsPossible) {
  EXPECT_EQ(WilsonInterval(0, 0).lower, 0);
  EXPECT_EQ(WilsonInterval(0, 0).upper, 1);
}

/// 1, 2, ..., n, so that a value is its rank.
std::vector<double> Ranks(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), 1);
  return values;
}

TEST(MedianIntervalTest, RanksAreThePublishedOnes) {
  // Conover, "Practical Nonparametric Statistics": ranks of the 95 % interval of the median.
  struct Case {
    int n, lower, upper;
  };
  for (const Case& c : {Case{6, 1, 6}, Case{8, 1, 8}, Case{9, 2, 8}, Case{10, 2, 9},
                        Case{15, 4, 12}, Case{20, 6, 15}, Case{25, 8, 18}}) {
    const auto interval = MedianInterval(Ranks(c.n));
    ASSERT_TRUE(interval) << c.n;
    EXPECT_EQ(interval->lower, c.lower) << c.n;
    EXPECT_EQ(interval->upper, c.upper) << c.n;
  }
}

TEST(MedianIntervalTest, IsTheNarrowestThatCoversByEnumeration) {
  for (int n = 1; n <= 16; ++n) {
    // All ways in which n values can lie below or above the median, equally probable. The k-th
    // value and the k-th from above enclose it if at least k lie on either side.
    const auto covers = [n](int k) {
      int covered = 0;
      for (unsigned sides = 0; sides < (1U << n); ++sides) {
        const int below = std::popcount(sides);
        covered += below >= k && n - below >= k;
      }
      return covered >= 0.95 * (1U << n);
    };
    const auto interval = MedianInterval(Ranks(n));
    if (!interval) {
      EXPECT_FALSE(covers(1)) << n;
      continue;
    }
    const int k = static_cast<int>(interval->lower);
    EXPECT_EQ(interval->upper, n + 1 - k) << n;
    EXPECT_TRUE(covers(k)) << n;
    EXPECT_FALSE(covers(k + 1)) << n;
  }
}

TEST(MedianIntervalTest, OfManyIsTheNormalApproximation) {
  // Ranks n/2 -+ 1.96 sqrt(n)/2.
  const auto interval = MedianInterval(Ranks(10'000));
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->lower, 4902, 1);
  EXPECT_NEAR(interval->upper, 5099, 1);
}

TEST(MedianIntervalTest, NeedsNoOrderAndTakesInfiniteValues) {
  const auto interval = MedianInterval({kInfinity, 3, 1, kInfinity, 2, 4});
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->lower, 1);
  EXPECT_EQ(interval->upper, kInfinity);
  EXPECT_FALSE(MedianInterval({}));
}

TEST(PenalisedMeanTest, CountsFailuresAsManyTimesTheLimit) {
  EXPECT_DOUBLE_EQ(PenalisedMean({1, 3}, {}), 2);
  EXPECT_DOUBLE_EQ(PenalisedMean({1, 3}, {60, 5}), (1 + 3 + 600 + 50) / 4.0);
  EXPECT_DOUBLE_EQ(PenalisedMean({}, {60, 60, 60}), 600);
  EXPECT_TRUE(std::isnan(PenalisedMean({}, {})));
  EXPECT_TRUE(std::isnan(PenalisedMean({1, 2}, {60, 0}))) << "a limit is not known";
}

TEST(StudentQuantileTest, IsTheTables) {
  const std::vector<std::pair<int, double>> table = {
      {1, 12.706205}, {2, 4.302653}, {5, 2.570582}, {9, 2.262157}, {30, 2.042272}, {99, 1.984217}};
  for (const auto& [degrees, quantile] : table) {
    EXPECT_NEAR(StudentQuantile(degrees), quantile, 1e-6) << degrees;
  }
  EXPECT_NEAR(StudentQuantile(100'000), 1.959963984540054, 1e-4);
}

}  // namespace
}  // namespace planbench
