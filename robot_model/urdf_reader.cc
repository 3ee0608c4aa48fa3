#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>

#include "common/error.h"
#include "robot_model/odd_size.h"
#include "robot_model/robot_model.h"
#include "robot_model/urdf_document.h"
#include "robot_model/urdf_remarks.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Limits that differ by less were meant to be the same (rad or m).
constexpr double kLimitRounding = 1e-9;
// Beyond, rad or m, limits are none.
constexpr double kWidestLimit = 1e4;
// No joint is slower, rad/s or m/s: a smaller limit stands for none. Nor is one faster.
constexpr double kSlowestJoint = 1e-4;
constexpr double kFastestJoint = 1e4;
// What turns further from zero, rad, is rare: limits in degrees are likelier.
constexpr double kFurthestTurn = 4 * 2 * std::numbers::pi;
// No part of a robot is larger, or further from the next, m.
constexpr double kGreatestLength = 1e3;

Vector3d ToEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d ToEigen(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                    pose.rotation.z);
  Isometry3d X = Isometry3d::Identity();
  X.linear() = rotation.normalized().toRotationMatrix();
  X.translation() = ToEigen(pose.position);
  return X;
}

std::string TooLarge(double length) {
  return fmt::format("{:g} m is more than the {:g} m of the largest robots; URDFs are in metres",
                     length, kGreatestLength);
}

// What is wrong with a pose of an <origin>; "" for nothing.
std::string FaultOf(const Isometry3d& X) {
  if (!X.matrix().allFinite()) return "is not finite";
  const double furthest = X.translation().cwiseAbs().maxCoeff();
  return furthest > kGreatestLength ? TooLarge(furthest) : "";
}

// Turns a parsed URDF into the links and joints of a RobotModel.
class UrdfConverter {
 public:
  UrdfConverter(const UrdfDocument& document, const std::string& origin)
      : document_(document), origin_(origin) {}

  std::string WhereLink(const std::string& link) const {
    return Where(document_.link_lines, "link", link);
  }
  std::string WhereJoint(const std::string& joint) const {
    return Where(document_.joint_lines, "joint", joint);
  }
  [[noreturn]] void FailLink(const std::string& link, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", WhereLink(link), what));
  }
  [[noreturn]] void FailJoint(const std::string& joint, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", WhereJoint(joint), what));
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

  Joint ConvertJoint(const urdf::Joint& joint) {
    Joint result;
    result.name = joint.name;
    result.where = WhereJoint(joint.name);
    result.type = ConvertType(joint);
    result.X_PJ = ToEigen(joint.parent_to_joint_origin_transform);
    if (const std::string what = FaultOf(result.X_PJ); !what.empty()) {
      FailJoint(joint.name, "origin: " + what);
    }
    if (result.type == JointType::kFixed) result.axis_J = AxisOfFixed(joint.name);
    if (NumPositions(result.type) != 1) return result;

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
    const auto capsules = document_.capsules.find(link.name);
    int index = 0;
    for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
      if (collision->geometry == nullptr) FailLink(link.name, "collision: has no geometry");
      const Isometry3d X_LS = ToEigen(collision->origin);
      if (const std::string what = FaultOf(X_LS); !what.empty()) {
        FailLink(link.name, "collision origin: " + what);
      }
      shapes.push_back({ConvertGeometry(link.name, *collision->geometry), X_LS});
      if (capsules != document_.capsules.end() && capsules->second.contains(index++)) {
        AddCaps(&shapes);
      }
    }
    return shapes;
  }

  // The mimic tag of a joint, null if it has none. One of a fixed joint says nothing.
  const urdf::JointMimic* MimicOf(const Joint& joint) const {
    const urdf::JointMimic* mimic = document_.model->getJoint(joint.name)->mimic.get();
    if (mimic == nullptr || joint.type == JointType::kFixed) return nullptr;
    if (NumPositions(joint.type) != 1) FailJoint(joint.name, "mimic: such a joint follows none");
    if (!std::isfinite(mimic->multiplier) || !std::isfinite(mimic->offset)) {
      FailJoint(joint.name, "mimic: multiplier and offset must be finite");
    }
    return mimic;
  }

