#pragma once

#include <span>
#include <vector>

#include "robot_model/motion_bound.h"
#include "scene/scene.h"

namespace planbench {

/// Bounds the motion of a robot's geometry and of what is attached to it. The bounds of the robot
/// alone, whose geometry may be many vertices, are kept for as long as the held joints stay.
class GeometryBound {
 public:
  /// `geometry`: balls that cover the robot's. Holds references to model and group.
  GeometryBound(const RobotModel& model, const PlanningGroup& group,
                const std::vector<LinkSphere>& geometry);

  /// `base_positions`: full positions, at which joints outside the group are held. The links that
  /// objects are attached to are known.
  void Set(const Scene& scene, std::span<const double> base_positions);

  // Of what was set last.
  MotionBound OfAll() const;
  const MotionBound& OfLink(int link) const { return links_[static_cast<std::size_t>(link)]; }
  /// By place in the scene's list.
  const MotionBound& OfAttached(int index) const {
    return attached_[static_cast<std::size_t>(index)];
  }

 private:
  const RobotModel* model_;
  const PlanningGroup* group_;
  std::vector<std::vector<LinkSphere>> geometry_;  ///< By link.
  std::vector<double> held_;                       ///< That links_ are of.
  std::vector<MotionBound> links_;
  std::vector<MotionBound> attached_;
};

}  // namespace planbench
