#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// When a pose counts as reached, and how much is tried before it counts as out of reach.
/// An infinite tolerance leaves position or orientation free: it is not tried for at all.
struct IkOptions {
  double position_tolerance_m = 1e-6;
  double orientation_tolerance_rad = 1e-6;  ///< Of the rotation between the two orientations.
  int max_starts = 100;                     ///< Random configurations tried.
  int max_steps = 60;                       ///< Steps from each of them.
};

struct IkResult {
  bool solved = false;
  /// Within the limits, continuous joints in [-pi, pi); the nearest found if not solved.
  std::vector<double> q;
  double position_error_m = 0;       ///< At q; 0 if it is free.
  double orientation_error_rad = 0;  ///< Likewise.
  int starts = 0;                    ///< Configurations that were started from.
  int steps = 0;                     ///< Over all starts.
};

/// How far from a pose the nearest try was, for messages: "nearest: 0 m and 7.3e-06 rad off; 1e-06
/// m and 1e-06 rad are allowed".
std::string DescribeMiss(double off_m, double off_rad, const IkOptions& options);

/// Configurations of a planning group that bring its tip to a pose, with every other joint
/// held (those that follow a joint of the group move with it). Numerical, for any chain of
/// revolute, continuous and prismatic joints: from random configurations, damped least-squares
/// steps on position and orientation whose damping follows the remaining error (Sugihara,
/// "Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method", IEEE T-RO 27(5),
/// 2011). Steps end at the joint limits; a joint that a step would push further out is left out of
/// that step. Redundant joints stay near where the random configuration had them, so that repeated
/// calls give different solutions.
///
/// Not thread-safe: one instance a thread. Keeps no reference to the model.
class InverseKinematics {
 public:
  /// `base_positions`: full positions, at which joints outside the group are held. `X_LT`: pose, in
  /// the group's tip link, of the tip T that poses are of.
  InverseKinematics(const RobotModel& model, const PlanningGroup& group,
                    std::span<const double> base_positions,
                    const Eigen::Isometry3d& X_LT = Eigen::Isometry3d::Identity());

  /// A configuration with the tip at X_BT (base frame). Its result depends on the pose, the
  /// state of `random` and the options only. Ends after options.max_starts starts of
  /// options.max_steps steps each.
  IkResult Solve(const Eigen::Isometry3d& X_BT, std::mt19937_64* random,
                 const IkOptions& options = {});

  /// Group indices of the joints that move the tip.
  const std::vector<int>& moving_joints() const { return columns_; }

  /// Pose X_BT of the tip at q.
  Eigen::Isometry3d TipPose(std::span<const double> q);

 private:
  // A joint between the base and the tip that is in the group, or follows one that is.
  struct ChainJoint {
    int group_index;  // Its own or its leader's; it is at multiplier * q + offset.
    int column;       // Of the Jacobian: that group index's.
    double multiplier = 1;
    double offset = 0;
    bool prismatic;
    Eigen::Isometry3d X_PJ;  // Joint frame in the child frame of the chain joint before it.
    Eigen::Vector3d axis_J;
    Eigen::Vector3d axis_B = Eigen::Vector3d::Zero();  // At the q of the last TipPose.
    Eigen::Vector3d p_BJ = Eigen::Vector3d::Zero();    // Likewise.
  };
  using PoseError = Eigen::Vector<double, 6>;  // Position (m), rotation vector (rad), base frame.

  std::vector<double> RandomConfiguration(std::mt19937_64* random) const;
  // Steps from *q until the pose is reached or nothing improves any more; returns the error left.
  PoseError Descend(const Eigen::Isometry3d& X_BT, const IkOptions& options, std::vector<double>* q,
                    int* steps);
  // Moves q, whose tip is at p_BT and was computed last, to reduce `error`, of which those parts
  // count where `wanted` is 1 and not 0.
  void Step(const PoseError& error, const PoseError& wanted, const Eigen::Vector3d& p_BT,
            std::span<double> q) const;

  JointSpace space_;
  std::vector<ChainJoint> chain_;  // From the base outwards.
  std::vector<int> columns_;       // Group indices of the joints that move the tip.
  Eigen::Isometry3d X_LT_;         // The tip in the child frame of the last chain joint.
};

}  // namespace planbench
