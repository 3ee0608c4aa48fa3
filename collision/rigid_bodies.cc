#include "collision/rigid_bodies.h"

#include <algorithm>
#include <cmath>

#include "collision/at.h"

namespace planbench {
namespace {

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Eigen::Isometry3d Pose::ToIsometry() const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation;
  X.translation() = translation;
  return X;
}

std::vector<double> HeldPositions(const RobotModel& model, const PlanningGroup& group,
                                  std::span<const double> base_positions) {
  std::vector<double> held(base_positions.begin(), base_positions.end());
  for (const int joint : group.joints) At(held, At(model.joints(), joint).position_index) = 0;
  return held;
}

RigidBodies::RigidBodies(const RobotModel& model, const PlanningGroup& group,
                         std::span<const double> base_positions) {
  bodies_.emplace_back();
  body_of_link_.assign(static_cast<std::size_t>(model.num_links()), 0);
  X_GL_.assign(static_cast<std::size_t>(model.num_links()), Pose());
  for (int link = 0; link < model.num_links(); ++link) {
    const auto l = static_cast<std::size_t>(link);
    const int joint_index = model.links()[l].parent_joint;
    if (joint_index < 0) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(joint_index)];
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    const Pose X_GJ = X_GL_[parent] * Pose::From(joint.X_PJ);
    const auto in_group = std::find(group.joints.begin(), group.joints.end(), joint_index);
    if (in_group == group.joints.end()) {
      body_of_link_[l] = body_of_link_[parent];
      X_GL_[l] = X_GJ * Pose::From(JointMotion(joint, base_positions));
      continue;
    }
    Body body;
    body.parent = body_of_link_[parent];
    body.group_index = static_cast<int>(in_group - group.joints.begin());
    body.prismatic = joint.type == JointType::kPrismatic;
    body.p_GJ = X_GJ.translation;
    body.axis_G = X_GJ.rotation * joint.axis_J;
    body.base = X_GJ.rotation;
    if (body.prismatic) {
      body.max_travel =
          std::max(std::abs(joint.lower), std::abs(joint.upper)) + JointSpace::kLimitTolerance;
    } else {
      const Eigen::Matrix3d cross = CrossMatrix(joint.axis_J);
      body.sine = X_GJ.rotation * cross;
      body.versine = X_GJ.rotation * cross * cross;
    }
    body_of_link_[l] = size();
    bodies_.push_back(body);
  }
}

void RigidBodies::ComputePoses(std::span<const double> q, std::span<Pose> X_WG) const {
  X_WG[0] = Pose();
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const Pose& parent = X_WG[static_cast<std::size_t>(body.parent)];
    const double position = q[static_cast<std::size_t>(body.group_index)];
    Pose& pose = X_WG[i];
    if (body.prismatic) {
      pose.rotation.noalias() = parent.rotation * body.base;
      pose.translation = parent * (body.p_GJ + position * body.axis_G);
    } else {
      const Eigen::Matrix3d R_GC =
          body.base + std::sin(position) * body.sine + (1 - std::cos(position)) * body.versine;
      pose.rotation.noalias() = parent.rotation * R_GC;
      pose.translation = parent * body.p_GJ;
    }
  }
}

Ball RigidBodies::Reach(int ancestor, int body, const Ball& ball) const {
  if (body == ancestor) return ball;
  double radius = ball.center.norm() + ball.radius;  // about the frame of `body`
  while (true) {
    const Body& b = bodies_[static_cast<std::size_t>(body)];
    radius += b.max_travel;
    if (b.parent == ancestor) return {b.p_GJ, radius};
    radius += b.p_GJ.norm();
    body = b.parent;
  }
}

RigidBodies::Mobility RigidBodies::MobilityOf(int body) const {
  const Body& b = bodies_[static_cast<std::size_t>(body)];
  return {b.group_index, b.prismatic, {b.base, b.p_GJ}, b.axis_G};
}

bool RigidBodies::WithinTravel(std::span<const double> q) const {
  for (const Body& body : bodies_) {
    if (body.prismatic &&
        std::abs(q[static_cast<std::size_t>(body.group_index)]) > body.max_travel) {
      return false;
    }
  }
  return true;
}

bool RigidBodies::Descends(int body, int ancestor) const {
  while (body > ancestor) body = Parent(body);
  return body == ancestor;
}

std::vector<int> RigidBodies::JointsBelowCommon(int body, int other) const {
  std::vector<int> joints;
  for (; !Descends(other, body); body = Parent(body))
    joints.push_back(At(bodies_, body).group_index);
  return joints;
}

}  // namespace planbench
