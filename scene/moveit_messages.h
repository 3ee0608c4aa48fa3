#pragma once

#include <string>

#include "common/yaml.h"

namespace planbench {

/// Refuses (InputError) every field, at any depth of `message`, that the message of that type
/// ("moveit_msgs/PlanningScene", "moveit_msgs/MotionPlanRequest") does not have, and names the
/// field it was probably meant to be or the place where it belongs, below it if there is one. Keys
/// of the message itself that begin with "x-" may hold anything, for anchors. Fields that the
/// dialects of MotionBenchMaker and robowflex add count as the message's own; what is not a map
/// where a message has fields is left to the reader.
void RequireKnownFields(const YamlNode& message, const std::string& type);

}  // namespace planbench
