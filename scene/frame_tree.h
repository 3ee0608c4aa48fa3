#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// One of a scene's fixed_frame_transforms.
struct FixedTransform {
  std::string header;  ///< Frames, without a leading slash; the header's may be "".
  std::string child;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  YamlNode node;
};

/// What a file says of the frame that it is in.
struct PlanningFrame {
  std::string name;                       ///< "" if the file does not name it.
  std::optional<Eigen::Isometry3d> X_WR;  ///< Pose of the robot's root link, if given.
  std::optional<YamlNode> node;           ///< Where that pose stands.
};

/// Poses of named frames in the robot's base frame B (that of its root link): the robot's links at
/// the start, the planning frame (also named ""), fixed frames, objects and their subframes.
///
/// Of a fixed transform between a frame that is known and one that is not, the numbers are the pose
/// of the latter in the former, whichever of the two the header names. That is what MoveIt means,
/// which writes the planning frame as the child, and what tf means, where it is the header. Chains
/// are followed. The planning frame, if neither a link nor joined to one, is where it has the root
/// link at X_WR, by default at its origin. The parent frame of a fixed virtual joint is, unless the
/// file says otherwise, at its child link.
class FrameTree {
 public:
  /// Throws InputError, at its node, for a transform that contradicts others (by more than 1e-6),
  /// and for a root link that has a pose in a frame of the robot itself.
  FrameTree(const Robot& robot, std::span<const double> start_positions,
            const PlanningFrame& planning_frame, const std::vector<FixedTransform>& transforms);

  /// Adds a frame of an object; those of the robot's links and surroundings and the planning frame
  /// keep their meaning.
  void AddObjectFrame(const std::string& name, const Eigen::Isometry3d& X_BF);

  /// X_BF of a frame, null if it is unknown. A leading slash in `name` does not count.
  const Eigen::Isometry3d* Find(const std::string& name) const;
  /// The same; throws InputError at `node` for an unknown one.
  const Eigen::Isometry3d& At(const std::string& name, const YamlNode& node) const;

 private:
  // Places the frame by the pose that a file gives the robot in it.
  void Place(const PlanningFrame& planning_frame);
  // Places the surroundings that the robot is fixed in.
  void PlaceSurroundings(const Robot& robot);
  // Follows the transforms from known frames to unknown ones, as far as they go.
  void Follow(const std::vector<FixedTransform>& transforms);
  void CheckAgreement(const std::vector<FixedTransform>& transforms) const;

  std::set<std::string> not_of_objects_;  // Names that no object takes.
  std::map<std::string, Eigen::Isometry3d> X_BF_;
};

/// A name of tf without its leading slash.
std::string WithoutSlash(const std::string& frame);

}  // namespace planbench
