#include "scene/moveit_state_reader.h"

#include <set>
#include <vector>

#include "robot_model/full_positions.h"
#include "scene/moveit_fields.h"
#include "scene/pose.h"

namespace planbench {
namespace {

void ReadJointState(const YamlNode& node, const RobotModel& model, RobotStateFields* fields) {
  fields->frame = ReadFrame(node);
  const std::vector<YamlNode> names = OptionalElements(node, "name");
  const std::vector<YamlNode> positions = OptionalElements(node, "position");
  if (names.size() != positions.size()) {
    node.Fail("has " + std::to_string(names.size()) + " joint names (name) but " +
              std::to_string(positions.size()) + " positions (position)");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i].String();
    const double position = positions[i].Double();
    if (!seen.insert(name).second) names[i].Fail("the joint '" + name + "' is named twice");
    if (const auto fault = FindPositionFault(model, name, position)) {
      names[i].Fail("the joint '" + name + "' " + *fault);
    }
    fields->joints.names.push_back(name);
    fields->joints.positions.push_back(position);
  }
}

Eigen::Isometry3d ReadTransform(const YamlNode& node) {
  return CanonicalPose(PoseFromPositionOrientation(ReadVector3(node.At("translation")),
                                                   ReadQuaternion(node.At("rotation"))));
}

// Gives a planar or floating joint its pose.
void AddPose(const Joint& joint, const RobotModel& model, const Eigen::Isometry3d& X_JC,
             const YamlNode& node, JointState* joints) {
  const std::string& first = model.position_names()[static_cast<std::size_t>(joint.position_index)];
  for (const std::string& name : joints->names) {
    if (name == first) node.Fail("the joint '" + joint.name + "' is named twice");
  }
  const Eigen::Quaterniond q = OrientationOf(X_JC);
  const Eigen::Vector3d& p = X_JC.translation();
  const std::vector<double> pose = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  for (std::size_t k = 0; k < pose.size(); ++k) {
    joints->names.push_back(
        model.position_names()[static_cast<std::size_t>(joint.position_index) + k]);
    joints->positions.push_back(pose[k]);
  }
}

// Of a joint that may have a pose; one that neither the URDF nor a virtual joint describes is free.
JointType TypeOf(const std::string& joint, const Robot& robot) {
  const int index = robot.model.FindJoint(joint);
  if (index >= 0) return robot.model.joints()[static_cast<std::size_t>(index)].type;
  for (const VirtualJoint& virtual_joint : robot.virtual_joints) {
    if (virtual_joint.name == joint) return virtual_joint.type;
  }
  return JointType::kFloating;
}

void ReadMultiDofState(const YamlNode& node, const Robot& robot, RobotStateFields* fields) {
  const std::vector<YamlNode> names = OptionalElements(node, "joint_names");
  const std::vector<YamlNode> transforms = OptionalElements(node, "transforms");
  if (names.size() != transforms.size()) {
    node.Fail("has " + std::to_string(names.size()) + " joint_names but " +
              std::to_string(transforms.size()) + " transforms");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i].String();
    const Eigen::Isometry3d pose = ReadTransform(transforms[i]);
    const JointType type = TypeOf(name, robot);
    if (const auto fault = FindPoseFault(type, pose)) {
      const YamlNode& at_fault = NumPositions(type) == 1 ? names[i] : transforms[i];
      at_fault.Fail("the joint '" + name + "' " + *fault);
    }
    const int index = robot.model.FindJoint(name);
    if (index >= 0) {
      const Joint& joint = robot.model.joints()[static_cast<std::size_t>(index)];
      if (NumPositions(type) > 1) AddPose(joint, robot.model, pose, names[i], &fields->joints);
      continue;
    }
    if (fields->X_WR) {
      names[i].Fail("the robot has no joint '" + name +
                    "', and another one joins it to its surroundings already");
    }
    fields->X_WR = pose;
    fields->root_frame = ReadFrame(node);
    fields->root_node.emplace(transforms[i]);
  }
}

}  // namespace

RobotStateFields ReadRobotState(const YamlNode& robot_state, const Robot& robot) {
  RobotStateFields fields;
  if (const auto joint_state = robot_state.Find("joint_state")) {
    ReadJointState(*joint_state, robot.model, &fields);
  }
  if (const auto multi_dof = robot_state.Find("multi_dof_joint_state")) {
    ReadMultiDofState(*multi_dof, robot, &fields);
  }
  return fields;
}

}  // namespace planbench