  /// What was decided of joints, a line for all that it was decided of.
  std::vector<std::string> Notes() const {
    std::vector<std::string> notes;
    for (const auto& [decision, joints] : decided_) {
      notes.push_back(fmt::format("{}: {}: {}", origin_, decision, fmt::join(joints, ", ")));
    }
    return notes;
  }

 private:
  // What it turned about or moved along before it was fixed; zero if its description does not tell.
  Vector3d AxisOfFixed(const std::string& joint) const {
    const auto text = document_.joint_axes.find(joint);
    if (text == document_.joint_axes.end()) return Vector3d::Zero();
    urdf::Vector3 axis;
    try {
      axis.init(text->second);
    } catch (const urdf::ParseError&) {
      return Vector3d::Zero();
    }
    const Vector3d direction = ToEigen(axis).normalized();
    return direction.allFinite() ? direction : Vector3d(Vector3d::Zero());
  }

  std::string Where(const std::map<std::string, int>& lines, const char* kind,
                    const std::string& name) const {
    const auto line = lines.find(name);
    const std::string file =
        line == lines.end() ? origin_ : fmt::format("{}:{}", origin_, line->second);
    return fmt::format("{}: {} '{}'", file, kind, name);
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
        return JointType::kFloating;
      case urdf::Joint::PLANAR:
        return JointType::kPlanar;
      default:
        FailJoint(joint.name, "type: is unknown");
    }
  }

  void ConvertLimits(const urdf::Joint& joint, Joint* result) {
    const bool bounded = result->type != JointType::kContinuous;
    if (joint.limits == nullptr) {
      if (bounded) FailJoint(joint.name, "limit: is missing; this type of joint needs one");
      result->max_velocity = 0;
    } else {
      result->max_velocity = joint.limits->velocity;
      if (!std::isfinite(result->max_velocity) || result->max_velocity < 0) {
        FailJoint(joint.name, "limit velocity: must be finite and not negative");
      }
      result->max_velocity = std::min(result->max_velocity, kFastestJoint);
      if (result->max_velocity > 0 && result->max_velocity < kSlowestJoint) {
        Decide(fmt::format("limits of velocity below {:g} count as none given, that is as 1 rad/s "
                           "or m/s",
                           kSlowestJoint),
               fmt::format("{} ({:g})", joint.name, result->max_velocity));
        result->max_velocity = 0;
      }
    }
    if (bounded) {
      result->lower = joint.limits->lower;
      result->upper = joint.limits->upper;
      if (!std::isfinite(result->lower) || !std::isfinite(result->upper)) {
        FailJoint(joint.name, "limit: lower and upper must be finite");
      }
      if (result->lower > result->upper) {
        FailJoint(joint.name,
                  fmt::format("limit: lower {} is above upper {}", result->lower, result->upper));
      }
    } else {
      result->lower = -std::numeric_limits<double>::infinity();
      result->upper = std::numeric_limits<double>::infinity();
      if (joint.limits != nullptr && joint.limits->lower != joint.limits->upper) {
        Decide(
            "lower and upper limits bound no continuous joint, and do not count; one that has "
            "limits is revolute",
            fmt::format("{} ([{:g}, {:g}])", joint.name, joint.limits->lower, joint.limits->upper));
      }
    }
    if (joint.safety != nullptr) ApplySoftLimits(*joint.safety, result);
  }

  void ApplySoftLimits(const urdf::JointSafety& safety, Joint* joint) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const bool has_lower = document_.with_soft_lower.contains(joint->name);
    const bool has_upper = document_.with_soft_upper.contains(joint->name);
    const double lower = has_lower ? safety.soft_lower_limit : -kInfinity;
    const double upper = has_upper ? safety.soft_upper_limit : kInfinity;
    if (lower == 0 && upper == 0) return;  // So exporters write that there are none.
    if (joint->type == JointType::kContinuous && has_lower != has_upper) {
      Decide(
          "a soft limit (safety_controller) on one side bounds no continuous joint, and does "
          "not count",
          joint->name);
      return;
    }
    if (!(lower <= upper)) {
      FailJoint(joint->name, fmt::format("safety_controller: soft lower limit {} is above the "
                                         "upper {}",
                                         lower, upper));
    }
    if (lower > joint->upper || upper < joint->lower) {
      FailJoint(joint->name, fmt::format("safety_controller: the soft limits [{:g}, {:g}] lie "
                                         "outside the limits [{:g}, {:g}]",
                                         lower, upper, joint->lower, joint->upper));
    }
    if ((has_lower && lower < joint->lower - kLimitRounding) ||
        (has_upper && upper > joint->upper + kLimitRounding)) {
      Decide("soft limits (safety_controller) beyond the limits do not count", joint->name);
    }
    if (lower <= joint->lower + kLimitRounding && upper >= joint->upper - kLimitRounding) return;
    joint->lower = std::max(joint->lower, lower);
    joint->upper = std::min(joint->upper, upper);
    if (joint->type == JointType::kContinuous) joint->type = JointType::kRevolute;
    Decide("soft limits (safety_controller) narrow",
           fmt::format("{} to [{:g}, {:g}]", joint->name, joint->lower, joint->upper));
  }

  void Decide(const std::string& decision, const std::string& joint) {
    decided_[decision].push_back(joint);
  }

  void CheckLength(const std::string& link, const char* field, double value) const {
    if (!std::isfinite(value) || value <= 0) {
      FailLink(link, fmt::format("collision {}: must be greater than zero, is {}", field, value));
    }
    if (value > kGreatestLength) {
      FailLink(link, fmt::format("collision {}: {}", field, TooLarge(value)));
    }
  }

  Shape ConvertGeometry(const std::string& link, const urdf::Geometry& geometry) const {
    switch (geometry.type) {
      case urdf::Geometry::SPHERE: {
        const auto& sphere = dynamic_cast<const urdf::Sphere&>(geometry);
        CheckLength(link, "sphere radius", sphere.radius);
        return Sphere{sphere.radius};
      }
      case urdf::Geometry::BOX: {
        const auto& box = dynamic_cast<const urdf::Box&>(geometry);
        for (const double edge : {box.dim.x, box.dim.y, box.dim.z}) {
          CheckLength(link, "box size", edge);
        }
        return Box{ToEigen(box.dim)};
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
        CheckLength(link, "cylinder radius", cylinder.radius);
        CheckLength(link, "cylinder length", cylinder.length);
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

  // Makes a capsule of the cylinder that came last: no engine takes capsules as parts of a link.
  static void AddCaps(std::vector<PlacedShape>* shapes) {
    const PlacedShape last = shapes->back();
    const auto* cylinder = std::get_if<Cylinder>(&last.shape);
    if (cylinder == nullptr) return;  // Only in text that is not quite XML.
    for (const double z : {-cylinder->length / 2, cylinder->length / 2}) {
      shapes->push_back({Sphere{cylinder->radius}, last.X_FS * Eigen::Translation3d(0, 0, z)});
    }
  }

  const UrdfDocument& document_;
  const std::string& origin_;
  std::map<std::string, std::vector<std::string>> decided_;  // Of which joints, by what.
};

std::vector<std::string> PositionNames(const Joint& joint) {
  if (NumPositions(joint.type) == 1) return {joint.name};
  std::vector<std::string> names;
  for (const char* part : {"trans_x", "trans_y", "trans_z", "rot_x", "rot_y", "rot_z", "rot_w"}) {
    names.push_back(joint.name + "/" + part);
  }
  return names;
}

// Finds the leader of joint `index`, which `of` says is a follower: over a chain of followers to a
// joint that is none. Throws for circles and unknown names.
void FollowLeaders(const UrdfConverter& converter, const RobotModel& model, std::size_t index,
                   Joint* follower) {
  double multiplier = 1;
  double offset = 0;
  std::vector<std::string> chain;
  int at = static_cast<int>(index);
  while (true) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(at)];
    if (std::find(chain.begin(), chain.end(), joint.name) != chain.end()) {
      chain.push_back(joint.name);
      converter.FailJoint(follower->name, fmt::format("mimic: the joints follow each other in a "
                                                      "circle: {}",
                                                      fmt::join(chain, ", ")));
    }
    chain.push_back(joint.name);
    const urdf::JointMimic* mimic = converter.MimicOf(joint);
    if (mimic == nullptr) break;
    at = model.FindJoint(mimic->joint_name);
    if (at < 0) {
      converter.FailJoint(joint.name,
                          fmt::format("mimic: the joint '{}' is unknown", mimic->joint_name));
    }
    offset += multiplier * mimic->offset;
    multiplier *= mimic->multiplier;
  }
  const Joint& leader = model.joints()[static_cast<std::size_t>(at)];
  if (NumPositions(leader.type) > 1) {
    converter.FailJoint(
        follower->name,
        fmt::format("mimic: the joint '{}' has a pose, not a position", leader.name));
  }
  follower->leader = at;
  follower->multiplier = multiplier;
  follower->offset = offset;
  follower->position_index = leader.position_index;
}

