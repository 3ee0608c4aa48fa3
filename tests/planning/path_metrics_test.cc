#include "planning/path_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace planbench {
namespace {

constexpr double kPi = std::numbers::pi;

/// A continuous joint and two bounded ones.
JointSpace Space() {
  return JointSpace({{"turn", true, false, -kPi, kPi, 1},
                     {"bend", false, false, -10, 10, 1},
                     {"slide", false, true, -10, 10, 1}});
}

TEST(PathLengthTest, OfNothingAndOfOnePointIsZero) {
  EXPECT_EQ(PathLength(Space(), {}), 0);
  EXPECT_EQ(PathLength(Space(), {{1, 2, 3}}), 0);
}

TEST(PathLengthTest, AddsUpL2Distances) {
  EXPECT_DOUBLE_EQ(PathLength(Space(), {{0, 0, 0}, {0, 3, 4}, {0, 3, 4}, {0, 3, 6}}), 7);
}

TEST(PathLengthTest, ContinuousJointsGoTheShortWay) {
  EXPECT_NEAR(PathLength(Space(), {{3, 0, 0}, {-3, 0, 0}}), 2 * kPi - 6, 1e-12);
  EXPECT_NEAR(PathLength(Space(), {{kPi, 0, 0}, {-kPi, 0, 0}}), 0, 1e-12);
  EXPECT_NEAR(PathLength(Space(), {{0.1 + 4 * kPi, 0, 0}, {0, 0, 0}}), 0.1, 1e-12);
}

TEST(PathSmoothnessTest, StraightPathsAreZero) {
  EXPECT_EQ(PathSmoothness(Space(), {}), 0);
  EXPECT_EQ(PathSmoothness(Space(), {{0, 0, 0}, {0, 1, 0}}), 0);
  EXPECT_NEAR(PathSmoothness(Space(), {{0, 0, 0}, {0, 1, 0}, {0, 4, 0}}), 0, 1e-15);
  EXPECT_NEAR(PathSmoothness(Space(), {{3, 0, 0}, {-3, 0, 0}, {-2.8, 0, 0}}), 0, 1e-15)
      << "straight across the seam of the continuous joint";
}

TEST(PathSmoothnessTest, ARightAngle) {
  // Turn of pi/2 between segments of 1 and 2: (2 * pi/2 / 3)^2.
  EXPECT_NEAR(PathSmoothness(Space(), {{0, 0, 0}, {0, 1, 0}, {0, 1, 2}}), std::pow(kPi / 3, 2),
              1e-12);
}

TEST(PathSmoothnessTest, AReversalIsATurnOfPi) {
  EXPECT_NEAR(PathSmoothness(Space(), {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}), std::pow(kPi, 2), 1e-12);
}

TEST(PathSmoothnessTest, SumsOverWaypointsAndSkipsRepeatedOnes) {
  const Path path = {{0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(PathSmoothness(Space(), path), 2 * std::pow(kPi / 2, 2), 1e-12);
}

}  // namespace
}  // namespace planbench
