#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numbers>

namespace planbench {

/// From a to b, m; a point if they are equal.
struct Segment {
  Eigen::Vector3d a, b;
};

/// The least value on a segment of a convex function of points, such as the distance from a convex
/// body: by golden sections, so what it is within 1e-12 of the segment's length of the place.
template <typename Function>
double LeastOnSegment(const Segment& segment, const Function& function) {
  constexpr int kSections = 60;
  constexpr double kGolden = std::numbers::phi - 1;
  const double at_a = function(segment.a);
  if (segment.a == segment.b) return at_a;
  const auto at = [&](double t) {
    return function(Eigen::Vector3d(segment.a + t * (segment.b - segment.a)));
  };
  double low = 0;
  double high = 1;
  double left = 1 - kGolden;
  double right = kGolden;
  double at_left = at(left);
  double at_right = at(right);
  double least = std::min(at_a, function(segment.b));
  for (int i = 0; i < kSections; ++i) {
    least = std::min({least, at_left, at_right});
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = at(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = at(right);
    }
  }
  return std::min({least, at_left, at_right});
}

}  // namespace planbench
