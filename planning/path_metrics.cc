#include "planning/path_metrics.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace planbench {
namespace {

/// Unit vector of the straight motion, which must not be of zero length.
std::vector<double> DirectionOf(const JointSpace& space, const Configuration& from,
                                const Configuration& to, double length) {
  std::vector<double> direction(from.size());
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    direction[k] = space.Difference(j, from[k], to[k]) / length;
  }
  return direction;
}

/// Angle between unit vectors, accurate near 0 and pi too (Kahan), where the arc cosine is not.
double AngleBetween(const std::vector<double>& u, const std::vector<double>& v) {
  double sum_squared = 0;
  double difference_squared = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    sum_squared += (u[k] + v[k]) * (u[k] + v[k]);
    difference_squared += (u[k] - v[k]) * (u[k] - v[k]);
  }
  return 2 * std::atan2(std::sqrt(difference_squared), std::sqrt(sum_squared));
}

}  // namespace

double PathLength(const JointSpace& space, const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += space.Distance(path[i - 1], path[i]);
  return length;
}

double PathSmoothness(const JointSpace& space, const Path& path) {
  double smoothness = 0;
  std::vector<double> previous_direction;
  double previous_length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = space.Distance(path[i - 1], path[i]);
    if (length == 0) continue;
    std::vector<double> direction = DirectionOf(space, path[i - 1], path[i], length);
    if (previous_length > 0) {
      // The turn between the two directions is pi minus the angle between the two segments.
      const double turn = AngleBetween(previous_direction, direction);
      const double curvature = 2 * turn / (previous_length + length);
      smoothness += curvature * curvature;
    }
    previous_direction = std::move(direction);
    previous_length = length;
  }
  return smoothness;
}

}  // namespace planbench