// Narrows limits that stand for "none", 1e16 for example: nothing can be planned over such a range.
// A note of that, and of limits that leave no range; "" for nothing. Of a follower's limits
// KeepWithinLimits tells.
std::string KeepWithinReason(Joint* joint) {
  if (NumPositions(joint->type) != 1 || joint->type == JointType::kContinuous) return "";
  const double lower = joint->lower;
  const double upper = joint->upper;
  if (lower == upper) {
    return joint->leader >= 0 ? ""
                              : fmt::format("its limits leave it no range: both are {}", lower);
  }
  if (lower > kWidestLimit || upper < -kWidestLimit) return "";
  joint->lower = std::max(lower, -kWidestLimit);
  joint->upper = std::min(upper, kWidestLimit);
  if (joint->lower == lower && joint->upper == upper) return "";
  return fmt::format("its limits [{}, {}] are too wide to plan in; they count as [{}, {}]", lower,
                     upper, joint->lower, joint->upper);
}

// How far from zero the limits of a joint reach, unless they stand for none.
double FurthestLimit(const Joint& joint) {
  const double furthest = std::max(-joint.lower, joint.upper);
  return furthest > kWidestLimit ? 0 : furthest;
}

// Why the limits of a joint are probably in degrees; "" if they are not.
std::string DoubtRadians(const Joint& joint) {
  if (joint.type != JointType::kRevolute || FurthestLimit(joint) <= kFurthestTurn) return "";
  return fmt::format(
      "its limits [{}, {}] reach {:.3g} turns from zero; are they degrees? URDFs are in radians",
      joint.lower, joint.upper, FurthestLimit(joint) / (2 * std::numbers::pi));
}

