#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "scene/problem.h"

namespace planbench {

// Pieces that several MoveIt messages share. Every function throws InputError naming file, line and
// field.

/// geometry_msgs/Point or Vector3: [x, y, z] or {x: .., y: .., z: ..}.
Eigen::Vector3d ReadVector3(const YamlNode& node);

/// geometry_msgs/Quaternion: [x, y, z, w] or a map of the four. Normalised; its length must be 1
/// within 1e-3.
Eigen::Quaterniond ReadQuaternion(const YamlNode& node);

/// geometry_msgs/Pose: {position: .., orientation: ..}. Canonical (scene/pose.h).
Eigen::Isometry3d ReadPose(const YamlNode& node);

/// header.frame_id of a message, "" without one.
std::string ReadFrame(const YamlNode& message);

/// The elements of an optional sequence, none if `key` is absent.
std::vector<YamlNode> OptionalElements(const YamlNode& message, const std::string& key);

/// Throws if the optional sequence `key` has elements; `why` says what is not supported.
void RefuseElements(const YamlNode& message, const std::string& key, const std::string& why);

/// joint_state of a moveit_msgs/RobotState: names with as many positions, none twice. Empty without
/// one. Refuses multi-DOF joint states.
JointState ReadJointState(const YamlNode& robot_state);

}  // namespace planbench
