#pragma once

#include <Eigen/Core>

#include "common/golden_section.h"

namespace planbench {

/// From a to b, m; a point if they are equal.
struct Segment {
  Eigen::Vector3d a, b;
};

/// The least value on a segment of a convex function of points, such as the distance from a convex
/// body: by golden sections, so what it is within 1e-12 of the segment's length of the place.
template <typename Function>
double LeastOnSegment(const Segment& segment, const Function& function) {
  if (segment.a == segment.b) return function(segment.a);
  return LeastByGoldenSections(0, 1, 0, [&](double t) {
    return function(Eigen::Vector3d(segment.a + t * (segment.b - segment.a)));
  });
}

}  // namespace planbench
