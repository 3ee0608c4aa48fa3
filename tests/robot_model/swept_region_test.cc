#include "robot_model/swept_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/numbers.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST(MaxDistanceToEllipse, EqualsTheLargestSampledDistance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> signed_unit(-1, 1), unit(0, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector2d w(signed_unit(random), signed_unit(random));
    const double r = unit(random);
    const double s = unit(random);
    double sampled = 0;
    for (int i = 0; i < 4000; ++i) {
      const double angle = 2 * kPi * i / 4000;
      sampled =
          std::max(sampled, (w + r * Eigen::Vector2d(std::cos(angle), s * std::sin(angle))).norm());
    }
    const double bound = MaxDistanceToEllipse(w, r, s);
    EXPECT_GE(bound, sampled - 1e-12);
    EXPECT_LE(bound, sampled + 1e-5);
  }
}

TEST(MaxDistanceToEllipse, IsExactInTheLimits) {
  EXPECT_NEAR(MaxDistanceToEllipse({0.3, 0.4}, 0, 0.5), 0.5, 1e-15);
  EXPECT_NEAR(MaxDistanceToEllipse({0.3, 0.4}, 2, 1), 2.5, 1e-12);                    // A circle.
  EXPECT_NEAR(MaxDistanceToEllipse({0.3, 0.4}, 0.6, 0), std::hypot(0.9, 0.4), 1e-6);  // A line.
  EXPECT_NEAR(MaxDistanceToEllipse({0, 0}, 0.7, 0.3), 0.7, 1e-6);                     // Centred.
}

TEST(SweptRegion, OfOneJointIsTheDistanceFromItsAxis) {
  SweptRegion region(Vector3d(3, 4, 7));
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), 5, 1e-12);
}

TEST(SweptRegion, OfParallelAxesIsTheSumOfTheLinks) {
  SweptRegion region(Vector3d(0.5, 0, 0.2));
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), 0.5, 1e-12);
  region.Transform(Isometry3d(Eigen::Translation3d(0.7, 0, 5)));
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), 1.2, 1e-9);
  region.Transform(Isometry3d(Eigen::Translation3d(0, 0.3, -1)));
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), 1.5, 1e-9);
}

TEST(SweptRegion, OfAStraightArmWithRollsIsItsLength) {
  // Roll, bend, roll, bend: what hangs on the axis reaches the length of the arm, not more.
  SweptRegion region(Vector3d(0.3, 0, 0));
  const Isometry3d offset(Eigen::Translation3d(0.2, 0, 0));
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitX()), 0, 1e-12);
  region.Transform(offset);
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitY()), 0.5, 1e-9);
  region.Transform(offset);
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitX()), 0.5, 1e-6);
  region.Transform(offset);
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitY()), 0.9, 1e-6);
}

TEST(SweptRegion, SlidesExtendItByTheirTravel) {
  SweptRegion region(Vector3d(0.1, 0, 0));
  region.Slide(Vector3d::UnitX(), 0.2, 0.5);
  region.Slide(Vector3d::UnitY(), -0.8, 0.1);
  EXPECT_NEAR(region.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), std::hypot(0.6, 0.8), 1e-12);
  SweptRegion along_axis(Vector3d(0.1, 0, 0));
  along_axis.Slide(Vector3d::UnitZ(), 0, 3);
  EXPECT_NEAR(along_axis.Revolve(Vector3d::Zero(), Vector3d::UnitZ()), 0.1, 1e-12);
}

}  // namespace
}  // namespace planbench
