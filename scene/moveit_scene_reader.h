#pragma once

#include <vector>

#include "common/yaml.h"
#include "scene/frame_tree.h"
#include "scene/scene.h"

namespace planbench {

// Parts of a moveit_msgs/PlanningScene. All throw InputError naming file, line and field.

/// Refuses a file that is something else, say a request: every field of a scene is optional, and a
/// scene without obstacles must not come out of a wrong file. Refuses fields that the message does
/// not have, and link padding and scale.
void RequireScene(const YamlNode& planning_scene);

/// fixed_frame_transforms, canonical, in file order.
std::vector<FixedTransform> ReadFixedTransforms(const YamlNode& planning_scene);

/// A moveit_msgs/AllowedCollisionMatrix; it must be symmetric. Simplified.
AllowedCollisionMatrix ReadAllowedCollisions(const YamlNode& matrix);

}  // namespace planbench
