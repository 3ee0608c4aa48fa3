#include "collision/simd/hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "geometry/lexicographic_less.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

/// Nearer than this to a hull, m, points need not be kept.
constexpr double kNegligible = 1e-5;
/// Steps towards the nearest point of a hull.
constexpr int kMostSteps = 50;

/// Up to four points.
struct Simplex {
  std::array<Vector3d, 4> corners;
  std::size_t size = 0;
};

/// The point of a simplex that is nearest to the origin, if that is inside of it or of a face of it
/// that has the last corner. Corners that it does not need are dropped.
Vector3d Nearest(Simplex* simplex) {
  const std::size_t last = simplex->size - 1;
  const Vector3d p = simplex->corners[last];
  Vector3d nearest = p;
  unsigned needed = 0;
  for (unsigned others = 1; others < 1u << last; ++others) {
    std::array<Vector3d, 3> edges;
    std::size_t num = 0;
    for (std::size_t i = 0; i < last; ++i) {
      if ((others >> i & 1) != 0) edges[num++] = simplex->corners[i] - p;
    }
    Vector3d weights = Vector3d::Zero();
    const auto& [a, b, c] = edges;
    if (num == 1) {
      weights[0] = -p.dot(a) / a.squaredNorm();
    } else if (num == 2) {
      const double ab = a.dot(b);
      const double determinant = a.squaredNorm() * b.squaredNorm() - ab * ab;
      weights[0] = (ab * p.dot(b) - b.squaredNorm() * p.dot(a)) / determinant;
      weights[1] = (ab * p.dot(a) - a.squaredNorm() * p.dot(b)) / determinant;
    } else {
      const double volume = a.dot(b.cross(c));
      weights = -Vector3d(p.dot(b.cross(c)), p.dot(c.cross(a)), p.dot(a.cross(b))) / volume;
    }
    // Not so of what is not a number, where the edges have no extent.
    if (!(weights.minCoeff() >= 0 && weights.sum() <= 1)) continue;
    Vector3d point = p;
    for (std::size_t i = 0; i < num; ++i) point += weights[static_cast<Eigen::Index>(i)] * edges[i];
    if (point.squaredNorm() >= nearest.squaredNorm()) continue;
    nearest = point;
    needed = others;
  }
  Simplex left;
  for (std::size_t i = 0; i <= last; ++i) {
    if (i == last || (needed >> i & 1) != 0) left.corners[left.size++] = simplex->corners[i];
  }
  *simplex = left;
  return nearest;
}

/// An upper bound of the distance of a point from the hull of others, hardly more than it is
/// (Gilbert, Johnson and Keerthi, A fast procedure for computing the distance between complex
/// objects, 1988).
double DistanceFrom(const std::vector<Vector3d>& hull, const Vector3d& point) {
  const auto first =
      std::min_element(hull.begin(), hull.end(), [&](const Vector3d& a, const Vector3d& b) {
        return (a - point).squaredNorm() < (b - point).squaredNorm();
      });
  Vector3d to_hull = *first - point;
  Simplex simplex;
  simplex.corners[simplex.size++] = to_hull;
  for (int i = 0; i < kMostSteps && to_hull.norm() > kNegligible; ++i) {
    const auto extreme = std::min_element(
        hull.begin(), hull.end(),
        [&](const Vector3d& a, const Vector3d& b) { return a.dot(to_hull) < b.dot(to_hull); });
    const Vector3d corner = *extreme - point;
    if (to_hull.dot(to_hull - corner) <= kNegligible * to_hull.norm()) break;
    if (simplex.size == simplex.corners.size()) break;  // rounding: it encloses the point
    simplex.corners[simplex.size++] = corner;
    const Vector3d nearer = Nearest(&simplex);
    if (nearer.squaredNorm() >= to_hull.squaredNorm()) break;
    to_hull = nearer;
  }
  return to_hull.norm();
}

/// All over the sphere (Fibonacci's lattice).
Vector3d Direction(std::size_t i, std::size_t num) {
  const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(num);
  const double angle = 2 * std::numbers::pi * std::numbers::phi * static_cast<double>(i);
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

Hull MakeHull(std::vector<Vector3d> points, std::size_t most) {
  std::sort(points.begin(), points.end(), LexicographicLess);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() <= most) return {std::move(points), 0};

  std::vector<Vector3d> kept;
  const auto keep = [&](const Vector3d& point) {
    if (std::find(kept.begin(), kept.end(), point) == kept.end()) kept.push_back(point);
  };
  for (std::size_t i = 0; i < most; ++i) {
    const Vector3d direction = Direction(i, most);
    keep(*std::max_element(points.begin(), points.end(), [&](const Vector3d& a, const Vector3d& b) {
      return a.dot(direction) < b.dot(direction);
    }));
  }
  // Distances fall as points are added: those of before are upper bounds.
  struct Outside {
    double distance;
    Vector3d point;
  };
  std::vector<Outside> outside;
  for (const Vector3d& point : points) outside.push_back({DistanceFrom(kept, point), point});
  const auto less = [](const Outside& a, const Outside& b) { return a.distance < b.distance; };
  std::make_heap(outside.begin(), outside.end(), less);
  const auto farthest = [&]() -> const Outside& {
    for (;;) {
      std::pop_heap(outside.begin(), outside.end(), less);
      Outside& last = outside.back();
      const double before = std::exchange(last.distance, DistanceFrom(kept, last.point));
      const bool stays = last.distance >= before - kNegligible;
      std::push_heap(outside.begin(), outside.end(), less);
      if (stays) return outside.front();
    }
  };
  while (kept.size() < most && farthest().distance > kNegligible) keep(outside.front().point);
  const double slack = farthest().distance;
  return {std::move(kept), slack};
}

double Diameter(const std::vector<Vector3d>& points) {
  double longest = 0;
  for (const Vector3d& a : points) {
    for (const Vector3d& b : points) longest = std::max(longest, (a - b).norm());
  }
  return longest;
}

}  // namespace planbench
