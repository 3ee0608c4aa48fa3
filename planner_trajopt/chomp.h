#pragma once

#include <optional>
#include <vector>

#include "planner_trajopt/optimiser.h"
#include "planner_trajopt/trajectory_cost.h"
#include "planner_trajopt/trajopt_settings.h"

namespace planbench {

/// CHOMP (Ratliff, Zucker, Bagnell and Srinivasa, "CHOMP: Gradient Optimization Techniques for
/// Efficient Motion Planning", ICRA 2009): covariant gradient descent in the metric of velocities,
/// with the functional gradient of cost times speed and a smooth correction of joint limits, as the
/// authors' program has it. Gradients of the distance are central differences, all waypoints' at
/// once.
class Chomp final : public Optimiser {
 public:
  /// `space` and `cost` must outlive it.
  Chomp(const JointSpace& space, const TrajoptSettings& settings, const TrajectoryCost* cost);

  void Restart() override;
  void Iterate(const std::vector<double>& distances, Trajectory* trajectory) override;

 private:
  /// Of the obstacles' cost, N x n. Nothing if it was stopped.
  std::optional<Trajectory> FunctionalGradient(const std::vector<double>& distances,
                                               const Trajectory& trajectory);
  /// Joint by joint, the waypoint furthest outside is brought to its limit and takes the others
  /// along smoothly; what is still outside after some of these is cut off.
  void KeepWithinLimits(Trajectory* trajectory) const;

  const TrajectoryCost* cost_;
  JointBounds bounds_;
  Eigen::MatrixXd inverse_metric_;  ///< N x N.
  double gradient_step_;
  double max_step_;
  double step_ = 0;  ///< Limit of the next motion of a joint, rad or m.
  double last_cost_ = 0;
  // Scratch:
  Trajectory probes_;
  std::vector<double> probe_distances_;
};

}  // namespace planbench
