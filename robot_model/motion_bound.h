#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// A ball fixed to a link: a collision sphere, the bounding sphere of a shape, or a mesh vertex
/// (radius 0).
struct LinkBall {
  int link = -1;
  Eigen::Vector3d p_LS;  ///< Centre in the link's frame, m.
  double radius = 0;     ///< m
};

/// Upper bound of how far any point of a robot's collision geometry moves on a straight joint
/// motion: sum over joints of |dq_j| reach_j. reach_j (m/rad) bounds the distance from joint j's
/// axis of any ball's far side beyond joint j over all configurations of the joints beyond it,
/// within their limits; 1 for a prismatic joint that carries a ball, 0 for a joint that carries
/// none.
class MotionBound {
 public:
  MotionBound() = default;
  /// `base_positions`: full positions, at which joints outside the group are held.
  MotionBound(const RobotModel& model, const PlanningGroup& group,
              std::span<const double> base_positions, std::span<const LinkBall> balls);

  /// n values, group order.
  const std::vector<double>& reach() const { return reach_; }
  /// Bound for the straight motion between two configurations, m.
  double Between(const JointSpace& space, std::span<const double> from,
                 std::span<const double> to) const;

 private:
  std::vector<double> reach_;
};

}  // namespace planbench
