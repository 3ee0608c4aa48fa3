#include "scene/moveit_state_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "common/text.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_fields.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// Where the names of a planar or floating joint's positions begin: x, y, z, and a quaternion's.
const std::string* PartsOf(const Joint& joint, const RobotModel& model) {
  return &model.position_names()[static_cast<std::size_t>(joint.position_index)];
}

// Holds the parts of a pose that a joint_state gives, one by one, to what a pose is held to: a
// rotation is taken whole, what is not named of it as of none. `names` are those of `joints`.
void ReadParts(const Joint& joint, const RobotModel& model, const std::vector<YamlNode>& names,
               JointState* joints) {
  constexpr int kRotation = 3;
  constexpr double kSameNumber = 1e-12;
  const std::string* const parts = PartsOf(joint, model);
  std::array<double, 7> pose = {0, 0, 0, 0, 0, 0, 1};
  std::array<const YamlNode*, 7> named = {};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k =
        static_cast<std::size_t>(std::find(parts, parts + pose.size(), joints->names[i]) - parts);
    if (k == pose.size()) continue;
    pose[k] = joints->positions[i];
    named[k] = &names[i];
  }
  const auto is_named = [](const YamlNode* node) { return node != nullptr; };
  const auto first = std::find_if(named.begin(), named.end(), is_named);
  if (first == named.end()) return;
  const Eigen::Vector3d position(pose[0], pose[1], pose[2]);
  RequireNear(position, **first);
  const auto of_rotation = std::find_if(named.begin() + kRotation, named.end(), is_named);
  if (of_rotation == named.end()) return;
  const Eigen::Quaterniond q =
      Normalised(Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]), **of_rotation,
                 "the rotation of joint '" + joint.name + "' ");
  if (const auto fault = FindPoseFault(joint.type, PoseFromPositionOrientation(position, q))) {
    (*of_rotation)->Fail("the joint '" + joint.name + "' " + *fault);
  }
  for (int k = 0; k < 4; ++k) {
    const std::string& part = parts[kRotation + k];
    const auto at = std::find(joints->names.begin(), joints->names.end(), part);
    const auto i = static_cast<std::size_t>(at - joints->names.begin());
    if (at == joints->names.end()) {
      joints->names.push_back(part);
      joints->positions.push_back(0);
    }
    // What is of unit length stays as it is written.
    if (std::abs(joints->positions[i] - q.coeffs()[k]) > kSameNumber) {
      joints->positions[i] = q.coeffs()[k];
    }
  }
}

void ReadJointState(const YamlNode& node, const Robot& robot, const JointSpace& group,
                    RobotStateFields* fields) {
  const RobotModel& model = robot.model;
  fields->frame = ReadFrame(node);
  const std::vector<YamlNode> names = OptionalElements(node, "name");
  const std::vector<YamlNode> positions = OptionalElements(node, "position");
  if (names.size() != positions.size()) {
    node.Fail("has " + std::to_string(names.size()) + " joint names (name) but " +
              std::to_string(positions.size()) + " positions (position)");
  }
  std::vector<YamlNode> nodes;  // Of the names that are read.
  const auto add = [&](const std::string& name, double position, const YamlNode& at) {
    const std::vector<std::string>& known = fields->joints.names;
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      at.Fail("the joint '" + name + "' is named twice");
    }
    if (const auto fault = FindPositionFault(model, name, position)) {
      at.Fail("the joint '" + name + "' " + *fault);
    }
    fields->joints.names.push_back(name);
    fields->joints.positions.push_back(position);
    nodes.push_back(at);
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i].String();
    const double position = positions[i].Double();
    RefuseVirtualJoint(names[i], robot);
    if (const std::optional<PosePart> part = FindPosePart(model, name)) {
      const std::string* const parts =
          &model.position_names()[static_cast<std::size_t>(part->position_index)];
      add(parts[0], part->is_angle ? std::sin(position / 2) : position, names[i]);
      if (part->is_angle) add(parts[1], std::cos(position / 2), names[i]);
      continue;
    }
    add(name, position, names[i]);
    std::optional<std::string> doubt = FindPositionDoubt(model, name, position);
    if (const int j = group.Find(name); j >= 0) doubt = group.FindTurnsDoubt(j, position);
    if (doubt) names[i].Warn("the joint '" + name + "' " + *doubt);
  }
  for (const Joint& joint : model.joints()) {
    if (NumPositions(joint.type) > 1) ReadParts(joint, model, nodes, &fields->joints);
  }
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
  const Eigen::Quaterniond q = OrientationOf(X_JC);
  const Eigen::Vector3d& p = X_JC.translation();
  const std::vector<double> pose = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  const std::string* const parts = PartsOf(joint, model);
  for (const std::string& name : joints->names) {
    if (std::find(parts, parts + pose.size(), name) != parts + pose.size()) {
      node.Fail("the joint '" + joint.name + "' is named twice, here and as '" + name + "'");
    }
  }
  joints->names.insert(joints->names.end(), parts, parts + pose.size());
  joints->positions.insert(joints->positions.end(), pose.begin(), pose.end());
}

// Refuses the pose of a joint of the URDF, which is one in the joint's own frame, in a header of
// another. MoveIt has the frame of the whole robot there, as in the joint_state's; what joins a
// robot to its surroundings that has no virtual joints may bring any.
void RequireOwnFrame(const Joint& joint, const Eigen::Isometry3d& pose,
                     const YamlNode& multi_dof_state, const Robot& robot,
                     const std::string& frame_of_joints) {
  const std::vector<Link>& links = robot.model.links();
  const std::string& parent = links[static_cast<std::size_t>(joint.parent_link)].name;
  std::vector<std::string> known = {"", links.front().name, parent, frame_of_joints};
  for (const VirtualJoint& other : robot.virtual_joints) {
    known.push_back(WithoutSlash(other.parent_frame));
  }
  const std::string header = ReadFrame(multi_dof_state);
  const auto is_of_robot = [&](const YamlNode& name) {
    return robot.model.FindJoint(name.String()) >= 0;
  };
  if (robot.virtual_joints.empty() &&
      !std::ranges::all_of(OptionalElements(multi_dof_state, "joint_names"), is_of_robot)) {
    return;
  }
  if (std::ranges::find(known, header) != known.end() || pose.matrix().isIdentity()) return;
  FrameNode(multi_dof_state)
      .Fail("the pose of the joint '" + joint.name + "' is one in its own frame on '" + parent +
            "', not in '" + header + "'; name that link here, or none");
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
    if (NumPositions(type) == 0) return;
    RequireOwnFrame(*joint, pose, multi_dof_state, robot, fields->frame);
    AddPose(*joint, robot.model, pose, name, &fields->joints);
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

void RefuseVirtualJoint(const YamlNode& name, const Robot& robot) {
  const std::string variable = name.String();
  if (robot.model.FindJoint(variable) >= 0) return;
  for (const VirtualJoint& joint : robot.virtual_joints) {
    if (!(variable + "/").starts_with(joint.name + "/")) continue;
    name.Fail(fmt::format(
        "'{}' is of the virtual joint '{}', whose pose is read from multi_dof_joint_state, and "
        "which no plan moves; name it there alone",
        variable, joint.name));
  }
}

RobotStateFields ReadRobotState(const YamlNode& robot_state, const Robot& robot,
                                const PlanningGroup& group) {
  RobotStateFields fields;
  if (const auto joint_state = robot_state.Find("joint_state")) {
    ReadJointState(*joint_state, robot, group.space, &fields);
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
