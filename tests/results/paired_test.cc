#include "results/paired.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/numbers.h"

namespace planbench {
namespace {

TEST(CountWinsTest, SolvingAloneWinsToo) {
  const Wins wins =
      CountWins({1, 2, 3, kInfinity, kInfinity, 5}, {2, 1, kInfinity, 4, kInfinity, 5});
  EXPECT_EQ(wins.won, 2);
  EXPECT_EQ(wins.lost, 2);
  EXPECT_EQ(wins.tied, 2);
  EXPECT_DOUBLE_EQ(wins.Share(), 0.5);
  EXPECT_TRUE(std::isnan(CountWins({}, {}).Share()));
  EXPECT_THROW(CountWins({1}, {}), std::invalid_argument);
}

TEST(EstimateRatioTest, IsTheGeometricMean) {
  const auto ratio = EstimateRatio({2, 2, 16}, {1, 4, 2}, 1);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->mean, std::cbrt(2 * 0.5 * 8), 1e-12);
  EXPECT_EQ(ratio->num_pairs, 3);
}

TEST(EstimateRatioTest, FewPairsGiveNoInterval) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 4};
  const std::vector<double> second = {2, 2, 2, 2, 2, 2};
  ASSERT_TRUE(EstimateRatio(first, second, 1)->interval);
  EXPECT_LT(EstimateRatio(first, second, 1)->interval->lower,
            EstimateRatio(first, second, 1)->mean);
  for (std::size_t n = 1; n < first.size(); ++n) {
    const auto few =
        EstimateRatio({first.begin(), first.begin() + n}, {second.begin(), second.begin() + n}, 1);
    ASSERT_TRUE(few);
    EXPECT_FALSE(few->interval) << n;
  }
}

TEST(EstimateRatioTest, IntervalIsThatOfAllResamples) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 4};
  const std::vector<double> second = {2, 2, 2, 2, 2, 2};
  // All 6^6 resamples, equally probable.
  std::vector<double> means;
  for (int resample = 0; resample < 6 * 6 * 6 * 6 * 6 * 6; ++resample) {
    double product = 1;
    for (int i = 0, digits = resample; i < 6; ++i, digits /= 6) {
      product *= first[static_cast<std::size_t>(digits % 6)] / 2;
    }
    means.push_back(std::pow(product, 1 / 6.0));
  }
  std::sort(means.begin(), means.end());
  const auto ratio = EstimateRatio(first, second, 7, 200'000);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->interval->lower, Quantile(means, 0.025), 0.01);
  EXPECT_NEAR(ratio->interval->upper, Quantile(means, 0.975), 0.02);
}

TEST(EstimateRatioTest, EqualSeedsGiveEqualIntervals) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 1.1, 2.7, 4.3, 9, 0.3};
  const std::vector<double> second = {2, 1, 4, 3, 2, 1.3, 1.7, 1.9, 8, 0.7};
  const auto one = EstimateRatio(first, second, 7);
  const auto same = EstimateRatio(first, second, 7);
  const auto other = EstimateRatio(first, second, 8);
  EXPECT_EQ(one->interval->lower, same->interval->lower);
  EXPECT_EQ(one->interval->upper, same->interval->upper);
  EXPECT_NE(std::pair(one->interval->lower, one->interval->upper),
            std::pair(other->interval->lower, other->interval->upper));
}

TEST(EstimateRatioTest, TurnsRoundWithTheSides) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 4};
  const std::vector<double> second = {2, 1, 4, 3, 2, 7};
  const auto ratio = EstimateRatio(first, second, 7);
  const auto inverse = EstimateRatio(second, first, 7);
  EXPECT_NEAR(ratio->mean, 1 / inverse->mean, 1e-12);
  EXPECT_NEAR(ratio->interval->lower, 1 / inverse->interval->upper, 1e-9);
}

TEST(EstimateRatioTest, PairsThatAreNotBothSolvedAreLeftOut) {
  const auto ratio = EstimateRatio({4, kInfinity, 1}, {2, 1, kInfinity}, 1);
  ASSERT_TRUE(ratio);
  EXPECT_DOUBLE_EQ(ratio->mean, 2);
  EXPECT_EQ(ratio->num_pairs, 1);
  EXPECT_FALSE(EstimateRatio({kInfinity}, {1}, 1));
  EXPECT_FALSE(EstimateRatio({}, {}, 1));
  EXPECT_THROW(EstimateRatio({0}, {1}, 1), std::invalid_argument);
  EXPECT_THROW(EstimateRatio({1}, {std::nan("")}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace planbench
