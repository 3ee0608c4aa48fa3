#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "collision/balls.h"
#include "robot_model/robot_model.h"

namespace planbench {

/// Pose of a frame in another: p_A = rotation * p_B + translation.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
  Eigen::Vector3d InverseTimes(const Eigen::Vector3d& p) const {
    return rotation.transpose() * (p - translation);
  }
  Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  Pose Inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
  static Pose From(const Eigen::Isometry3d& X) { return {X.linear(), X.translation()}; }
  Eigen::Isometry3d ToIsometry() const;
};

/// Full positions with those of the group's joints at 0: where the other joints are held.
std::vector<double> HeldPositions(const RobotModel& model, const PlanningGroup& group,
                                  std::span<const double> base_positions);

/// A robot as one planning group moves it, all other joints held: links that keep their relative
/// pose form one rigid body, so that a robot of 25 links is moved by one transform per group joint.
/// Body 0 is what does not move, its frame is the robot's base frame; each group joint carries one
/// further body, whose frame is that of the joint's child link. Parents come before children.
class RigidBodies {
 public:
  /// `base_positions`: full positions; those of the group's joints are placeholders.
  RigidBodies(const RobotModel& model, const PlanningGroup& group,
              std::span<const double> base_positions);

  int size() const { return static_cast<int>(bodies_.size()); }
  /// The body a link belongs to, and the link's pose in that body's frame.
  int BodyOf(int link) const { return body_of_link_[static_cast<std::size_t>(link)]; }
  const Pose& X_GL(int link) const { return X_GL_[static_cast<std::size_t>(link)]; }
  /// The body on the base side of a body's joint, -1 for body 0.
  int Parent(int body) const { return bodies_[static_cast<std::size_t>(body)].parent; }
  /// The joint that moves a body (not body 0) relative to its parent P.
  struct Mobility {
    int group_index;
    bool prismatic;
    Pose X_PG;               ///< At joint position 0.
    Eigen::Vector3d axis_P;  ///< Unit; a revolute joint's axis passes through G's origin.
  };
  Mobility MobilityOf(int body) const;

  /// Computes the poses of all bodies in the base frame W for group positions q (group order, rad
  /// or m).
  void ComputePoses(std::span<const double> q, std::span<Pose> X_WG) const;

  /// A ball, in the frame of `ancestor`, that a ball fixed to `body` never leaves, whatever the
  /// joints between them do, as long as WithinTravel. `body` must descend from `ancestor` or equal
  /// it.
  Ball Reach(int ancestor, int body, const Ball& ball) const;
  bool Descends(int body, int ancestor) const;
  /// The joints (group indices) that move `body` relative to the nearest body that carries it and
  /// `other`; with those of the two the other way round, all that move one relative to the other.
  std::vector<int> JointsBelowCommon(int body, int other) const;
  /// True if no prismatic joint of the group is further from its zero than its limits allow
  /// (configurations beyond limits are not planned with, but may be checked).
  bool WithinTravel(std::span<const double> q) const;

 private:
  struct Body {
    int parent = -1;
    int group_index = -1;
    bool prismatic = false;
    double max_travel = 0;  // prismatic: largest |position|, m
    // Joint frame J in the parent body's frame G: p_GJ, and for a revolute joint at position t
    // R_GC = base + sin(t) sine + (1 - cos(t)) versine (Rodrigues' formula); a prismatic one moves
    // along axis_G.
    Eigen::Vector3d p_GJ = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis_G = Eigen::Vector3d::Zero();
    Eigen::Matrix3d base = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d sine = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d versine = Eigen::Matrix3d::Zero();
  };
  std::vector<Body> bodies_;
  std::vector<int> body_of_link_;
  std::vector<Pose> X_GL_;
};

}  // namespace planbench
