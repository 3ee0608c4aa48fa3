#include "results/signed_rank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "common/numbers.h"

namespace planbench {
namespace {

/// Share of all 2^n ways to sign the differences in which the smaller rank sum is at most the
/// observed one: the two-sided p-value, by enumeration.
double EnumeratedPValue(const std::vector<double>& differences) {
  const double observed = [&] {
    const SignedRankTest test = TestSignedRanks(differences);
    return std::min(test.positive, test.negative);
  }();
  const std::size_t n = differences.size();
  std::vector<double> ranks(n);
  for (std::size_t i = 0; i < n; ++i) {
    double below = 0;
    double equal = 0;
    for (const double other : differences) {
      below += std::abs(other) < std::abs(differences[i]);
      equal += std::abs(other) == std::abs(differences[i]);
    }
    ranks[i] = below + (equal + 1) / 2;
  }
  int extreme = 0;
  for (unsigned signs = 0; signs < (1U << n); ++signs) {
    double positive = 0;
    double negative = 0;
    for (std::size_t i = 0; i < n; ++i) ((signs >> i) & 1 ? positive : negative) += ranks[i];
    extreme += std::min(positive, negative) <= observed;
  }
  return static_cast<double>(extreme) / (1U << n);
}

/// 1 to n, the first `num_negative` of them negative.
std::vector<double> Signed(int n, int num_negative) {
  std::vector<double> differences;
  for (int i = 1; i <= n; ++i) differences.push_back(i <= num_negative ? -i : i);
  return differences;
}

TEST(SignedRankTestTest, SumsRanks) {
  const SignedRankTest test = TestSignedRanks({-0.1, 4, 0, -2, 2, 7, 0});
  // Magnitudes 0.1, 2, 2, 4, 7 with ranks 1, 2.5, 2.5, 4, 5.
  EXPECT_EQ(test.num_differences, 5);
  EXPECT_EQ(test.negative, 1 + 2.5);
  EXPECT_EQ(test.positive, 2.5 + 4 + 5);
}

TEST(SignedRankTestTest, PValueIsTheEnumeratedOne) {
  std::mt19937 random(1);
  for (int round = 0; round < 40; ++round) {
    std::vector<double> differences(1 + random() % 12);
    // Few magnitudes, for ties.
    for (double& d : differences) {
      d = static_cast<double>(1 + random() % (round % 2 == 0 ? 4 : 1000)) *
          (random() % 3 == 0 ? -1 : 1);
    }
    EXPECT_NEAR(TestSignedRanks(differences).p_value, std::min(1.0, EnumeratedPValue(differences)),
                1e-12)
        << round;
  }
}

TEST(SignedRankTestTest, CriticalValuesAreThePublishedOnes) {
  // Wilcoxon's table: the largest rank sum that is significant at 5 %, two-sided.
  struct Case {
    int n, critical;
  };
  for (const Case& c : {Case{6, 0}, Case{8, 3}, Case{10, 8}, Case{15, 25}, Case{20, 52},
                        Case{25, 89}, Case{30, 137}, Case{50, 434}}) {
    // Differences of which the negative ones have the rank sum w: greedily, the largest first.
    const auto with_sum = [&](int w) {
      std::vector<double> differences;
      for (int rank = c.n; rank >= 1; --rank) {
        const bool negative = rank <= w;
        differences.push_back(negative ? -rank : rank);
        if (negative) w -= rank;
      }
      return differences;
    };
    EXPECT_EQ(TestSignedRanks(with_sum(c.critical)).negative, c.critical);
    EXPECT_LE(TestSignedRanks(with_sum(c.critical)).p_value, 0.05) << c.n;
    EXPECT_GT(TestSignedRanks(with_sum(c.critical + 1)).p_value, 0.05) << c.n;
  }
}

TEST(SignedRankTestTest, ManyDifferencesAreNormal) {
  // The exact distribution by convolution, counted in another way than the test does.
  constexpr int kN = kExactDifferences + 10;
  std::vector<double> ways(kN * (kN + 1) / 2 + 1, 0);
  ways[0] = 1;
  for (int rank = 1; rank <= kN; ++rank) {
    for (int s = static_cast<int>(ways.size()) - 1; s >= rank; --s) {
      ways[static_cast<std::size_t>(s)] += ways[static_cast<std::size_t>(s - rank)];
    }
  }
  for (const int num_negative : {20, 25, 30, 35, 40}) {
    const int sum = num_negative * (num_negative + 1) / 2;
    double tail = 0;
    for (int s = 0; s <= sum; ++s) tail += ways[static_cast<std::size_t>(s)];
    const double p = TestSignedRanks(Signed(kN, num_negative)).p_value;
    EXPECT_NEAR(p, 2 * tail / std::pow(2, kN), 3e-3) << num_negative;
  }
  // Ties: of one magnitude it is the sign test, a binomial distribution of variance n / 4.
  std::vector<double> differences(100, 1.0);
  for (std::size_t i = 0; i < 40; ++i) differences[i] = -1;
  // |40 - 50| whole signs of 50.5 ranks each, less half a rank.
  const double z = (10 * 50.5 - 0.5) / (50.5 * 5);
  EXPECT_NEAR(TestSignedRanks(differences).p_value, std::erfc(z / std::sqrt(2)), 1e-9);
}

TEST(SignedRankTestTest, DoesNotDependOnTheSide) {
  std::vector<double> differences = {3, -1, 4, 1, 5, -9, 2, 6};
  const SignedRankTest test = TestSignedRanks(differences);
  for (double& difference : differences) difference = -difference;
  const SignedRankTest other = TestSignedRanks(differences);
  EXPECT_EQ(test.p_value, other.p_value);
  EXPECT_EQ(test.positive, other.negative);
}

TEST(SignedRankTestTest, InfiniteDifferencesRankAboveAll) {
  const SignedRankTest test = TestSignedRanks({kInfinity, 1, -kInfinity, 100});
  EXPECT_EQ(test.positive, 1 + 2 + 3.5);
  EXPECT_EQ(test.negative, 3.5);
}

TEST(SignedRankTestTest, NothingToTellApart) {
  EXPECT_EQ(TestSignedRanks({}).p_value, 1);
  EXPECT_EQ(TestSignedRanks({0, 0}).num_differences, 0);
  EXPECT_EQ(TestSignedRanks({0, 0}).p_value, 1);
  EXPECT_THROW(TestSignedRanks({1, std::nan("")}), std::invalid_argument);
}

TEST(SignedRankTestTest, RankBiserialIsTheDifferenceOfTheShares) {
  EXPECT_EQ(TestSignedRanks({1, 2, 3}).rank_biserial, 1);
  EXPECT_EQ(TestSignedRanks({-1, -2}).rank_biserial, -1);
  EXPECT_NEAR(TestSignedRanks({1, -2, 3, 4}).rank_biserial, (8 - 2) / 10.0, 1e-12);
  EXPECT_EQ(TestSignedRanks({0}).rank_biserial, 0);
}

TEST(SignedRankTestTest, TiesHaveTheLowestRanksAndNoSide) {
  std::vector<double> differences(13, 0.0);
  differences.push_back(-1);
  EXPECT_NEAR(TestSignedRanks(differences).rank_biserial, -14 / 105.0, 1e-12);
  // Of ranks 1 to 5 the ties have 1 and 2.
  EXPECT_NEAR(TestSignedRanks({0, 0, -1, 2, -3}).rank_biserial, (4 - 3 - 5) / 15.0, 1e-12);
}

TEST(SignedRankTestTest, PValuesLeaveTiesOutAndEffectsCountThem) {
  for (const int n : {8, kExactDifferences + 10}) {
    std::vector<double> differences = Signed(n, n / 2);
    const SignedRankTest without = TestSignedRanks(differences);
    differences.resize(differences.size() + 20, 0.0);
    const SignedRankTest with = TestSignedRanks(differences);
    EXPECT_EQ(with.p_value, without.p_value) << n;
    EXPECT_LT(with.rank_biserial, without.rank_biserial) << n;
  }
}

TEST(FewestDifferencesTest, AreThoseThatCanBeRejected) {
  for (const std::size_t num_tests : {1u, 2u, 10u, 45u}) {
    const int fewest = FewestDifferences(num_tests);
    for (const int n : {fewest - 1, fewest}) {
      const double p = TestSignedRanks(std::vector<double>(static_cast<std::size_t>(n), 1)).p_value;
      const double adjusted = AdjustPValues(std::vector<double>(num_tests, p)).front();
      EXPECT_EQ(adjusted <= kTestLevel, n == fewest) << num_tests;
    }
  }
  EXPECT_EQ(FewestDifferences(1), 6);
}

TEST(AdjustPValuesTest, IsHolmsStepDown) {
  // 4 x 0.005; 3 x 0.01 = 0.03; 2 x 0.03 = 0.06; 0.04, which may not be below the one before.
  const std::vector<double> adjusted = AdjustPValues({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-12);
  EXPECT_EQ(AdjustPValues({0.7, 0.9}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(AdjustPValues({}).empty());
}

}  // namespace
}  // namespace planbench
