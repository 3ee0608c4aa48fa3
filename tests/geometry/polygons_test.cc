#include "geometry/polygons.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "geometry/lexicographic_less.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

Vector3d AreaVector(const Polygon& polygon) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]) / 2;
  }
  return sum;
}

// n - 2 triangles, of whose edges those of the polygon are run through once as they are in it, and
// others in either direction.
void ExpectWhole(const Polygon& polygon) {
  const auto triangles = Triangulate(polygon);
  const auto n = static_cast<std::uint32_t>(polygon.size());
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++balance[{t[k], t[(k + 1) % 3]}];
      --balance[{t[(k + 1) % 3], t[k]}];
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    --balance[{i, (i + 1) % n}];
    ++balance[{(i + 1) % n, i}];
  }
  for (const auto& [edge, number] : balance) EXPECT_EQ(number, 0);
}

// Exactly what is within: no triangle is turned over, and together they have the polygon's area.
void ExpectExact(const Polygon& polygon) {
  ExpectWhole(polygon);
  const Vector3d whole = AreaVector(polygon);
  const double tolerance = 1e-9 * whole.norm();
  double area = 0;
  for (const auto& [a, b, c] : Triangulate(polygon)) {
    const double part = AreaVector({polygon[a], polygon[b], polygon[c]}).dot(whole.normalized());
    EXPECT_GT(part, -tolerance);
    area += std::abs(part);
  }
  EXPECT_NEAR(area, whole.norm(), 100 * tolerance);
}

class TriangulateTest : public testing::Test {
 protected:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  // Somewhere, of some size.
  Polygon Placed(const Polygon& polygon) {
    const double angle = Uniform(0, 6);
    const Vector3d axis(Uniform(0.1, 1), Uniform(-1, 1), Uniform(-1, 1));
    const Eigen::AngleAxisd turn(angle, axis.normalized());
    const double size = std::pow(10, Uniform(-4, 2));
    const Vector3d to(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1));
    Polygon placed;
    for (const Vector3d& p : polygon) placed.push_back(size * (turn * p + to));
    return placed;
  }

  // With more corners in a row on some edges.
  Polygon Divided(const Polygon& polygon) {
    Polygon divided;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      divided.push_back(polygon[i]);
      if (Uniform(0, 1) < 0.5) continue;
      divided.emplace_back((polygon[i] + polygon[(i + 1) % polygon.size()]) / 2);
    }
    return divided;
  }

  std::mt19937_64 random_{1};
};

TEST_F(TriangulateTest, ConvexOnesAreFans) {
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  const Polygon square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(Triangulate(square), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(Triangulate(std::span(square).first(3)), (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(Triangulate(std::span(square).first(2)).empty());
}

// The corners of each triangle, in order, of them all.
std::vector<std::vector<Vector3d>> Cut(const Polygon& polygon) {
  std::vector<std::vector<Vector3d>> cut;
  for (const auto& triangle : Triangulate(polygon)) {
    std::vector<Vector3d>& corners = cut.emplace_back();
    for (const std::uint32_t corner : triangle) corners.push_back(polygon[corner]);
    std::sort(corners.begin(), corners.end(), LexicographicLess);
  }
  std::sort(cut.begin(), cut.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), LexicographicLess);
  });
  return cut;
}

TEST_F(TriangulateTest, BothSidesAreCutAlikeWhereverTheyBegin) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> radius(0.2, 1);
  Polygon star;
  for (int i = 0; i < 9; ++i) {
    const double angle = 2 * std::numbers::pi * i / 9;
    const double r = radius(generator);
    star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.3 * r * std::cos(angle));
  }
  for (const Polygon& polygon : {star, Polygon{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}) {
    const auto cut = Cut(polygon);
    Polygon other = polygon;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      std::rotate(other.begin(), other.begin() + 1, other.end());
      EXPECT_EQ(Cut(other), cut);
      std::reverse(other.begin(), other.end());
      EXPECT_EQ(Cut(other), cut);
      ExpectExact(other);
    }
  }
}

TEST_F(TriangulateTest, StarsCombsAndFramesAreExact) {
  for (int trial = 0; trial < Trials(100); ++trial) {
    SCOPED_TRACE(trial);
    const int n = 5 + trial % 30;
    Polygon star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + Uniform(0, 0.9)) / n;
      const double radius = Uniform(0.2, 1);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    ExpectExact(Placed(Divided(star)));

    const int teeth = 2 + trial % 7;
    Polygon comb = {{0, 0, 0}, {2.0 * teeth, 0, 0}};
    for (int j = teeth; j > 0; --j) {
      for (const auto& [x, y] : {std::pair(0, 2), {-1, 2}, {-1, 1}, {-2, 1}}) {
        comb.emplace_back(2 * j + x, y, 0);
      }
    }
    ExpectExact(Placed(Divided(comb)));

    // The hole is cut out by way of a bridge.
    const int sides = 3 + trial % 8;
    Polygon frame;
    for (const double radius : {2.0, -0.5}) {
      for (int i = 0; i <= sides; ++i) {
        const double angle = std::copysign(2 * std::numbers::pi * (i % sides) / sides, radius);
        frame.emplace_back(std::abs(radius) * std::cos(angle), std::abs(radius) * std::sin(angle),
                           0);
      }
    }
    ExpectExact(Placed(frame));
    ExpectExact(Placed(Divided(frame)));
  }
}

TEST_F(TriangulateTest, OddOnesAreCutWithoutAGap) {
  const Vector3d o(0, 0, 0);
  const Vector3d x(1, 0, 0);
  ExpectWhole({o, Vector3d(1, 1, 0), x, Vector3d(0, 1, 0), Vector3d(-0.5, 0.5, 0)});
  ExpectWhole({o, x, 2 * x, 3 * x, 1.5 * x});
  ExpectWhole({o, o, o, o, o});
  ExpectWhole({o, x, x, Vector3d(1, 1, 0), Vector3d(0, 1, 0)});
  for (int trial = 0; trial < Trials(100); ++trial) {
    Polygon any;
    for (int i = 0; i < 4 + trial % 9; ++i) {
      const double px = Uniform(-1, 1);
      const double py = Uniform(-1, 1);
      any.emplace_back(px, py, Uniform(-1, 1));
    }
    ExpectWhole(any);
  }
}

}  // namespace
}  // namespace planbench