// Why the origin of a joint, or its limits, are probably in millimetres; "" if they are not.
std::string DoubtMetres(const Joint& joint) {
  constexpr const char* kMillimetres = "are they millimetres? URDFs are in metres";
  const Vector3d& p = joint.X_PJ.translation();
  if (p.cwiseAbs().maxCoeff() > kGreatestExtent) {
    return fmt::format("its origin is at [{}, {}, {}] m; {}", p.x(), p.y(), p.z(), kMillimetres);
  }
  if (joint.type != JointType::kPrismatic || FurthestLimit(joint) <= kGreatestExtent) return "";
  return fmt::format("its limits [{}, {}] reach {:g} m from zero; {}", joint.lower, joint.upper,
                     FurthestLimit(joint), kMillimetres);
}

// A note on the joints that there is a doubt of, which it tells of the first; "" for none.
std::string RemarkUnit(const std::vector<Joint>& joints, std::string (*doubt)(const Joint&)) {
  std::string note;
  std::vector<std::string> others;
  for (const Joint& joint : joints) {
    const std::string here = doubt(joint);
    if (here.empty()) continue;
    if (note.empty()) {
      note = fmt::format("{}: {}", joint.where, here);
    } else {
      others.push_back(joint.name);
    }
  }
  if (!others.empty()) note += fmt::format("; likewise {}", fmt::join(others, ", "));
  return note;
}

// Whether a follower never moves, as its leader does not, or moves it by nothing.
bool StandsStill(const Joint& follower, const Joint& leader) {
  return follower.multiplier == 0 || leader.upper - leader.lower <= kLimitRounding;
}

// A note on a follower that stands still out of its limits; "" for none.
std::string RemarkStanding(const Joint& follower, const Joint& leader) {
  if (!StandsStill(follower, leader)) return "";
  // The lower limit of a leader that turns for ever is none.
  const double led = follower.multiplier == 0 ? 0 : follower.multiplier * leader.lower;
  const double at = led + follower.offset;
  if (at >= follower.lower - kLimitRounding && at <= follower.upper + kLimitRounding) return "";
  return fmt::format(
      "it stands still at {:g}, out of its limits [{:g}, {:g}], which do not count, as it follows "
      "joint '{}'{}",
      at, follower.lower, follower.upper, leader.name,
      follower.multiplier == 0 ? " with the multiplier 0" : ", which does not move");
}

