#include "robot_model/robot_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "common/error.h"
#include "robot_model/urdf_document.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d ToEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d ToEigen(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                    pose.rotation.z);
  Isometry3d X = Isometry3d::Identity();
  X.linear() = rotation.normalized().toRotationMatrix();
  X.translation() = ToEigen(pose.position);
  return X;
}

// Turns a parsed URDF into the links and joints of a RobotModel.
class UrdfConverter {
 public:
  UrdfConverter(const UrdfDocument& document, const std::string& origin)
      : document_(document), origin_(origin) {}

  [[noreturn]] void FailLink(const std::string& link, const std::string& what) const {
    Fail(document_.link_lines, "link", link, what);
  }
  [[noreturn]] void FailJoint(const std::string& joint, const std::string& what) const {
    Fail(document_.joint_lines, "joint", joint, what);
  }

  // urdfdom accepts a link with two parents and loops that hang off nothing; a tree has neither.
  void CheckTree() const {
    std::map<std::string, std::string> parent_joint;
    for (const auto& [name, joint] : document_.model->joints_) {
      const auto [other, is_new] = parent_joint.try_emplace(joint->child_link_name, name);
      if (!is_new) {
        FailJoint(name, fmt::format("its child link '{}' is already the child of joint '{}'; a "
                                    "robot must be a tree",
                                    joint->child_link_name, other->second));
      }
    }
  }

  std::vector<urdf::JointSharedPtr> ChildJoints(const urdf::Link& link) const {
    std::vector<urdf::JointSharedPtr> children = link.child_joints;
    const auto& order = document_.joint_order;
    std::sort(children.begin(), children.end(), [&order](const auto& a, const auto& b) {
      return order.at(a->name) < order.at(b->name);
    });
    return children;
  }

  Joint ConvertJoint(const urdf::Joint& joint) const {
    if (joint.mimic != nullptr) {
      FailJoint(joint.name, "mimic joints are not supported; make it fixed, or independent");
    }
    Joint result;
    result.name = joint.name;
    result.type = ConvertType(joint);
    result.X_PJ = ToEigen(joint.parent_to_joint_origin_transform);
    if (!result.X_PJ.matrix().allFinite()) FailJoint(joint.name, "origin: is not finite");
    if (result.type == JointType::kFixed) return result;

    const Vector3d axis = ToEigen(joint.axis);
    if (!axis.allFinite() || axis.norm() < 1e-9) {
      FailJoint(joint.name, "axis: must be finite and not zero");
    }
    result.axis_J = axis.normalized();
    ConvertLimits(joint, &result);
    return result;
  }

