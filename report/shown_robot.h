#pragma once

#include <string>
#include <vector>

#include "collision/link_geometry.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// A robot, with what stands for it in 3D views if it has no spheres.
class ShownRobot {
 public:
  ShownRobot() = default;
  /// Reads the collision meshes of a robot without spheres.
  explicit ShownRobot(Robot robot);

  const Robot& robot() const { return robot_; }
  /// Of a robot without spheres: its collision geometry, meshes no finer than pictures need.
  const std::vector<LinkGeometry>& bodies() const { return bodies_; }
  /// Of a robot without spheres: why it has no bodies; empty if it has.
  const std::string& why_not() const { return why_not_; }

 private:
  Robot robot_;
  std::vector<LinkGeometry> bodies_;
  std::string why_not_;
};

}  // namespace planbench