// Keeps a leader where its follower is within its limits, and gives the follower the range it then
// has. A note of what changes, "" for nothing: a follower whose limits leave no range at all has
// wrong ones (signs that do not fit the multiplier are common), and is not heeded.
std::string KeepWithinLimits(Joint* follower, Joint* leader) {
  const double m = follower->multiplier;
  std::string note;
  if (!StandsStill(*follower, *leader) && std::isfinite(follower->lower)) {
    const double a = (follower->lower - follower->offset) / m;
    const double b = (follower->upper - follower->offset) / m;
    const double lower = std::max({leader->lower, std::min(a, b), -kWidestLimit});
    const double upper = std::min({leader->upper, std::max(a, b), kWidestLimit});
    if (upper - lower <= kLimitRounding) {
      note = fmt::format(
          "the limits of joint '{}', which follows it, contradict its own; they do "
          "not count",
          follower->name);
    } else if (lower > leader->lower + kLimitRounding || upper < leader->upper - kLimitRounding) {
      leader->lower = lower;
      leader->upper = upper;
      if (leader->type == JointType::kContinuous) leader->type = JointType::kRevolute;
      note = fmt::format("the limits of joint '{}', which follows it, leave it [{}, {}]",
                         follower->name, lower, upper);
    }
  }
  return note;
}

}  // namespace

RobotModel RobotModel::FromUrdf(const std::string& urdf_text, const std::string& origin,
                                std::vector<std::string>* warnings) {
  const UrdfDocument document = ParseUrdfDocument(urdf_text, origin);
  UrdfConverter converter(document, origin);
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
    link.where = converter.WhereLink(link.name);
    link.collision = converter.ConvertCollision(*visit.link);
    link.body = link_index;
    if (visit.joint != nullptr) {
      Joint joint = converter.ConvertJoint(*visit.joint);
      joint.parent_link = visit.parent;
      joint.child_link = link_index;
      if (joint.type != JointType::kFixed && converter.MimicOf(joint) == nullptr) {
        joint.position_index = model.num_positions();
        const std::vector<std::string> names = PositionNames(joint);
        model.position_names_.insert(model.position_names_.end(), names.begin(), names.end());
      }
      if (joint.type == JointType::kFixed) {
        link.body = model.links_[static_cast<std::size_t>(visit.parent)].body;
      }
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

  std::vector<std::string> notes = RemarkUnheeded(urdf_text, origin);
  std::ranges::move(converter.Notes(), std::back_inserter(notes));
  for (std::size_t j = 0; j < model.joints_.size(); ++j) {
    if (converter.MimicOf(model.joints_[j]) == nullptr) continue;
    FollowLeaders(converter, model, j, &model.joints_[j]);
  }
  for (const auto& doubt : {DoubtRadians, DoubtMetres}) {
    const std::string note = RemarkUnit(model.joints_, doubt);
    if (!note.empty()) notes.push_back(note);
  }
  const auto note_of = [&](const Joint& joint, const std::string& note) {
    if (!note.empty()) notes.push_back(joint.where + ": " + note);
  };
  for (Joint& joint : model.joints_) note_of(joint, KeepWithinReason(&joint));
  for (Joint& joint : model.joints_) {
    if (joint.leader < 0) continue;
    Joint& leader = model.joints_[static_cast<std::size_t>(joint.leader)];
    note_of(joint, RemarkStanding(joint, leader));
    note_of(leader, KeepWithinLimits(&joint, &leader));
  }
  // Only now, when all followers have had their say.
  for (Joint& joint : model.joints_) {
    if (joint.position_index < 0 || joint.leader < 0) continue;
    const Joint& leader = model.joints_[static_cast<std::size_t>(joint.leader)];
    const double a = joint.multiplier == 0 ? 0 : joint.multiplier * leader.lower;
    const double b = joint.multiplier == 0 ? 0 : joint.multiplier * leader.upper;
    joint.lower = std::min(a, b) + joint.offset;
    joint.upper = std::max(a, b) + joint.offset;
  }
  if (warnings != nullptr) warnings->insert(warnings->end(), notes.begin(), notes.end());
  return model;
}

}  // namespace planbench
