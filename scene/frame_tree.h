#pragma once

#include <Eigen/Geometry>
#include <map>
#include <set>
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

/// Where a state has a link of the robot in its surroundings: the pose of a virtual joint.
struct PlacedLink {
  std::string joint;  ///< "" for a joint that the robot's description does not have.
  int link = 0;
  std::string frame;  ///< F, without a leading slash; "" is the planning frame.
  Eigen::Isometry3d X_FL = Eigen::Isometry3d::Identity();
  YamlNode node;  ///< Where the pose stands.
};

/// How the robot stands.
struct Stance {
  std::vector<double> positions;  ///< Of all its joints (RobotModel::position_names).
  std::vector<PlacedLink> placed_links;
};

/// Poses of named frames in the robot's base frame B (that of its root link), with the robot in one
/// stance: the robot's links, its surroundings, the planning frame (also named ""), fixed frames,
/// objects and their subframes.
///
/// Of a fixed transform between a frame that is known and one that is not, the numbers are the pose
/// of the latter in the former, whichever of the two the header names. That is what MoveIt means,
/// which writes the planning frame as the child, and what tf means, where it is the header. Chains
/// are followed. The parent frame of a virtual joint is where the stance has its child link in it,
/// by default at the child link. The planning frame, if all that does not lead to it, is at the
/// root link.
class FrameTree {
 public:
  /// Throws InputError, at its node, for a transform that contradicts others (by more than 1e-6),
  /// and for a link placed in a frame that has another pose already.
  FrameTree(const Robot& robot, const Stance& stance, const std::string& planning_frame,
            const std::vector<FixedTransform>& transforms);

  /// Before objects are set: has all poses in the base frame of `other`, a stance of the same
  /// robot; `still` is the frame that stands still while the robot goes from the one to the other.
  /// Both must know it.
  void MoveToBaseOf(const FrameTree& other, const std::string& still);

  /// Makes an object's frames known, by their names, instead of those that it had: in the frame of
  /// a link, which they move with, or in the base frame (`link` ""). Those of the robot's links and
  /// surroundings and the planning frame keep their meaning.
  void SetObject(const std::string& id, const std::string& link,
                 const std::map<std::string, Eigen::Isometry3d>& X_LF);
  /// Has an object's frames move with a link from where they are.
  void AttachObject(const std::string& id, const std::string& link);
  void RemoveObject(const std::string& id);
  /// Sets the objects of a tree with the same base frame: those of links where this stance has
  /// them.
  void SetObjectsOf(const FrameTree& other);

  /// X_BF of a frame, null if it is unknown. A leading slash in `name` does not count.
  const Eigen::Isometry3d* Find(const std::string& name) const;
  /// The same; throws InputError at `node` for an unknown one.
  const Eigen::Isometry3d& At(const std::string& name, const YamlNode& node) const;

 private:
  struct ObjectFrames {
    std::string link;  // "" for the base frame.
    std::map<std::string, Eigen::Isometry3d> X_LF;
  };

  // Places the frame that a state gives the pose of a link in.
  void Place(const PlacedLink& placed, const std::string& frame, const RobotModel& model);
  // Places the parent frames of virtual joints that are not known by now.
  void PlaceSurroundings(const Robot& robot);
  // Follows the transforms from known frames to unknown ones, as far as they go.
  void Follow(const std::vector<FixedTransform>& transforms);
  void CheckAgreement(const std::vector<FixedTransform>& transforms) const;
  Eigen::Isometry3d PoseOf(const std::string& link) const;  // X_BL; "" is the base frame.

  std::set<std::string> not_of_objects_;  // Names that no object takes.
  std::map<std::string, Eigen::Isometry3d> X_BF_;
  std::map<std::string, ObjectFrames> objects_;  // By id.
};

/// A name of tf without its leading slash.
std::string WithoutSlash(const std::string& frame);

}  // namespace planbench
