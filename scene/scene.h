#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// MoveIt's name for what sensors see, an octomap, as a body: no other object has it.
inline constexpr const char* kOctomapId = "<octomap>";

/// An object of the world: shapes rigidly joined. W is the robot's base frame, that of its root
/// link (every frame of a file is resolved into it by the reader).
struct SceneObject {
  std::string id;
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();  ///< Object pose.
  std::vector<PlacedShape> shapes;  ///< Poses X_OS in the object's frame (PlacedShape::X_FS).
  bool operator==(const SceneObject& other) const {
    return id == other.id && X_WO.matrix() == other.X_WO.matrix() && shapes == other.shapes;
  }
};

/// An object that moves with a link. Its pose field holds X_LO, the object in the link's frame.
struct AttachedObject {
  std::string link;
  SceneObject object;
  /// Links the object may touch, besides `link` itself; each once.
  std::vector<std::string> touch_links;
  bool operator==(const AttachedObject&) const = default;
};

/// Which pairs of bodies (links, objects, attached objects, by name) may touch. MoveIt's meaning:
/// an explicit entry decides; without one, the default entries of the two names decide: if both
/// have one, the pair is allowed when both allow it, if one has, that one; without any the pair is
/// checked.
class AllowedCollisionMatrix {
 public:
  void SetEntry(std::string a, std::string b, bool allowed);
  void SetDefaultEntry(const std::string& name, bool allowed);
  bool Allowed(const std::string& a, const std::string& b) const;
  /// What the explicit entry of two names says, nothing if there is none. A `false` has links
  /// checked that a joint connects, which are not by themselves (PairRules).
  std::optional<bool> Entry(const std::string& a, const std::string& b) const;
  /// What the default entries say where there is no explicit one.
  bool AllowedByDefault(const std::string& a, const std::string& b) const;

  /// Pairs in canonical order (first <= second).
  using Entries = std::map<std::pair<std::string, std::string>, bool>;

  /// False for an entry that changes nothing: one of a body with itself, or one that allows what
  /// the default entries allow already.
  bool Tells(const Entries::value_type& entry) const;
  /// The same matrix without the entries that change nothing. The file reader gives this form, and
  /// leaves out each `false` that asks for what is checked anyway.
  AllowedCollisionMatrix Simplified() const;

  const Entries& entries() const { return entries_; }
  const std::map<std::string, bool>& default_entries() const { return default_entries_; }
  bool operator==(const AllowedCollisionMatrix&) const = default;

 private:
  Entries entries_;
  std::map<std::string, bool> default_entries_;
};

/// Pose of a named frame in W, of `fixed_frame_transforms` or that a workspace is in.
struct FrameTransform {
  std::string frame;
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
};

/// What surrounds the robot. A value; two scenes with equal content ids are the same scene.
struct Scene {
  std::string name;
  std::string robot_name;                ///< robot_model_name of the file; may be empty.
  std::string world_frame;               ///< Name of W, the robot's root link, e.g. "base_link".
  std::vector<SceneObject> objects;      ///< Ids unique.
  std::vector<AttachedObject> attached;  ///< Ids unique, also among objects.
  AllowedCollisionMatrix allowed_collisions;
  std::vector<FrameTransform> fixed_frames;  ///< Without W's own identity.
};

/// The same scene with another frame N for W, in which W has pose X_NW. Names stay, but for that of
/// the frame.
Scene InFrame(const Scene& scene, const std::string& frame, const Eigen::Isometry3d& X_NW);

/// Content hash of all that bears on collisions: world frame, objects (order, ids, poses, shapes
/// with their triangles), attached objects, allowed collisions. Names of the scene and of the
/// robot, fixed frames, a mesh's resource, the order of touch links and entries of the matrix that
/// change nothing do not count. Positions and dimensions count to the last bit (but -0.0 is 0.0),
/// orientations as OrientationSteps (scene/pose.h): a scene that was written to a file, or sent as
/// positions and OrientationOf, and rebuilt with PoseFromPositionOrientation, has the same id.
/// 32 hexadecimal digits. Throws std::invalid_argument if a mesh has no triangles (is not loaded).
std::string SceneId(const Scene& scene);

}  // namespace planbench
