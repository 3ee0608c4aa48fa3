#pragma once

#include "common/yaml.h"
#include "scene/frame_tree.h"
#include "scene/scene.h"

namespace planbench {

/// Adds the `octomap` of a moveit_msgs/PlanningSceneWorld, if it has data, to `scene` as an object
/// kOctomapId of boxes. The data are bytes (YamlNode::Bytes), or, as robowflex writes them, the
/// hexadecimal digits of a zlib stream of at most 16 MiB of bytes. Throws InputError.
void AddOctomap(const YamlNode& world, const FrameTree& frames, Scene* scene);

}  // namespace planbench
