#pragma once

#include <span>
#include <utility>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Upper bound of how far any point of a robot's collision geometry moves on a straight joint
/// motion. The geometry is given as balls: collision spheres, bounding spheres of shapes, mesh
/// vertices (radius 0). The bound is the sum over joints of |dq_j| reach_j. reach_j (m/rad) bounds
/// the distance from joint j's axis of any ball's far side beyond joint j over all configurations
/// of the joints beyond it, within their limits; 1 for a prismatic joint that carries a ball, 0 for
/// a joint that carries none. What the joints that follow joint j add is in reach_j.
class MotionBound {
 public:
  MotionBound() = default;
  /// `base_positions`: full positions, at which joints outside the group are held.
  MotionBound(const RobotModel& model, const PlanningGroup& group,
              std::span<const double> base_positions, std::span<const LinkSphere> balls);
  explicit MotionBound(std::vector<double> reach) : reach_(std::move(reach)) {}

  /// n values, group order.
  const std::vector<double>& reach() const { return reach_; }
  /// Bound for the straight motion between two configurations, m.
  double Between(const JointSpace& space, std::span<const double> from,
                 std::span<const double> to) const;

 private:
  std::vector<double> reach_;
};

}  // namespace planbench
