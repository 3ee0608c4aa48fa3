#include "benchmark_driver/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace planbench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

}  // namespace
}  // namespace planbench
