#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "common/golden_section.h"

namespace planbench {

/// From a to b, m; a point if they are equal.
struct Segment {
  Eigen::Vector3d a, b;
};

/// The least value on a segment, or `at_most` if that is less, of the distance from a convex body:
/// by golden sections, so what it is within 1e-12 of the segment's length of the place.
template <typename Distance>
double LeastOnSegment(const Segment& segment, double at_most, const Distance& distance) {
  const double length = (segment.b - segment.a).norm();
  const Eigen::Vector3d middle = (segment.a + segment.b) / 2;
  double least = distance(middle);
  if (least - length / 2 >= at_most) return at_most;
  if (length > 0) {
    const auto at = [&](double t) {
      const double value = distance(Eigen::Vector3d(segment.a + t * (segment.b - segment.a)));
      least = std::min(least, value);
      return value;
    };
    // Nothing that is left is further than 0.191 of it from where the distance is known, and so the
    // distance nowhere less by more.
    LeastByGoldenSections(0, 1, at, [&](double low, double high) {
      return least <= 0 || least - 0.191 * (high - low) * length >= at_most;
    });
  }
  return std::min(least, at_most);
}

}  // namespace planbench
