#pragma once

#include <string>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Content hash of a robot whose meshes count: of its content_id and of the files of the collision
/// meshes that its URDF names. Those that cannot be found are left out; who needs them fails.
std::string MeshRobotId(const Robot& robot);

}  // namespace planbench
