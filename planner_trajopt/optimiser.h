#pragma once

#include <vector>

#include "planner_trajopt/trajectory.h"

namespace planbench {

/// Improves trajectories by its iterations; the ends stay.
class Optimiser {
 public:
  virtual ~Optimiser() = default;
  Optimiser(const Optimiser&) = delete;
  Optimiser& operator=(const Optimiser&) = delete;

  /// The next trajectory is another one.
  virtual void Restart() = 0;
  /// One iteration, left undone if it is stopped (TrajectoryCost::StopWhen); rows stay within the
  /// joint limits. `distances`: of the trajectory's rows, see TrajectoryCost.
  virtual void Iterate(const std::vector<double>& distances, Trajectory* trajectory) = 0;

 protected:
  Optimiser() = default;
};

}  // namespace planbench
