#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "planner_trajopt/trajectory_cost.h"
#include "planner_trajopt/trajopt_settings.h"

namespace planbench {

/// Where the optimisers begin: the straight motion; then motions by way of random points. Of
/// several drawn, the cheapest is taken. The points lie anywhere between the straight motion and
/// configurations drawn from the whole space.
class InitialGuesses {
 public:
  /// `space` and `cost` must outlive it.
  InitialGuesses(const JointSpace& space, const Configuration& start, const Configuration& goal,
                 const TrajoptSettings& settings, const TrajectoryCost* cost, std::uint64_t seed)
      : space_(space),
        start_(start),
        goal_(goal),
        num_inner_(settings.waypoints),
        cost_(cost),
        random_(seed) {}

  /// Any of those drawn if looking for the cheapest was stopped (TrajectoryCost::StopWhen).
  Trajectory Next();
  /// How many there were.
  int count() const { return count_; }

 private:
  Trajectory DrawByWayOf(int num_points);

  const JointSpace& space_;
  Configuration start_;
  Configuration goal_;
  int num_inner_;
  const TrajectoryCost* cost_;
  std::mt19937_64 random_;
  int count_ = 0;
};

}  // namespace planbench
