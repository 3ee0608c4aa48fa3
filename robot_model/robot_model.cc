#include "robot_model/robot_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/error.h"

namespace planbench {

using Eigen::Isometry3d;

int NumPositions(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return 0;
    case JointType::kPlanar:
    case JointType::kFloating:
      return 7;
    default:
      return 1;
  }
}

Isometry3d JointMotion(const Joint& joint, double position) {
  Isometry3d X_JC = Isometry3d::Identity();
  if (joint.type == JointType::kPrismatic) {
    X_JC.translation() = joint.axis_J * position;
  } else if (joint.type != JointType::kFixed) {
    X_JC.linear() = Eigen::AngleAxisd(position, joint.axis_J).toRotationMatrix();
  }
  return X_JC;
}

Isometry3d JointMotion(const Joint& joint, std::span<const double> full_positions) {
  if (joint.position_index < 0) return JointMotion(joint, joint.offset);
  const auto index = static_cast<std::size_t>(joint.position_index);
  if (NumPositions(joint.type) == 1) {
    const double position = full_positions[index];
    return JointMotion(joint,
                       joint.leader < 0 ? position : joint.multiplier * position + joint.offset);
  }
  const std::span<const double> pose = full_positions.subspan(index, 7);
  const Eigen::Quaterniond rotation(pose[6], pose[3], pose[4], pose[5]);
  Isometry3d X_JC = Isometry3d::Identity();
  X_JC.translation() = Eigen::Vector3d(pose[0], pose[1], pose[2]);
  X_JC.linear() = rotation.normalized().toRotationMatrix();
  return X_JC;
}

JointSpace::Joint SpaceJoint(const Joint& joint) {
  const bool continuous = !std::isfinite(joint.lower);
  return {.name = joint.name,
          .continuous = continuous,
          .prismatic = joint.type == JointType::kPrismatic,
          .lower = continuous ? -std::numbers::pi : joint.lower,
          .upper = continuous ? std::numbers::pi : joint.upper,
          .max_velocity = joint.max_velocity};
}

std::optional<JointType> ParseVirtualJointType(const std::string& name) {
  const std::optional<JointType> type = ParseEnum<JointType>(name);
  return type && NumPositions(*type) == 1 ? std::nullopt : type;
}

std::vector<int> PlanningGroup::tips() const {
  std::vector<int> tips = {tip_link};
  tips.insert(tips.end(), more_tips.begin(), more_tips.end());
  return tips;
}

int RobotModel::FindLink(const std::string& name) const {
  const auto entry = link_index_.find(name);
  return entry == link_index_.end() ? -1 : entry->second;
}

int RobotModel::FindJoint(const std::string& name) const {
  const auto entry = joint_index_.find(name);
  return entry == joint_index_.end() ? -1 : entry->second;
}

int RobotModel::FollowerThatTurnsMove(int joint) const {
  const JointType type = joints_[static_cast<std::size_t>(joint)].type;
  if (type != JointType::kRevolute && type != JointType::kContinuous) return -1;
  const auto moved = std::ranges::find_if(joints_, [&](const Joint& follower) {
    const bool turns_whole = follower.type != JointType::kPrismatic &&
                             std::rint(follower.multiplier) == follower.multiplier;
    return follower.leader == joint && follower.multiplier != 0 && !turns_whole;
  });
  return moved == joints_.end() ? -1 : static_cast<int>(moved - joints_.begin());
}

bool RobotModel::Rigid(int link_a, int link_b) const {
  return links_[static_cast<std::size_t>(link_a)].body ==
         links_[static_cast<std::size_t>(link_b)].body;
}

bool RobotModel::Joined(int link_a, int link_b) const {
  const auto is_parent_of = [this](int parent, int child) {
    const int index = links_[static_cast<std::size_t>(child)].parent_joint;
    if (index < 0) return false;
    const Joint& joint = joints_[static_cast<std::size_t>(index)];
    return joint.parent_link == parent && NumPositions(joint.type) == 1;
  };
  return is_parent_of(link_a, link_b) || is_parent_of(link_b, link_a);
}

std::vector<double> RobotModel::DefaultPositions() const {
  std::vector<double> positions(position_names_.size(), 0.0);
  for (const Joint& joint : joints_) {
    if (joint.position_index < 0 || joint.leader >= 0) continue;
    const auto index = static_cast<std::size_t>(joint.position_index);
    if (NumPositions(joint.type) == 1) {
      positions[index] = std::clamp(0.0, joint.lower, joint.upper);
    } else {
      positions[index + 6] = 1;
    }
  }
  return positions;
}

