#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "common/yaml.h"

namespace planbench {

inline constexpr double kFarthestAway = 1e9;  ///< m; poses are multiplied, and must stay finite

// Pieces that several MoveIt messages share. Every function throws InputError naming file, line and
// field. What a message leaves out is zero, as ROS has it; an orientation that is, no rotation.

/// A name: not empty, in one line.
std::string ReadName(const YamlNode& node);

/// geometry_msgs/Point or Vector3: [x, y, z] or {x: .., y: .., z: ..}.
Eigen::Vector3d ReadVector3(const YamlNode& node);

/// Throws, at `node`, for a position (m) that is too far away to be reckoned with.
void RequireNear(const Eigen::Vector3d& position, const YamlNode& node);

/// geometry_msgs/Quaternion: [x, y, z, w] or a map of the four. Normalised; its length must be 1
/// within 5 %. As in MoveIt, one of nothing but zeros is the identity, and so is one that has a w
/// alone, of whatever length. Warns of a length that is off by more than rounding to a few digits
/// makes it.
Eigen::Quaterniond ReadQuaternion(const YamlNode& node);
/// The same for one whose numbers stand elsewhere; what is wrong with it is said at `node`, of
/// `subject` ("the rotation ").
Eigen::Quaterniond Normalised(const Eigen::Quaterniond& q, const YamlNode& node,
                              const std::string& subject = "");

/// geometry_msgs/Pose: {position: .., orientation: ..}. Canonical (scene/pose.h).
Eigen::Isometry3d ReadPose(const YamlNode& node);
/// geometry_msgs/Transform: {translation: .., rotation: ..}. Canonical.
Eigen::Isometry3d ReadTransform(const YamlNode& node);

/// Whether all seven numbers of a geometry_msgs/Pose are zero, as messages leave it unset.
bool IsUnsetPose(const YamlNode& pose);

/// header.frame_id of a message without leading slashes, "" if it has none.
std::string ReadFrame(const YamlNode& message);
/// Where ReadFrame's frame stands, for messages about it.
YamlNode FrameNode(const YamlNode& message);

/// The elements of an optional sequence, none if `key` is absent.
std::vector<YamlNode> OptionalElements(const YamlNode& message, const std::string& key);

/// Throws if the optional sequence `key` has elements; `why` says what is not supported.
void RefuseElements(const YamlNode& message, const std::string& key, const std::string& why);

/// A flag: true, false, or, as some tools write uint8, 1 or 0.
bool ReadFlag(const YamlNode& node);

}  // namespace planbench
