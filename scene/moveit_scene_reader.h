#pragma once

#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_model.h"
#include "scene/frame_tree.h"
#include "scene/scene.h"

namespace planbench {

// Parts of a moveit_msgs/PlanningScene. All throw InputError naming file, line and field.

/// Refuses a file that holds nothing of a scene, so that a scene without obstacles does not come
/// out of a wrong file, fields that the message does not have, and link padding and scale. Any
/// field will do: all are optional.
void RequireScene(const YamlNode& planning_scene);

/// fixed_frame_transforms, canonical, in file order.
std::vector<FixedTransform> ReadFixedTransforms(const YamlNode& planning_scene);

/// A moveit_msgs/AllowedCollisionMatrix; it must be symmetric. Simplified, without each `false`
/// that asks for what is checked anyway: those of links that a joint of the robot connects stay.
AllowedCollisionMatrix ReadAllowedCollisions(const YamlNode& matrix, const RobotModel& model);

}  // namespace planbench
