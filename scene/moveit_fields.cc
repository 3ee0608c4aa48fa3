#include "scene/moveit_fields.h"

#include <cmath>
#include <set>

#include "scene/pose.h"

namespace planbench {
namespace {

// Published files carry quaternions rounded to a few digits; what is further off is no rotation.
constexpr double kQuaternionTolerance = 1e-3;

}  // namespace

Eigen::Vector3d ReadVector3(const YamlNode& node) {
  if (node.IsMap()) {
    return {node.At("x").Double(), node.At("y").Double(), node.At("z").Double()};
  }
  const std::vector<double> xyz = node.Doubles(3);
  return {xyz[0], xyz[1], xyz[2]};
}

Eigen::Quaterniond ReadQuaternion(const YamlNode& node) {
  Eigen::Quaterniond q;
  if (node.IsMap()) {
    q = Eigen::Quaterniond(node.At("w").Double(), node.At("x").Double(), node.At("y").Double(),
                           node.At("z").Double());
  } else {
    const std::vector<double> xyzw = node.Doubles(4);
    q = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  }
  if (!(std::abs(q.norm() - 1) <= kQuaternionTolerance)) {
    node.Fail("is no unit quaternion (length " + std::to_string(q.norm()) + ")");
  }
  return q.normalized();
}

Eigen::Isometry3d ReadPose(const YamlNode& node) {
  const Eigen::Vector3d position = ReadVector3(node.At("position"));
  return CanonicalPose(
      PoseFromPositionOrientation(position, ReadQuaternion(node.At("orientation"))));
}

std::string ReadFrame(const YamlNode& message) {
  const std::optional<YamlNode> header = message.Find("header");
  return header ? header->StringOr("frame_id", "") : "";
}

std::vector<YamlNode> OptionalElements(const YamlNode& message, const std::string& key) {
  const std::optional<YamlNode> sequence = message.Find(key);
  return sequence ? sequence->Elements() : std::vector<YamlNode>();
}

void RefuseElements(const YamlNode& message, const std::string& key, const std::string& why) {
  const std::vector<YamlNode> elements = OptionalElements(message, key);
  if (!elements.empty()) elements.front().Fail(why);
}

JointState ReadJointState(const YamlNode& robot_state) {
  if (const auto multi_dof = robot_state.Find("multi_dof_joint_state")) {
    RefuseElements(*multi_dof, "joint_names", "multi-DOF joint states are not supported");
  }
  JointState state;
  const std::optional<YamlNode> joint_state = robot_state.Find("joint_state");
  if (!joint_state) return state;
  const std::vector<YamlNode> names = OptionalElements(*joint_state, "name");
  const std::vector<YamlNode> positions = OptionalElements(*joint_state, "position");
  if (names.size() != positions.size()) {
    joint_state->Fail("has " + std::to_string(names.size()) + " joint names (name) but " +
                      std::to_string(positions.size()) + " positions (position)");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    state.names.push_back(names[i].String());
    if (!seen.insert(state.names.back()).second) {
      names[i].Fail("the joint '" + state.names.back() + "' is named twice");
    }
    state.positions.push_back(positions[i].Double());
  }
  return state;
}

}  // namespace planbench
