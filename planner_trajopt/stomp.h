#pragma once

#include <optional>
#include <random>
#include <vector>

#include "planner_trajopt/optimiser.h"
#include "planner_trajopt/trajectory_cost.h"
#include "planner_trajopt/trajopt_settings.h"

namespace planbench {

/// STOMP (Kalakrishnan, Chitta, Theodorou, Pastor and Schaal, "STOMP: Stochastic Trajectory
/// Optimization for Motion Planning", ICRA 2011): noisy trajectories, whose noise is smooth, are
/// averaged waypoint by waypoint, the cheaper the more weight, and the average is smoothed. The
/// waypoints of all noisy trajectories go to the collision engine at once.
class Stomp final : public Optimiser {
 public:
  /// `space` and `cost` must outlive it.
  Stomp(const JointSpace& space, const TrajoptSettings& settings, const TrajectoryCost* cost,
        std::uint64_t seed);

  void Restart() override {}
  void Iterate(const std::vector<double>& distances, Trajectory* trajectory) override;

 private:
  /// Noisy trajectory k, with the ends.
  auto Rollout(int k) { return rollouts_.middleRows(k * num_rows_, num_rows_); }
  auto Rollout(int k) const { return rollouts_.middleRows(k * num_rows_, num_rows_); }
  /// Adds noise to the trajectory: of the inner waypoints of a joint it has the inverse of the
  /// metric of smoothness for its covariance, scaled. False if it was stopped.
  bool DrawRollouts(const Trajectory& trajectory);
  /// Of each noisy trajectory (column) at each inner waypoint (row). False if it was stopped.
  bool FindCosts();
  /// Of the inner waypoints, before it is smoothed. Nothing if it was stopped.
  std::optional<Trajectory> FindUpdate(const Trajectory& trajectory) const;

  const TrajectoryCost* cost_;
  JointBounds bounds_;
  Eigen::Index num_rows_;
  int num_rollouts_;
  Eigen::MatrixXd smoothing_;      ///< N x N, the paper's M, times the gain.
  Eigen::RowVectorXd deviations_;  ///< Of each joint's noise from one row to the next, rad or m.
  std::mt19937_64 random_;
  // Scratch:
  Trajectory rollouts_;  ///< One below the other.
  std::vector<double> distances_;
  Eigen::MatrixXd costs_;
};

}  // namespace planbench
