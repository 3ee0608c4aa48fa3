#include "collision/simd/hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "collision/simd/simplex.h"
#include "geometry/lexicographic_less.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

/// Nearer than this to a hull, m, points need not be kept.
constexpr double kNegligible = 1e-5;
/// Steps towards the nearest point of a hull.
constexpr int kMostSteps = 50;

/// An upper bound of the distance of a point from the hull of others, hardly more than it is.
double DistanceFrom(const std::vector<Vector3d>& hull, const Vector3d& point) {
  const auto first =
      std::min_element(hull.begin(), hull.end(), [&](const Vector3d& a, const Vector3d& b) {
        return (a - point).squaredNorm() < (b - point).squaredNorm();
      });
  Simplex<double> simplex;
  simplex.Add(*first - point);
  Vector3d to_hull = simplex.nearest();
  for (int i = 0; i < kMostSteps && to_hull.norm() > kNegligible; ++i) {
    const auto extreme = std::min_element(
        hull.begin(), hull.end(),
        [&](const Vector3d& a, const Vector3d& b) { return a.dot(to_hull) < b.dot(to_hull); });
    const Vector3d corner = *extreme - point;
    if (to_hull.dot(to_hull - corner) <= kNegligible * to_hull.norm()) break;
    if (simplex.encloses_origin()) break;  // but for rounding
    simplex.Add(corner);
    if (simplex.squared_distance() >= to_hull.squaredNorm()) break;
    to_hull = simplex.nearest();
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