  std::vector<PlacedShape> ConvertCollision(const urdf::Link& link) const {
    std::vector<PlacedShape> shapes;
    for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
      if (collision->geometry == nullptr) FailLink(link.name, "collision: has no geometry");
      const Isometry3d X_LS = ToEigen(collision->origin);
      if (!X_LS.matrix().allFinite()) FailLink(link.name, "collision origin: is not finite");
      shapes.push_back({ConvertGeometry(link.name, *collision->geometry), X_LS});
    }
    return shapes;
  }

 private:
  [[noreturn]] void Fail(const std::map<std::string, int>& lines, const char* kind,
                         const std::string& name, const std::string& what) const {
    const auto line = lines.find(name);
    const std::string where =
        line == lines.end() ? origin_ : fmt::format("{}:{}", origin_, line->second);
    throw InputError(fmt::format("{}: {} '{}': {}", where, kind, name, what));
  }

  JointType ConvertType(const urdf::Joint& joint) const {
    switch (joint.type) {
      case urdf::Joint::FIXED:
        return JointType::kFixed;
      case urdf::Joint::REVOLUTE:
        return JointType::kRevolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::kContinuous;
      case urdf::Joint::PRISMATIC:
        return JointType::kPrismatic;
      case urdf::Joint::FLOATING:
        FailJoint(joint.name, "type: floating joints are not supported");
      case urdf::Joint::PLANAR:
        FailJoint(joint.name, "type: planar joints are not supported");
      default:
        FailJoint(joint.name, "type: is unknown");
    }
  }

  void ConvertLimits(const urdf::Joint& joint, Joint* result) const {
    const bool bounded = result->type != JointType::kContinuous;
    if (joint.limits == nullptr) {
      if (bounded) FailJoint(joint.name, "limit: is missing; this type of joint needs one");
      result->max_velocity = 0;
    } else {
      result->max_velocity = joint.limits->velocity;
      if (!std::isfinite(result->max_velocity) || result->max_velocity < 0) {
        FailJoint(joint.name, "limit velocity: must be finite and not negative");
      }
    }
    if (!bounded) {
      result->lower = -std::numeric_limits<double>::infinity();
      result->upper = std::numeric_limits<double>::infinity();
      return;
    }
    result->lower = joint.limits->lower;
    result->upper = joint.limits->upper;
    if (!std::isfinite(result->lower) || !std::isfinite(result->upper)) {
      FailJoint(joint.name, "limit: lower and upper must be finite");
    }
    if (result->lower > result->upper) {
      FailJoint(joint.name,
                fmt::format("limit: lower {} is above upper {}", result->lower, result->upper));
    }
  }

  void CheckPositive(const std::string& link, const char* field, double value) const {
    if (!std::isfinite(value) || value <= 0) {
      FailLink(link, fmt::format("collision {}: must be greater than zero, is {}", field, value));
    }
  }

  Shape ConvertGeometry(const std::string& link, const urdf::Geometry& geometry) const {
    switch (geometry.type) {
      case urdf::Geometry::SPHERE: {
        const auto& sphere = dynamic_cast<const urdf::Sphere&>(geometry);
        CheckPositive(link, "sphere radius", sphere.radius);
        return Sphere{sphere.radius};
      }
      case urdf::Geometry::BOX: {
        const auto& box = dynamic_cast<const urdf::Box&>(geometry);
        for (const double edge : {box.dim.x, box.dim.y, box.dim.z}) {
          CheckPositive(link, "box size", edge);
        }
        return Box{ToEigen(box.dim)};
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
        CheckPositive(link, "cylinder radius", cylinder.radius);
        CheckPositive(link, "cylinder length", cylinder.length);
        return Cylinder{cylinder.radius, cylinder.length};
      }
      case urdf::Geometry::MESH: {
        const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
        if (mesh.filename.empty()) FailLink(link, "collision mesh: filename is empty");
        const Vector3d scale = ToEigen(mesh.scale);
        if (!scale.allFinite() || (scale.array() == 0).any()) {
          FailLink(link, "collision mesh scale: must be finite and not zero");
        }
        return Mesh{mesh.filename, scale, {}};
      }
      default:
        FailLink(link, "collision geometry: type is unknown");
    }
  }

  const UrdfDocument& document_;
  const std::string& origin_;
};

}  // namespace

Isometry3d JointMotion(const Joint& joint, double position) {
  Isometry3d X_JC = Isometry3d::Identity();
  if (joint.type == JointType::kPrismatic) {
    X_JC.translation() = joint.axis_J * position;
  } else if (joint.type != JointType::kFixed) {
    X_JC.linear() = Eigen::AngleAxisd(position, joint.axis_J).toRotationMatrix();
  }
  return X_JC;
}

RobotModel RobotModel::FromUrdf(const std::string& urdf_text, const std::string& origin) {
  const UrdfDocument document = ParseUrdfDocument(urdf_text, origin);
  const UrdfConverter converter(document, origin);
  converter.CheckTree();

  RobotModel model;
  model.name_ = document.model->getName();

  // Depth first, children in the order of the text: a parent comes before its children, a chain
  // stays together.
  struct Visit {
    const urdf::Link* link;
    urdf::JointSharedPtr joint;  // That leads to it; null for the root.
    int parent;
  };
  std::vector<Visit> stack = {{document.model->getRoot().get(), nullptr, -1}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const int link_index = model.num_links();
    Link link;
    link.name = visit.link->name;
    link.collision = converter.ConvertCollision(*visit.link);
    if (visit.joint != nullptr) {
      Joint joint = converter.ConvertJoint(*visit.joint);
      joint.parent_link = visit.parent;
      joint.child_link = link_index;
      if (joint.type != JointType::kFixed) joint.position_index = model.num_positions_++;
      link.parent_joint = static_cast<int>(model.joints_.size());
      model.links_[static_cast<std::size_t>(visit.parent)].child_joints.push_back(
          link.parent_joint);
      model.joint_index_.emplace(joint.name, link.parent_joint);
      model.joints_.push_back(std::move(joint));
    }
    model.link_index_.emplace(link.name, link_index);
    model.links_.push_back(std::move(link));

    const std::vector<urdf::JointSharedPtr> children = converter.ChildJoints(*visit.link);
    for (auto joint = children.rbegin(); joint != children.rend(); ++joint) {
      const urdf::LinkConstSharedPtr child = document.model->getLink((*joint)->child_link_name);
      stack.push_back({child.get(), *joint, link_index});
    }
  }

  for (const auto& [name, link] : document.model->links_) {
    if (model.FindLink(name) < 0) {
      converter.FailLink(
          name, fmt::format("is not connected to the root link '{}'", model.links_.front().name));
    }
  }
  return model;
}

