#include "scene/moveit_state_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "common/text.h"
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

const PlacedLink* FindPlaced(const std::string& joint, const std::vector<PlacedLink>& links) {
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&](const PlacedLink& placed) { return placed.joint == joint; });
  return found == links.end() ? nullptr : &*found;
}

void AddPlacedLink(const PlacedLink& placed, const YamlNode& name, RobotStateFields* fields) {
  if (FindPlaced(placed.joint, fields->placed_links) != nullptr) {
    name.Fail(placed.joint.empty()
                  ? "the robot has no joint '" + name.String() +
                        "', and another that it does not have joins it to its surroundings already"
                  : "the joint '" + placed.joint + "' is named twice");
  }
  fields->placed_links.push_back(placed);
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

const VirtualJoint* FindVirtualJoint(const std::string& name, const Robot& robot) {
  const auto found = std::find_if(robot.virtual_joints.begin(), robot.virtual_joints.end(),
                                  [&](const VirtualJoint& joint) { return joint.name == name; });
  return found == robot.virtual_joints.end() ? nullptr : &*found;
}

// The pose of a virtual joint. A header that names no frame of such would have it be one in that
// frame, which only makes no difference to the identity.
PlacedLink OfVirtualJoint(const VirtualJoint& joint, const Eigen::Isometry3d& pose,
                          const YamlNode& transform, const YamlNode& multi_dof_state,
                          const Robot& robot) {
  const std::string header = ReadFrame(multi_dof_state);
  const bool is_of_one = std::any_of(
      robot.virtual_joints.begin(), robot.virtual_joints.end(),
      [&](const VirtualJoint& other) { return WithoutSlash(other.parent_frame) == header; });
  if (!header.empty() && !is_of_one && !pose.matrix().isIdentity()) {
    FrameNode(multi_dof_state)
        .Fail("the pose of the joint '" + joint.name + "' is one in '" + joint.parent_frame +
              "', not in '" + header + "'; name that frame here, or none");
  }
  return {joint.name, joint.child_link, WithoutSlash(joint.parent_frame), pose, transform};
}

// The pose of a joint that nothing describes, taken for what joins the robot to its surroundings.
// Where the robot's description tells what does, or where the name is nearly that of one of its
// joints with a pose, it is a mistake.
PlacedLink OfUndescribedJoint(const YamlNode& name, const Eigen::Isometry3d& pose,
                              const YamlNode& transform, const YamlNode& multi_dof_state,
                              const Robot& robot) {
  std::vector<std::string_view> known;
  for (const VirtualJoint& joint : robot.virtual_joints) known.push_back(joint.name);
  const std::string virtual_joints = fmt::format("'{}'", fmt::join(known, "', '"));
  for (const Joint& joint : robot.model.joints()) {
    if (NumPositions(joint.type) > 1) known.push_back(joint.name);
  }
  const std::string nearest = NearestName(name.String(), known);
  if (!nearest.empty()) {
    name.Fail(
        fmt::format("the robot has no joint '{}'; did you mean '{}'? What joins it to its "
                    "surroundings is to be among the virtual_joints of its robot.yaml",
                    name.String(), nearest));
  }
  if (!robot.virtual_joints.empty()) {
    name.Fail(fmt::format("the robot has no joint '{}'; its virtual joints are {}", name.String(),
                          virtual_joints));
  }
  return {"", 0, ReadFrame(multi_dof_state), pose, transform};
}

void ReadJointPose(const YamlNode& name, const YamlNode& transform, const YamlNode& multi_dof_state,
                   const Robot& robot, RobotStateFields* fields) {
  const int index = robot.model.FindJoint(name.String());
  const Joint* joint = index < 0 ? nullptr : &robot.model.joints()[static_cast<std::size_t>(index)];
  const VirtualJoint* virtual_joint = FindVirtualJoint(name.String(), robot);
  const JointType type = joint != nullptr           ? joint->type
                         : virtual_joint != nullptr ? virtual_joint->type
                                                    : JointType::kFloating;
  const Eigen::Isometry3d pose = ReadTransform(transform);
  if (const auto fault = FindPoseFault(type, pose)) {
    const YamlNode& at_fault = NumPositions(type) == 1 ? name : transform;
    at_fault.Fail("the joint '" + name.String() + "' " + *fault);
  }
  if (joint != nullptr) {
    if (NumPositions(type) > 1) AddPose(*joint, robot.model, pose, name, &fields->joints);
    return;
  }
  AddPlacedLink(virtual_joint != nullptr
                    ? OfVirtualJoint(*virtual_joint, pose, transform, multi_dof_state, robot)
                    : OfUndescribedJoint(name, pose, transform, multi_dof_state, robot),
                name, fields);
}

void ReadMultiDofState(const YamlNode& node, const Robot& robot, RobotStateFields* fields) {
  const std::vector<YamlNode> names = OptionalElements(node, "joint_names");
  const std::vector<YamlNode> transforms = OptionalElements(node, "transforms");
  if (names.size() != transforms.size()) {
    node.Fail("has " + std::to_string(names.size()) + " joint_names but " +
              std::to_string(transforms.size()) + " transforms");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    ReadJointPose(names[i], transforms[i], node, robot, fields);
  }
  if (!fields->placed_links.empty()) fields->placed_frame = ReadFrame(node);
}

// Overlays the joints of `below`.
void OverlayJoints(const JointState& above, JointState* below) {
  for (std::size_t i = 0; i < above.names.size(); ++i) {
    const auto found = std::find(below->names.begin(), below->names.end(), above.names[i]);
    if (found == below->names.end()) {
      below->names.push_back(above.names[i]);
      below->positions.push_back(above.positions[i]);
    } else {
      below->positions[static_cast<std::size_t>(found - below->names.begin())] = above.positions[i];
    }
  }
}

std::vector<PlacedLink> OverlaidLinks(const std::vector<PlacedLink>& below,
                                      const std::vector<PlacedLink>& above) {
  std::vector<PlacedLink> links = above;
  for (const PlacedLink& placed : below) {
    const PlacedLink* known = FindPlaced(placed.joint, above);
    if (known == nullptr) {
      links.push_back(placed);
    } else if (!known->frame.empty() && !placed.frame.empty() && known->frame != placed.frame) {
      known->node.Fail("places the robot in the frame '" + known->frame +
                       "', but the other file in '" + placed.frame + "'");
    }
  }
  return links;
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

RobotStateFields Overlaid(RobotStateFields below, const RobotStateFields& above) {
  OverlayJoints(above.joints, &below.joints);
  below.placed_links = OverlaidLinks(below.placed_links, above.placed_links);
  if (!above.placed_frame.empty()) below.placed_frame = above.placed_frame;
  if (!above.frame.empty()) below.frame = above.frame;
  return below;
}

}  // namespace planbench
