#pragma once

#include <span>
#include <vector>

#include "robot_model/motion_bound.h"
#include "scene/scene.h"

namespace planbench {

/// Bounds the motion of a robot's geometry and of what is attached to it. The bound of the robot
/// alone, whose geometry may be many vertices, is kept for as long as the held joints stay.
class GeometryBound {
 public:
  /// `geometry`: balls that cover the robot's. Holds references to model and group.
  GeometryBound(const RobotModel& model, const PlanningGroup& group,
                std::vector<LinkSphere> geometry)
      : model_(&model), group_(&group), geometry_(std::move(geometry)) {}

  /// `base_positions`: full positions, at which joints outside the group are held. The links that
  /// objects are attached to are known.
  MotionBound Compute(const Scene& scene, std::span<const double> base_positions);

 private:
  const RobotModel* model_;
  const PlanningGroup* group_;
  std::vector<LinkSphere> geometry_;
  std::vector<double> held_;  // that robot_bound_ is of
  MotionBound robot_bound_;
};

}  // namespace planbench
