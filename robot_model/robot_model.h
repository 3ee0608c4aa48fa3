#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/enum_names.h"
#include "geometry/shapes.h"
#include "robot_model/joint_space.h"

namespace planbench {

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic, kPlanar, kFloating };
template <>
struct EnumNames<JointType> {
  static constexpr auto kNames = std::to_array<std::string_view>(
      {"fixed", "revolute", "continuous", "prismatic", "planar", "floating"});
};

/// Positions a joint of that type has: none, one, or, if it is planar or floating, the seven of a
/// pose: translation x, y, z (m) and rotation x, y, z, w (a quaternion).
int NumPositions(JointType type);

/// A joint connects parent link P to child link C. J is the joint's frame: fixed in P, equal to C's
/// frame when the joint is at zero.
struct Joint {
  std::string name;
  std::string where;  ///< For messages: file, line and name.
  JointType type = JointType::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();
  /// Unit vector; used by revolute, continuous and prismatic joints. Of a fixed one the axis that
  /// its description still names, zero without.
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitX();
  /// rad or m; infinite for continuous joints. Soft limits (safety_controller) count; a joint
  /// that others follow keeps them within theirs, and theirs are here what is left of them.
  double lower = 0;
  double upper = 0;
  double max_velocity = 0;  ///< rad/s or m/s; 0: none is given that a joint could have.
  /// Index of its first position in full position vectors; -1 if it has none (fixed joints). A
  /// joint that follows (mimics) another has none of its own: this is the leader's.
  int position_index = -1;
  int leader = -1;        ///< Index of the joint that this one follows, itself no follower; or -1.
  double multiplier = 1;  ///< The joint is at multiplier * (the leader's position) + offset.
  double offset = 0;
};

/// Pose X_JC of the child link's frame in the joint's frame at a position (rad or m) of the joint
/// itself. For joints of one position; a fixed one never moves.
Eigen::Isometry3d JointMotion(const Joint& joint, double position);
/// The same for every joint, at full positions of its robot.
Eigen::Isometry3d JointMotion(const Joint& joint, std::span<const double> full_positions);

/// The joint in a configuration space. It turns for ever if its limits say so, whatever its type: a
/// follower's are what its leader leaves it.
JointSpace::Joint SpaceJoint(const Joint& joint);

/// Joins the robot to its surroundings, which are no part of the URDF: an SRDF's virtual joint.
struct VirtualJoint {
  std::string name;
  JointType type = JointType::kFixed;  ///< Fixed, planar or floating.
  std::string parent_frame;            ///< Of the surroundings; at the child link if it is fixed.
  int child_link = -1;
};
/// The type of a virtual joint of that name, nothing if it is the name of none.
std::optional<JointType> ParseVirtualJointType(const std::string& name);

struct Link {
  std::string name;
  std::string where;      ///< For messages: file, line and name.
  int parent_joint = -1;  ///< -1 for the root link.
  int body = -1;          ///< The outermost link, towards the root, that this one is rigid to.
  std::vector<int> child_joints;  ///< In URDF order.
  std::vector<PlacedShape>
      collision;  ///< Collision geometry of the URDF; meshes named, not loaded.
};

/// A collision sphere fixed to a link.
struct LinkSphere {
  int link = -1;
  Eigen::Vector3d p_LS;  ///< Centre in the link's frame, m.
  double radius = 0;     ///< m
};

/// The joints that plans move.
struct PlanningGroup {
  /// A joint outside the group that follows one of its joints.
  struct Follower {
    int joint = -1;        ///< Joint index.
    int group_index = -1;  ///< Of the leader.
  };
  std::string name;
  std::vector<int> joints;  ///< Joint indices, in group order.
  std::vector<Follower> followers;
  int tip_link = -1;
  std::vector<int> more_tips;     ///< Of further arms.
  std::vector<int> tips() const;  ///< All of them, tip_link first.
  JointSpace space;
  std::map<std::string, std::vector<double>> states;  ///< Named configurations, in group
                                                      ///< order, without whole turns.
};

/// Immutable kinematic tree of a robot, rooted at its base link B. Links are ordered so that a
/// parent comes before its children; link 0 is the root. A full position vector holds the positions
/// of every joint that is neither fixed nor follows another (num_positions() values), see
/// Joint::position_index.
class RobotModel {
 public:
  /// Parses URDF text. `origin` names it in errors. Refuses (InputError): malformed XML, unexpanded
  /// xacro, joints without limits where limits are needed, lower > upper, zero axes, joints that
  /// follow each other in a circle, a tree that is none. Collision meshes are recorded by resource,
  /// not loaded. What was taken otherwise than written goes to `warnings`, if given.
  static RobotModel FromUrdf(const std::string& urdf_text, const std::string& origin,
                             std::vector<std::string>* warnings = nullptr);

  const std::string& name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  int num_links() const { return static_cast<int>(links_.size()); }
  int num_positions() const { return static_cast<int>(position_names_.size()); }
  /// Names of the positions: the joint's, or, of planar and floating joints, JOINT/trans_x, .. y,
  /// .. z, JOINT/rot_x, .. y, .. z, .. w.
  const std::vector<std::string>& position_names() const { return position_names_; }
  /// Index of a link or joint, -1 if there is none of that name.
  int FindLink(const std::string& name) const;
  int FindJoint(const std::string& name) const;

  /// Index of a joint that follows this one and is elsewhere when this, a revolute or continuous
  /// one, has made a turn; -1 if there is none. No group can have a continuous joint with one.
  int FollowerThatTurnsMove(int joint) const;

  /// True if nothing but fixed joints stands between the two links, or they are the same.
  bool Rigid(int link_a, int link_b) const;
  /// True if a joint connects the two links and keeps them together, but lets them move: not a
  /// fixed one, nor a planar or floating one, which may have them anywhere.
  bool Joined(int link_a, int link_b) const;
  /// Full positions with every joint at zero, or at the nearest limit to zero; planar and floating
  /// joints at the identity.
  std::vector<double> DefaultPositions() const;

  /// A planning group from joint names in order; of tips that are rigid to each other the first
  /// counts. Throws InputError for joints that are unknown, or fixed, planar or floating, or follow
  /// another, a repeated joint or tip, an unknown tip link, or a continuous joint with a follower
  /// that is elsewhere a turn later. It has no states.
  PlanningGroup MakeGroup(const std::string& name, const std::vector<std::string>& joint_names,
                          const std::string& tip_link,
                          const std::vector<std::string>& more_tips = {}) const;

 private:
  std::string name_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::map<std::string, int> link_index_;
  std::map<std::string, int> joint_index_;
  std::vector<std::string> position_names_;
};

/// For messages: why a virtual joint cannot have its name, "" if it can. Problems give poses by
/// name, so that it must not be that of a joint of the robot, unless both are fixed and have none
/// to give, or of one of `others`.
std::string FaultOfName(const VirtualJoint& joint, const RobotModel& model,
                        const std::vector<VirtualJoint>& others);

/// Poses X_BL of every link at the given full positions (num_positions() values).
std::vector<Eigen::Isometry3d> ComputeLinkPoses(const RobotModel& model,
                                                std::span<const double> positions);

}  // namespace planbench
