#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/shapes.h"
#include "robot_model/joint_space.h"

namespace planbench {

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic };

/// A joint connects parent link P to child link C. J is the joint's frame: fixed in P, equal to C's
/// frame when the joint is at zero.
struct Joint {
  std::string name;
  JointType type = JointType::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitX();  ///< Unit vector; unused for fixed joints.
  double lower = 0;         ///< rad or m; -infinity for continuous joints.
  double upper = 0;         ///< rad or m; +infinity for continuous joints.
  double max_velocity = 0;  ///< rad/s or m/s
  int position_index = -1;  ///< Index into full position vectors; -1 for fixed joints.
};

/// Pose X_JC of the child link's frame in the joint's frame at a position (rad or m).
Eigen::Isometry3d JointMotion(const Joint& joint, double position);

struct Link {
  std::string name;
  int parent_joint = -1;          ///< -1 for the root link.
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
  std::string name;
  std::vector<int> joints;  ///< Joint indices, in group order.
  int tip_link = -1;
  JointSpace space;
};

/// Immutable kinematic tree of a robot, rooted at its base link B. Links are ordered so that a
/// parent comes before its children; link 0 is the root. A full position vector holds every
/// non-fixed joint (num_positions() values, rad or m), indexed by Joint::position_index.
class RobotModel {
 public:
  /// Parses URDF text. `origin` names it in errors. Refuses (InputError): malformed XML, mimic,
  /// floating and planar joints, joints without limits where limits are needed, lower > upper, zero
  /// axes, a tree that is none. Collision meshes are recorded by resource, not loaded.
  static RobotModel FromUrdf(const std::string& urdf_text, const std::string& origin);

  const std::string& name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  int num_links() const { return static_cast<int>(links_.size()); }
  int num_positions() const { return num_positions_; }
  /// Index of a link or joint, -1 if there is none of that name.
  int FindLink(const std::string& name) const;
  int FindJoint(const std::string& name) const;

  /// True if a joint connects the two links.
  bool Adjacent(int link_a, int link_b) const;
  /// Full positions with every joint at zero, or at the nearest limit to zero.
  std::vector<double> DefaultPositions() const;

  /// A planning group from joint names in order; throws InputError for unknown or fixed joints, a
  /// repeated name, or an unknown tip link.
  PlanningGroup MakeGroup(const std::string& name, const std::vector<std::string>& joint_names,
                          const std::string& tip_link) const;

 private:
  std::string name_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::map<std::string, int> link_index_;
  std::map<std::string, int> joint_index_;
  int num_positions_ = 0;
};

/// Poses X_BL of every link at the given full positions (num_positions() values).
std::vector<Eigen::Isometry3d> ComputeLinkPoses(const RobotModel& model,
                                                std::span<const double> positions);

}  // namespace planbench