PlanningGroup RobotModel::MakeGroup(const std::string& name,
                                    const std::vector<std::string>& joint_names,
                                    const std::string& tip_link,
                                    const std::vector<std::string>& more_tips) const {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("group '{}' of robot '{}': {}", name, name_, what));
  };
  if (joint_names.empty()) fail("has no joints");
  PlanningGroup group;
  group.name = name;
  const auto find_tip = [&](const std::string& tip) {
    const int link = FindLink(tip);
    if (link < 0) fail(fmt::format("tip link '{}' is unknown", tip));
    return link;
  };
  group.tip_link = find_tip(tip_link);
  std::set<int> named = {group.tip_link};
  for (const std::string& tip : more_tips) {
    const int link = find_tip(tip);
    // What is summed over the tips would count it twice.
    const auto is_rigid = [&](int other) { return Rigid(link, other); };
    if (std::ranges::none_of(named, is_rigid)) group.more_tips.push_back(link);
    if (!named.insert(link).second) fail(fmt::format("tip '{}' is repeated", tip));
  }

  std::set<std::string> seen;
  std::vector<JointSpace::Joint> space;
  for (const std::string& joint_name : joint_names) {
    const int index = FindJoint(joint_name);
    if (index < 0) fail(fmt::format("joint '{}' is unknown", joint_name));
    const Joint& joint = joints_[static_cast<std::size_t>(index)];
    if (joint.type == JointType::kFixed) fail(fmt::format("joint '{}' is fixed", joint_name));
    if (NumPositions(joint.type) != 1) {
      fail(fmt::format("joint '{}' is {}; such joints cannot be planned with", joint_name,
                       EnumName(joint.type)));
    }
    if (joint.leader >= 0) {
      fail(fmt::format("joint '{}' follows joint '{}' (mimic); name that one", joint_name,
                       joints_[static_cast<std::size_t>(joint.leader)].name));
    }
    const int follower = FollowerThatTurnsMove(index);
    if (follower >= 0 && joint.type == JointType::kContinuous) {
      fail(
          fmt::format("joint '{}' is continuous, but joint '{}', which follows it, is elsewhere a "
                      "turn later",
                      joint_name, joints_[static_cast<std::size_t>(follower)].name));
    }
    if (!seen.insert(joint_name).second) fail(fmt::format("joint '{}' is repeated", joint_name));
    group.joints.push_back(index);
    space.push_back(SpaceJoint(joint));
    space.back().same_after_turn = follower < 0;
  }
  group.space = JointSpace(std::move(space));
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Joint& follower = joints_[j];
    const auto leader = std::find(group.joints.begin(), group.joints.end(), follower.leader);
    if (follower.leader < 0 || leader == group.joints.end()) continue;
    group.followers.push_back(
        {static_cast<int>(j), static_cast<int>(leader - group.joints.begin())});
  }
  return group;
}

std::string FaultOfName(const VirtualJoint& joint, const RobotModel& model,
                        const std::vector<VirtualJoint>& others) {
  const int same = model.FindJoint(joint.name);
  if (same >= 0 && (joint.type != JointType::kFixed ||
                    model.joints()[static_cast<std::size_t>(same)].type != JointType::kFixed)) {
    return fmt::format("'{}' is the name of a joint of the URDF", joint.name);
  }
  if (std::ranges::find(others, joint.name, &VirtualJoint::name) != others.end()) {
    return fmt::format("the virtual joint '{}' occurs twice", joint.name);
  }
  return "";
}

std::vector<Isometry3d> ComputeLinkPoses(const RobotModel& model,
                                         std::span<const double> positions) {
  std::vector<Isometry3d> X_BL(static_cast<std::size_t>(model.num_links()), Isometry3d::Identity());
  // Joints come in the order of their child links, parents first.
  for (const Joint& joint : model.joints()) {
    X_BL[static_cast<std::size_t>(joint.child_link)] =
        X_BL[static_cast<std::size_t>(joint.parent_link)] * joint.X_PJ *
        JointMotion(joint, positions);
  }
  return X_BL;
}

}  // namespace planbench
