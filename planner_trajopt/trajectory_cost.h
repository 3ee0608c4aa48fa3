#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "collision/edge_checker.h"
#include "planner_trajopt/trajectory.h"

namespace planbench {

/// What the optimisers minimise: over the inner waypoints the cost of their distance from obstacles
/// times their speed, and over the motions between rows half their squared length (joint distance),
/// times a weight. Distances are the least of all pairs of bodies that are checked.
class TrajectoryCost {
 public:
  /// `clearance`: m, > 0; `smoothness`: the weight. The checker must outlive it.
  TrajectoryCost(EdgeChecker* edges, double clearance, double smoothness)
      : edges_(edges), clearance_(clearance), smoothness_(smoothness) {}

  double clearance() const { return clearance_; }
  double smoothness() const { return smoothness_; }
  void set_smoothness(double weight) { smoothness_ = weight; }

  /// Distances of many rows can take long. `should_stop` is asked between some dozens of them.
  void StopWhen(std::function<bool()> should_stop) { should_stop_ = std::move(should_stop); }
  /// Asks that. Whoever else does much for an iteration asks between its parts.
  bool ShouldStop() const { return should_stop_ && should_stop_(); }

  /// m, of every row, some dozens handed to the collision engine at once; the clearance where they
  /// are larger. Of meshes lower bounds, which take a thirtieth of the time. False, and the
  /// distances of no use, if it was stopped.
  bool FindDistances(const Trajectory& rows, std::vector<double>* distances) const;
  /// CHOMP's (Ratliff et al. 2009) of a distance: 0 from the clearance on, a parabola down to
  /// contact, linear within obstacles. m
  double OfDistance(double distance) const;
  double OfTrajectory(const Trajectory& trajectory, const std::vector<double>& distances) const;

 private:
  EdgeChecker* edges_;
  double clearance_;
  double smoothness_;
  std::function<bool()> should_stop_;
};

}  // namespace planbench
