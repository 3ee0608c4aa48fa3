#include "collision/simd/hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace planbench {
namespace {

using Eigen::Vector3d;

double Support(const std::vector<Vector3d>& points, const Vector3d& direction) {
  double most = -1e9;
  for (const Vector3d& point : points) most = std::max(most, direction.dot(point));
  return most;
}

std::vector<Vector3d> RandomPoints(int num, const Vector3d& scale, std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  std::vector<Vector3d> points;
  for (int i = 0; i < num; ++i) {
    // In braces, so that they are drawn in this order.
    points.push_back(
        scale.cwiseProduct(Vector3d{normal(*random), normal(*random), normal(*random)}));
  }
  return points;
}

/// Every point is within the slack of the hull, and some point is about that far: the kept points
/// are some of the given ones. `scale`: how far they reach along each axis; where they are flat,
/// directions near the flat one tell most.
void ExpectStandsFor(const Hull& hull, const std::vector<Vector3d>& points, std::size_t most,
                     const Vector3d& scale) {
  ASSERT_FALSE(hull.points.empty());
  EXPECT_LE(hull.points.size(), most);
  for (const Vector3d& point : hull.points) {
    EXPECT_NE(std::find(points.begin(), points.end(), point), points.end());
  }
  std::mt19937_64 random(3);
  double beyond = 0;
  const auto inverse = [](double s) { return s > 0 ? 1 / s : 0; };
  for (const Vector3d& d : RandomPoints(2000, scale.unaryExpr(inverse), &random)) {
    const Vector3d direction = d.normalized();
    beyond = std::max(beyond, Support(points, direction) - Support(hull.points, direction));
  }
  EXPECT_LE(beyond, hull.slack + 1e-12);
  EXPECT_GE(beyond, 0.7 * hull.slack - 2e-5);  // as far as the directions tell
}

TEST(HullTest, KeepsThePointsThatReachFurthest) {
  std::mt19937_64 random(1);
  for (const Vector3d& scale : {Vector3d(1, 1, 1), Vector3d(1, 0.1, 0.01), Vector3d(1, 1, 0),
                                Vector3d(1, 0, 0), Vector3d(0, 0, 0)}) {
    const std::vector<Vector3d> points = RandomPoints(500, scale, &random);
    for (const std::size_t most : {1, 2, 4, 16, 64}) {
      SCOPED_TRACE(most);
      ExpectStandsFor(MakeHull(points, most), points, most, scale);
    }
  }
}

TEST(HullTest, LosesNothingOfABoxWhoseFacesAreFullOfPoints) {
  std::vector<Vector3d> points;
  for (double x = 0; x <= 1; x += 0.125) {
    for (double y = 0; y <= 1; y += 0.125) {
      for (const double z : {0, 1}) points.emplace_back(x, y, z);
    }
  }
  const Hull hull = MakeHull(points, 16);
  EXPECT_LE(hull.slack, 1e-5);
  ExpectStandsFor(hull, points, 16, Vector3d::Ones());
}

TEST(HullTest, MorePointsOfABallReachFurther) {
  std::mt19937_64 random(2);
  std::vector<Vector3d> points = RandomPoints(2000, Vector3d::Ones(), &random);
  for (Vector3d& point : points) point.normalize();
  double before = 1;
  for (const std::size_t most : {8, 16, 32, 64, 128}) {
    const double slack = MakeHull(points, most).slack;
    EXPECT_LT(slack, 0.8 * before);
    before = slack;
  }
  EXPECT_LT(before, 0.05);
}

TEST(HullTest, FewPointsStayAsTheyAre) {
  const std::vector<Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  const Hull hull = MakeHull(points, 2);
  EXPECT_EQ(hull.points.size(), 2u);
  EXPECT_EQ(hull.slack, 0);
  EXPECT_EQ(Diameter(hull.points), 1);
  EXPECT_EQ(Diameter({}), 0);
}

}  // namespace
}  // namespace planbench
