#pragma once

#include <vector>

#include "collision/collision_model.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// The spheres that stand for a robot in a model other than kMeshes.
inline const std::vector<LinkSphere>& ModelSpheres(const Robot& robot, CollisionModel model) {
  return model == CollisionModel::kEnclosing ? robot.enclosing_spheres : robot.spheres;
}

}  // namespace planbench
