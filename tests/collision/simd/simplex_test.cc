#include "collision/simd/simplex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace planbench {
namespace {

template <typename Scalar>
using Vector = typename Simplex<Scalar>::Vector;

/// Points about a middle.
template <typename Scalar>
std::vector<Vector<Scalar>> PointsAbout(const Vector<Scalar>& middle, const Vector<Scalar>& scale,
                                        int num, std::mt19937_64* random) {
  std::uniform_real_distribution<Scalar> uniform(-1, 1);
  std::vector<Vector<Scalar>> points;
  for (int i = 0; i < num; ++i) {
    // In braces, so that they are drawn in this order.
    const Vector<Scalar> at{uniform(*random), uniform(*random), uniform(*random)};
    points.push_back(middle + scale.cwiseProduct(at));
  }
  return points;
}

/// How far the points reach along a direction at least.
template <typename Scalar>
Scalar LeastAlong(const std::vector<Vector<Scalar>>& points, const Vector<Scalar>& direction) {
  Scalar least = direction.dot(points.front());
  for (const Vector<Scalar>& point : points) least = std::min(least, direction.dot(point));
  return least;
}

template <typename Scalar>
Simplex<Scalar> NearestOf(const std::vector<Vector<Scalar>>& points) {
  Simplex<Scalar> simplex;
  Vector<Scalar> nearest = points.front();
  for (int i = 0; i < 100 && !simplex.encloses_origin(); ++i) {
    const auto extreme = std::min_element(points.begin(), points.end(), [&](auto& a, auto& b) {
      return a.dot(nearest) < b.dot(nearest);
    });
    simplex.Add(*extreme);
    nearest = simplex.nearest();
  }
  return simplex;
}

template <typename Scalar>
class SimplexTest : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SimplexTest, Scalars);

// The plane through the nearest point, across the line to it, has all points behind it: so it is
// the nearest one of their hull.
TYPED_TEST(SimplexTest, FindsThePointOfAHullThatIsNearest) {
  const TypeParam tolerance = 100 * std::numeric_limits<TypeParam>::epsilon();
  std::mt19937_64 random(1);
  for (const Vector<TypeParam>& scale : {Vector<TypeParam>(1, 1, 1), Vector<TypeParam>(1, 1, 0),
                                         Vector<TypeParam>(1, 0, 0), Vector<TypeParam>(0, 0, 0)}) {
    for (int i = 0; i < 200; ++i) {
      const auto middles = PointsAbout<TypeParam>({0, 0, 2.5}, {3, 3, 1}, 1, &random);
      const auto points = PointsAbout<TypeParam>(middles.front(), scale, 1 + i % 20, &random);
      const Simplex<TypeParam> simplex = NearestOf<TypeParam>(points);
      ASSERT_FALSE(simplex.encloses_origin());
      const Vector<TypeParam>& nearest = simplex.nearest();
      EXPECT_NEAR(simplex.squared_distance(), nearest.squaredNorm(), tolerance);
      EXPECT_GE(LeastAlong<TypeParam>(points, nearest), nearest.squaredNorm() - 10 * tolerance);
    }
  }
}

TYPED_TEST(SimplexTest, TellsThatTheOriginIsInside) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    auto points = PointsAbout<TypeParam>({0, 0, 0}, {1, 1, 1}, 20, &random);
    for (int k = 0; k < 20; ++k) points.push_back(-points[static_cast<std::size_t>(k)]);
    const Simplex<TypeParam> simplex = NearestOf<TypeParam>(points);
    EXPECT_LE(simplex.squared_distance(), std::numeric_limits<TypeParam>::epsilon());
  }
}

// Equal points, and points in a row, have no area.
TYPED_TEST(SimplexTest, StaysWithPointsThatDoNotReachFurther) {
  Simplex<TypeParam> simplex;
  simplex.Add({1, 0, 1});
  simplex.Add({1, 0, 1});
  EXPECT_EQ(simplex.nearest(), (Vector<TypeParam>{1, 0, 1}));
  simplex.Add({-1, 0, 1});
  EXPECT_EQ(simplex.nearest(), (Vector<TypeParam>{0, 0, 1}));
  simplex.Add({0, 0, 1});
  EXPECT_EQ(simplex.nearest(), (Vector<TypeParam>{0, 0, 1}));
  EXPECT_FALSE(simplex.encloses_origin());
}

}  // namespace
}  // namespace planbench
