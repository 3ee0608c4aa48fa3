#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// One of a scene's fixed_frame_transforms.
struct FixedTransform {
  std::string header;  ///< Frames, without leading slashes; the header's may be "".
  std::string child;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  YamlNode node;
};

/// Where a state has a link of the robot in its surroundings: the pose of a virtual joint.
struct PlacedLink {
  std::string joint;  ///< "" for a joint that the robot's description does not have.
  int link = 0;
  std::string frame;  ///< F, without leading slashes; "" is the planning frame.
  Eigen::Isometry3d X_FL = Eigen::Isometry3d::Identity();
  YamlNode node;  ///< Where the pose stands.
};

/// How the robot stands.
struct Stance {
  std::vector<double> positions;  ///< Of all its joints (RobotModel::position_names).
  std::vector<PlacedLink> placed_links;
};

/// The frame that a file is in.
struct PlanningFrame {
  std::string name;         ///< Without leading slashes; "" if nothing names it.
  bool is_guessed = false;  ///< From what the transforms have in common; the file may mean another.
};

/// A frame of an object: its own or a subframe.
struct ObjectFrame {
  std::string name;
  Eigen::Isometry3d X_LF;  ///< In the frame of the link that it moves with, or the base frame.
  YamlNode node;           ///< Where it is named.
  /// The object's pose, if MoveIt would pass it over and have the frame elsewhere.
  std::optional<YamlNode> disputed_pose;
};

/// A name of tf without its leading slashes.
std::string WithoutSlash(const std::string& frame);
/// The name of a link as the robot has it, be it with slashes; without them if there is none.
std::string LinkNamed(const std::string& name, const RobotModel& model);

/// Poses of named frames in the robot's base frame B (that of its root link), with the robot in one
/// stance: the robot's links, its surroundings, the planning frame (also named ""), fixed frames,
/// objects and their subframes.
///
/// Chains of fixed transforms are followed outwards from the planning frame, if it is not guessed:
/// of each the numbers are the pose of the frame that is further out in the other one, whichever of
/// the two the header names. That is what MoveIt means, which writes the planning frame as the
/// child, and what tf means, where it is the header. So a chain to a link of the robot says where
/// the robot stands; MoveIt passes such over, hence a warning. Transforms that no chain joins to
/// the planning frame are followed outwards from the robot. The parent frame of a virtual joint is
/// where the stance has its child link in it, by default at the child link. The planning frame, if
/// all that does not lead to it, is at the root link.
///
/// An object's frame comes before a fixed one of that name, as in MoveIt.
class FrameTree {
 public:
  /// Throws InputError, at its node, for a transform that contradicts others (by more than 1e-6),
  /// and for a link placed in a frame that has another pose already.
  FrameTree(const Robot& robot, const Stance& stance, const PlanningFrame& planning_frame,
            const std::vector<FixedTransform>& transforms);

  /// Before objects are set: has all poses in the base frame of `other`, a stance of the same
  /// robot; `still` is the frame that stands still while the robot goes from the one to the other.
  /// Throws InputError, at `node`, if either does not know it.
  void MoveToBaseOf(const FrameTree& other, const std::string& still, const YamlNode& node);

  /// Whoever asks for a frame of an object before it is set is told that it comes later.
  void ExpectObject(const std::string& id) {
    if (!objects_.contains(id)) expected_.insert(WithoutSlash(id));
  }
  /// Makes an object's frames known instead of those that it had: in the frame of a link, which
  /// they move with, or in the base frame (`link` ""). Those of the robot's links and surroundings
  /// and the planning frame keep their meaning. Throws InputError, at its node, for a frame of a
  /// name that a frame of this or another object has already.
  void SetObject(const std::string& id, const std::string& link,
                 const std::vector<ObjectFrame>& frames);
  /// Has an object's frames move with a link from where they are.
  void AttachObject(const std::string& id, const std::string& link);
  void RemoveObject(const std::string& id);
  /// Sets the objects of a tree with the same base frame: those of links where this stance has
  /// them.
  void SetObjectsOf(const FrameTree& other);

  /// X_BF of a frame, null if it is unknown. Leading slashes in `name` do not count.
  const Eigen::Isometry3d* Find(const std::string& name) const;
  /// The same for who uses it, at `node`: throws InputError there for an unknown one. Warns of one
  /// that MoveIt would have elsewhere, at the pose that is disputed.
  const Eigen::Isometry3d& At(const std::string& name, const YamlNode& node) const;

  /// A frame of an object, in that of the link it moves with ("" for the base frame).
  struct InLink {
    std::string link;
    Eigen::Isometry3d X_LF;
  };
  /// Nothing if no object has a frame of that name. Warns as At does.
  std::optional<InLink> OfObject(const std::string& name) const;

 private:
  // A frame on the way outwards from others, whose poses are in A.
  struct OutwardFrame {
    std::string name;
    Eigen::Isometry3d X_AF;
    const FixedTransform* last;  // Which leads there; null for those that the way is from.
  };
  struct ObjectFrames {
    std::string link;  // "" for the base frame.
    std::vector<ObjectFrame> frames;
  };
  struct PlacedObjectFrame {
    std::string id;  // Of the object.
    Eigen::Isometry3d X_BF;
    mutable std::optional<YamlNode> disputed_pose;  // Until it is warned of.
  };

  // Places the frame that a state gives the pose of a link in.
  void Place(const PlacedLink& placed, const std::string& frame, const RobotModel& model);
  // Places the parent frames of virtual joints that are not known by now.
  void PlaceSurroundings(const Robot& robot);
  // These frames, and what transforms join to them, the nearest first.
  static std::vector<OutwardFrame> FollowOutwards(const std::vector<FixedTransform>& transforms,
                                                  const std::vector<OutwardFrame>& from);
  // Places what is joined to the planning frame, if any of it is known, by the nearest that is;
  // then follows the transforms from known frames to unknown ones, as far as they go.
  void Follow(const std::vector<FixedTransform>& transforms,
              const std::vector<OutwardFrame>& outward);
  void WarnOfPlacedRobot(const std::vector<OutwardFrame>& outward, const RobotModel& model) const;
  void CheckAgreement(const std::vector<FixedTransform>& transforms) const;
  Eigen::Isometry3d PoseOf(const std::string& link) const;  // X_BL; "" is the base frame.
  // Null if no object has a frame of that name.
  const PlacedObjectFrame* FindOfObject(const std::string& name) const;
  // The same for who uses it.
  const PlacedObjectFrame* UseOfObject(const std::string& name) const;

  std::set<std::string> not_of_objects_;           // Names that no object takes.
  std::set<std::string> expected_;                 // Ids without slash.
  std::map<std::string, Eigen::Isometry3d> X_BF_;  // But for those of objects.
  std::map<std::string, ObjectFrames> objects_;    // By id.
  std::map<std::string, PlacedObjectFrame> object_frames_;
};

}  // namespace planbench
