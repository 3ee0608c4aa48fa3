#pragma once

#include <cstddef>
#include <vector>

namespace planbench {

/// Wilcoxon's signed-rank test (1945) of paired differences: how probable ranks at least as
/// one-sided are if either sign is as likely as the other.
struct SignedRankTest {
  int num_differences = 0;  ///< Other than zero, which are left out.
  double positive = 0;      ///< Sum of the ranks of positive differences.
  double negative = 0;
  double p_value = 1;  ///< Two-sided.
  /// Effect size: matched-pairs rank-biserial correlation (Kerby 2014), from -1 (every difference
  /// is negative) to 1; 0 if there are none. Differences of zero, other than in the p-value, have
  /// the lowest ranks and no side (Pratt 1959): over the sum of all ranks, theirs included, so that
  /// few differences among many ties are a small effect.
  double rank_biserial = 0;
};

/// Ties share the mean of their ranks. Differences may be infinite: these rank above all others.
/// Exact, ties included, up to kExactDifferences; beyond, the normal approximation with the
/// variance corrected for ties and the continuity correction. Throws std::invalid_argument for NaN.
inline constexpr int kExactDifferences = 50;
SignedRankTest TestSignedRanks(const std::vector<double>& differences);

/// The level at which differences are called shown.
inline constexpr double kTestLevel = 0.05;

/// The fewest differences that the test can reject at kTestLevel, the p-value being adjusted for
/// `num_tests` (AdjustPValues): all of one sign, two of the 2^n ways to give them signs.
int FewestDifferences(std::size_t num_tests);

/// The p-values of several tests, in their order, adjusted so that any false rejection among them
/// has the level of one (Holm 1979).
std::vector<double> AdjustPValues(const std::vector<double>& p_values);

}  // namespace planbench
