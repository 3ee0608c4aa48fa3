#include "results/paired.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

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
  const auto ratio = EstimateRatio({2, 2, 16}, {1, 4, 2});
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->mean, std::cbrt(2 * 0.5 * 8), 1e-12);
  EXPECT_EQ(ratio->num_pairs, 3);
}

TEST(EstimateRatioTest, FewPairsGiveNoInterval) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 4};
  const std::vector<double> second = {2, 2, 2, 2, 2, 2};
  ASSERT_TRUE(EstimateRatio(first, second)->interval);
  EXPECT_LT(EstimateRatio(first, second)->interval->lower, EstimateRatio(first, second)->mean);
  for (std::size_t n = 1; n < first.size(); ++n) {
    const auto few =
        EstimateRatio({first.begin(), first.begin() + n}, {second.begin(), second.begin() + n});
    ASSERT_TRUE(few);
    EXPECT_FALSE(few->interval) << n;
  }
}

TEST(RatioTextTest, NeverReadsOneThatIsNot) {
  EXPECT_EQ(RatioText(0.952, "0.952"), "0.952");
  EXPECT_EQ(RatioText(1.0028, "1"), "1.003");
  EXPECT_EQ(RatioText(1.0028, "1.00"), "1.003");
  EXPECT_EQ(RatioText(0.99951, "1.00"), "0.9995");
  EXPECT_EQ(RatioText(1.000002, "1"), "1.000002");
  EXPECT_EQ(RatioText(1, "1.00"), "1.00");
  EXPECT_EQ(RatioText(1 + 1e-15, "1"), "1") << "rounding";
}

TEST(EstimateRatioTest, IntervalIsStudents) {
  // Logarithms 1 to 6: mean 3.5, variance 3.5; t of 5 degrees from the table.
  std::vector<double> first;
  for (int i = 1; i <= 6; ++i) first.push_back(std::exp(i));
  const auto ratio = EstimateRatio(first, std::vector<double>(6, 1));
  ASSERT_TRUE(ratio);
  const double half = 2.570582 * std::sqrt(3.5 / 6);
  EXPECT_NEAR(std::log(ratio->interval->lower), 3.5 - half, 1e-6);
  EXPECT_NEAR(std::log(ratio->interval->upper), 3.5 + half, 1e-6);
}

TEST(EstimateRatioTest, IntervalCoversAsOftenAsItSays) {
  std::mt19937 random(3);
  // Logarithms whose mean is 0: sums of uniform numbers, all but normal, of so few pairs as have an
  // interval.
  const auto draw = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random()) / 4294967296.0;
    return sum;
  };
  int covered = 0;
  constexpr int kSamples = 4000;
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<double> first;
    for (int i = 0; i < 6; ++i) first.push_back(std::exp(draw()));
    const auto ratio = EstimateRatio(first, std::vector<double>(6, 1));
    covered += ratio->interval->lower <= 1 && ratio->interval->upper >= 1;
  }
  EXPECT_NEAR(covered / static_cast<double>(kSamples), 0.95, 0.015);
}

TEST(EstimateRatioTest, TurnsRoundWithTheSides) {
  const std::vector<double> first = {1, 3, 2, 8, 5, 4};
  const std::vector<double> second = {2, 1, 4, 3, 2, 7};
  const auto ratio = EstimateRatio(first, second);
  const auto inverse = EstimateRatio(second, first);
  EXPECT_NEAR(ratio->mean, 1 / inverse->mean, 1e-12);
  EXPECT_NEAR(ratio->interval->lower, 1 / inverse->interval->upper, 1e-9);
}

TEST(EstimateRatioTest, PairsThatAreNotBothSolvedAreLeftOut) {
  const auto ratio = EstimateRatio({4, kInfinity, 1}, {2, 1, kInfinity});
  ASSERT_TRUE(ratio);
  EXPECT_DOUBLE_EQ(ratio->mean, 2);
  EXPECT_EQ(ratio->num_pairs, 1);
  EXPECT_FALSE(EstimateRatio({kInfinity}, {1}));
  EXPECT_FALSE(EstimateRatio({}, {}));
  EXPECT_THROW(EstimateRatio({0}, {1}), std::invalid_argument);
  EXPECT_THROW(EstimateRatio({1}, {std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace planbench
