#include "planning/motion_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace planbench {
namespace {

/// Of a straight piece from rest to rest.
double PieceTime(const JointSpace& space, const std::vector<double>& direction, double length) {
  double speed = std::numeric_limits<double>::infinity();
  for (int j = 0; j < space.size(); ++j) {
    const double limit = space.joint(j).max_velocity > 0 ? space.joint(j).max_velocity : 1;
    speed = std::min(speed, limit / std::abs(direction[static_cast<std::size_t>(j)]));
  }
  return length >= speed * kTimeToFullSpeed ? length / speed + kTimeToFullSpeed
                                            : 2 * std::sqrt(length * kTimeToFullSpeed / speed);
}

/// Do two unit vectors point the same way?
bool AreParallel(const std::vector<double>& u, const std::vector<double>& v) {
  constexpr double kStraight = 1e-6;  // rad
  double sum_squared = 0;
  for (std::size_t k = 0; k < u.size(); ++k) sum_squared += (u[k] - v[k]) * (u[k] - v[k]);
  return sum_squared <= kStraight * kStraight;
}

}  // namespace

std::vector<double> DirectionOf(const JointSpace& space, const Configuration& from,
                                const Configuration& to, double length) {
  std::vector<double> direction(from.size());
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    direction[k] = space.Difference(j, from[k], to[k]) / length;
  }
  return direction;
}

double MotionTime(const JointSpace& space, const Path& path) {
  double time_s = 0;
  std::vector<double> direction;  // of the piece that goes on
  double length = 0;
  const auto end_piece = [&] {
    if (length > 0) time_s += PieceTime(space, direction, length);
  };
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double step = space.Distance(path[i - 1], path[i]);
    if (step == 0) continue;
    std::vector<double> next = DirectionOf(space, path[i - 1], path[i], step);
    if (length == 0 || !AreParallel(direction, next)) {
      end_piece();
      direction = std::move(next);
      length = 0;
    }
    length += step;
  }
  end_piece();
  return time_s;
}

}  // namespace planbench