int RobotModel::FindLink(const std::string& name) const {
  const auto entry = link_index_.find(name);
  return entry == link_index_.end() ? -1 : entry->second;
}

int RobotModel::FindJoint(const std::string& name) const {
  const auto entry = joint_index_.find(name);
  return entry == joint_index_.end() ? -1 : entry->second;
}

bool RobotModel::Adjacent(int link_a, int link_b) const {
  const auto is_parent_of = [this](int parent, int child) {
    const int joint = links_[static_cast<std::size_t>(child)].parent_joint;
    return joint >= 0 && joints_[static_cast<std::size_t>(joint)].parent_link == parent;
  };
  return is_parent_of(link_a, link_b) || is_parent_of(link_b, link_a);
}

std::vector<double> RobotModel::DefaultPositions() const {
  std::vector<double> positions(static_cast<std::size_t>(num_positions_), 0.0);
  for (const Joint& joint : joints_) {
    if (joint.position_index < 0) continue;
    positions[static_cast<std::size_t>(joint.position_index)] =
        std::clamp(0.0, joint.lower, joint.upper);
  }
  return positions;
}

PlanningGroup RobotModel::MakeGroup(const std::string& name,
                                    const std::vector<std::string>& joint_names,
                                    const std::string& tip_link) const {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("group '{}' of robot '{}': {}", name, name_, what));
  };
  if (joint_names.empty()) fail("has no joints");
  PlanningGroup group;
  group.name = name;
  group.tip_link = FindLink(tip_link);
  if (group.tip_link < 0) fail(fmt::format("tip link '{}' is unknown", tip_link));

  std::set<std::string> seen;
  std::vector<JointSpace::Joint> space;
  for (const std::string& joint_name : joint_names) {
    const int index = FindJoint(joint_name);
    if (index < 0) fail(fmt::format("joint '{}' is unknown", joint_name));
    const Joint& joint = joints_[static_cast<std::size_t>(index)];
    if (joint.type == JointType::kFixed) fail(fmt::format("joint '{}' is fixed", joint_name));
    if (!seen.insert(joint_name).second) fail(fmt::format("joint '{}' is repeated", joint_name));
    const bool continuous = joint.type == JointType::kContinuous;
    group.joints.push_back(index);
    space.push_back({.name = joint.name,
                     .continuous = continuous,
                     .prismatic = joint.type == JointType::kPrismatic,
                     .lower = continuous ? -std::numbers::pi : joint.lower,
                     .upper = continuous ? std::numbers::pi : joint.upper,
                     .max_velocity = joint.max_velocity});
  }
  group.space = JointSpace(std::move(space));
  return group;
}

std::vector<Isometry3d> ComputeLinkPoses(const RobotModel& model,
                                         std::span<const double> positions) {
  std::vector<Isometry3d> X_BL(static_cast<std::size_t>(model.num_links()), Isometry3d::Identity());
  // Joints come in the order of their child links, parents first.
  for (const Joint& joint : model.joints()) {
    const double position =
        joint.position_index < 0 ? 0.0 : positions[static_cast<std::size_t>(joint.position_index)];
    X_BL[static_cast<std::size_t>(joint.child_link)] =
        X_BL[static_cast<std::size_t>(joint.parent_link)] * joint.X_PJ *
        JointMotion(joint, position);
  }
  return X_BL;
}

}  // namespace planbench
