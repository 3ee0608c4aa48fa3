#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "planner_ara/lattice.h"
#include "planning/plan_result.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// Paths that were found before, as further edges of a lattice, the way experience graphs have them
/// (Phillips, Cohen, Chitta and Likhachev, "E-Graphs: Bootstrapping planning with experience
/// graphs", RSS 2012): waypoints, each moved to the nearest point of the lattice, are joined to
/// those before and after them, every other point of the lattice to the waypoint nearest to it. A
/// point that several waypoints have moved to is joined along the first path that has it there.
class RecalledPaths {
 public:
  static constexpr int kNone = -1;

  /// `weights`: of the joints in distances. The joint space must outlive this.
  RecalledPaths(const JointSpace& space, const Lattice& lattice, std::vector<double> weights,
                std::span<const Path> paths);

  /// The waypoints that a point of the lattice, whose configuration is q, is joined to, then kNone.
  std::array<int, 2> NeighboursOf(std::span<const Lattice::Coordinate> point,
                                  std::span<const double> q) const;
  std::span<const Lattice::Coordinate> CoordinatesOf(int waypoint) const {
    return waypoints_[static_cast<std::size_t>(waypoint)].coordinates;
  }
  std::span<const double> ConfigurationOf(int waypoint) const {
    return waypoints_[static_cast<std::size_t>(waypoint)].q;
  }

 private:
  struct Waypoint {
    std::vector<Lattice::Coordinate> coordinates;
    Configuration q;
    std::array<int, 2> neighbours{kNone, kNone};  // after and before it
  };

  const JointSpace* space_;
  std::vector<double> weights_;
  std::vector<Waypoint> waypoints_;
};

}  // namespace planbench
