#include "planning/motion_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/numbers.h"
#include "tests/planning/three_joints.h"

namespace planbench {
namespace {

TEST(MotionTimeTest, OfStraightMotionsIsThatOfTheTrapezoid) {
  EXPECT_EQ(MotionTime(ThreeJoints(), {}), 0);
  EXPECT_EQ(MotionTime(ThreeJoints(), {{0, 0, 0}, {0, 0, 0}}), 0);
  // 2 rad at 1 rad/s, accelerated and braked at 2 rad/s^2: 0.5 s, 1.5 s, 0.5 s.
  EXPECT_NEAR(MotionTime(ThreeJoints(), {{0, 0, 0}, {0, 2, 0}}), 2.5, 1e-12);
  // 0.32 rad are too short for full speed: half of it at 2 rad/s^2 takes 0.4 s.
  EXPECT_NEAR(MotionTime(ThreeJoints(), {{0, 0, 0}, {0, 0.32, 0}}), 0.8, 1e-12);
  // Cut into pieces, and across the seam of the continuous joint.
  EXPECT_NEAR(MotionTime(ThreeJoints(), {{0, 0, 0}, {0, 0.5, 0}, {0, 0.5, 0}, {0, 2, 0}}), 2.5,
              1e-12);
  EXPECT_NEAR(MotionTime(ThreeJoints(), {{3, 0, 0}, {-3, 0, 0}, {-2, 0, 0}}), 2 * kPi - 5 + 0.5,
              1e-9);
}

TEST(MotionTimeTest, TheSlowestJointSetsThePaceAndCornersStop) {
  const JointSpace space({{"a", false, false, -10, 10, 2}, {"b", false, false, -10, 10, 0.5}});
  EXPECT_NEAR(MotionTime(space, {{0, 0}, {3, 2}}), 2 / 0.5 + 0.5, 1e-12);
  EXPECT_NEAR(MotionTime(space, {{0, 0}, {3, 0}, {3, 2}}), 1.5 + 0.5 + 4 + 0.5, 1e-12);
  // A joint without a limit: 1 rad/s.
  EXPECT_NEAR(MotionTime(JointSpace({{"a", false, false, -10, 10, 0}}), {{0}, {3}}), 3.5, 1e-12);
}

/// By integration in small steps: the speed along a piece is the lowest of what braking from here,
/// accelerating up to here, and the joints allow.
TEST(MotionTimeTest, IsThatOfAnIntegration) {
  const JointSpace space({{"a", false, false, -10, 10, 1.5}, {"b", false, true, -10, 10, 0.4}});
  const Path path = {{0, 0}, {0.1, 0.3}, {2, -0.5}, {2.05, -0.5}};
  double expected = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = space.Distance(path[i - 1], path[i]);
    double speed = 1e9;
    for (std::size_t j = 0; j < 2; ++j) {
      const double share = std::abs(path[i][j] - path[i - 1][j]) / length;
      if (share > 0) speed = std::min(speed, space.joints()[j].max_velocity / share);
    }
    const double acceleration = speed / kTimeToFullSpeed;
    constexpr int kSteps = 200'000;
    for (int k = 0; k < kSteps; ++k) {
      const double s = (k + 0.5) / kSteps * length;
      const double nearest_end = std::min(s, length - s);
      expected += length / kSteps / std::min(speed, std::sqrt(2 * acceleration * nearest_end));
    }
  }
  EXPECT_NEAR(MotionTime(space, path), expected, 2e-3 * expected);
}

}  // namespace
}  // namespace planbench
