#include "sphere_fitting/tightness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/polyhedra.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

TEST(MeasureTightness, OfABallAroundABall) {
  LinkBody body;
  body.Add({Sphere{0.2}, Eigen::Isometry3d::Identity()});
  const Tightness tightness = MeasureTightness(body, {{{0, 0, 0.01}, 0.25}});
  EXPECT_EQ(tightness.balls, 1);
  EXPECT_NEAR(tightness.greatest_m, 0.06, 1e-12);
  EXPECT_NEAR(tightness.mean_m(), 0.05, 2e-4);
  EXPECT_NEAR(tightness.area_m2, 4 * std::numbers::pi * 0.25 * 0.25, 1e-9);
  EXPECT_NEAR(tightness.volume_ratio().value(), std::pow(0.25 / 0.2, 3), 0.02);
}

TEST(MeasureTightness, LeavesOutWhatIsInAnotherBall) {
  LinkBody body;
  body.Add({Box{{0.2, 0.2, 0.2}}, Eigen::Isometry3d::Identity()});
  const Ball around{{0, 0, 0}, 0.2};
  const Tightness one = MeasureTightness(body, {around});
  const Tightness two = MeasureTightness(body, {around, {{0.05, 0, 0}, 0.1}});
  EXPECT_EQ(one.area_distance_m3, two.area_distance_m3);
  EXPECT_EQ(one.balls_volume_m3, two.balls_volume_m3);
  EXPECT_NEAR(one.greatest_m, 0.1, 1e-12);
  EXPECT_NEAR(one.volume_ratio().value(), 4 * std::numbers::pi / 3 * 0.008 / 0.008, 0.03);
}

TEST(MeasureTightness, AddsUpAndLeavesRatiosOfSheetsOut) {
  LinkBody sheet;
  sheet.Add(
      {Mesh{"", Vector3d::Ones(), SheetMesh(0.1, 0.1, 10, 3)}, Eigen::Isometry3d::Identity()});
  Tightness all = MeasureTightness(sheet, {{{0, 0, 0}, 0.2}});
  EXPECT_FALSE(all.volume_ratio().has_value());
  LinkBody body;
  body.Add({Sphere{0.2}, Eigen::Isometry3d::Identity()});
  const Tightness ball = MeasureTightness(body, {{{0, 0, 0}, 0.25}});
  const double area = all.area_m2;
  all.Add(ball);
  EXPECT_EQ(all.balls, 2);
  EXPECT_DOUBLE_EQ(all.area_m2, area + ball.area_m2);
  EXPECT_EQ(all.volume_ratio(), ball.volume_ratio());
  EXPECT_NEAR(all.greatest_m, 0.3, 2e-3) << "the sheet bends away from the ball's middle";
}

}  // namespace
}  // namespace planbench
