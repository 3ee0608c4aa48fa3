#include "planner_ara/recalled_paths.h"

#include <algorithm>
#include <utility>

#include "common/numbers.h"
#include "planner_ara/goal_distance.h"

namespace planbench {

RecalledPaths::RecalledPaths(const JointSpace& space, const Lattice& lattice,
                             std::vector<double> weights, std::span<const Path> paths)
    : space_(&space), weights_(std::move(weights)) {
  for (const Path& path : paths) {
    int before = kNone;
    for (const Configuration& q : path) {
      Waypoint waypoint;
      for (int j = 0; j < lattice.num_joints(); ++j) {
        waypoint.coordinates.push_back(lattice.Nearest(j, q[static_cast<std::size_t>(j)]));
        waypoint.q.push_back(lattice.Value(j, waypoint.coordinates.back()));
      }
      if (before != kNone && std::ranges::equal(CoordinatesOf(before), waypoint.coordinates)) {
        continue;
      }
      waypoint.neighbours[1] = before;
      const auto number = static_cast<int>(waypoints_.size());
      if (before != kNone) waypoints_.back().neighbours[0] = number;
      before = number;
      waypoints_.push_back(std::move(waypoint));
    }
  }
}

std::array<int, 2> RecalledPaths::NeighboursOf(std::span<const Lattice::Coordinate> point,
                                               std::span<const double> q) const {
  int nearest = kNone;
  double least = kInfinity;
  for (const Waypoint& waypoint : waypoints_) {
    if (std::ranges::equal(waypoint.coordinates, point)) {
      const auto [after, before] = waypoint.neighbours;
      return after == kNone ? std::array{before, kNone} : waypoint.neighbours;
    }
    const double distance = WeightedDistance(*space_, weights_, q, waypoint.q);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(&waypoint - waypoints_.data());
  }
  return {nearest, kNone};
}

}  // namespace planbench
