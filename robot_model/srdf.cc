#include "robot_model/srdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "common/error.h"
#include "robot_model/xml_text.h"

namespace planbench {
namespace {

using Element = tinyxml2::XMLElement;

// Elements of a robot that say nothing of how it plans.
const std::set<std::string>& IgnoredElements() {
  static const std::set<std::string> names = {"passive_joint", "joint_property"};
  return names;
}

class SrdfReader {
 public:
  SrdfReader(const std::string& text, const std::string& origin, const RobotModel& model)
      : origin_(origin), model_(model) {
    CheckXmlText(text, origin);
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      throw InputError(fmt::format("{}:{}: not a valid SRDF: {}", origin, document_.ErrorLineNum(),
                                   tinyxml2::XMLDocument::ErrorIDToName(document_.ErrorID())));
    }
    root_ = document_.RootElement();
    if (root_ == nullptr || root_->Name() != std::string("robot")) {
      throw InputError(fmt::format("{}:{}: not an SRDF: expected <robot>", origin,
                                   root_ == nullptr ? 1 : root_->GetLineNum()));
    }
    robot_name_ = Attribute(*root_, "name");
  }

  Srdf Read() {
    WarnOfUnknownElements();
    FindPassiveJoints(*root_);
    for (const Element* e : Children(*root_, "virtual_joint")) ReadVirtualJoint(*e);
    ReadGroups();
    for (const Element* e : Children(*root_, "end_effector")) ReadEndEffector(*e);
    for (const Element* e : Children(*root_, "group_state")) ReadState(*e);
    ReadDisabledPairs();
    for (const Element* e : Children(*root_, "link_sphere_approximation")) ReadSpheres(*e);
    std::stable_sort(srdf_.spheres.begin(), srdf_.spheres.end(),
                     [](const LinkSphere& a, const LinkSphere& b) { return a.link < b.link; });
    return std::move(srdf_);
  }

 private:
  struct Members {
    std::set<int> joints;  // In URDF order.
    std::vector<std::string> tips;
  };

  std::string Where(const Element& element) const {
    return fmt::format("{}:{}", origin_, element.GetLineNum());
  }
  [[noreturn]] void Fail(const Element& element, const std::string& what) const {
    throw InputError(fmt::format("{}: <{}>: {}", Where(element), element.Name(), what));
  }
  // Of a link or joint that the robot does not have.
  [[noreturn]] void FailUnknown(const Element& element, const char* kind,
                                const std::string& name) const {
    Fail(element, fmt::format("the URDF of robot '{}' has no {} '{}'{}", model_.name(), kind, name,
                              robot_name_ == model_.name()
                                  ? ""
                                  : fmt::format("; this is the SRDF of '{}'", robot_name_)));
  }

  static std::vector<const Element*> Children(const Element& parent, const char* name) {
    std::vector<const Element*> children;
    for (const Element* e = parent.FirstChildElement(name); e != nullptr;
         e = e->NextSiblingElement(name)) {
      children.push_back(e);
    }
    return children;
  }
  std::string Attribute(const Element& element, const char* name) const {
    const char* value = element.Attribute(name);
    if (value == nullptr || *value == 0) {
      Fail(element, fmt::format("the attribute '{}' is missing", name));
    }
    return value;
  }
  std::vector<double> Numbers(const Element& element, const char* name, std::size_t count) const {
    std::istringstream text(Attribute(element, name));
    std::vector<double> numbers;
    for (double number = 0; text >> number;) numbers.push_back(number);
    if (!text.eof() || numbers.size() != count ||
        !std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); })) {
      Fail(element, fmt::format("{}: expected {} number{}, found '{}'", name, count,
                                count == 1 ? "" : "s", Attribute(element, name)));
    }
    return numbers;
  }
  int LinkAt(const Element& element, const char* attribute) const {
    const std::string name = Attribute(element, attribute);
    const int link = model_.FindLink(name);
    if (link < 0) FailUnknown(element, "link", name);
    return link;
  }
  const std::string& LinkName(int link) const {
    return model_.links()[static_cast<std::size_t>(link)].name;
  }
  const Joint& JointAt(int joint) const { return model_.joints()[static_cast<std::size_t>(joint)]; }
  int ParentJoint(int link) const {
    return model_.links()[static_cast<std::size_t>(link)].parent_joint;
  }

  void WarnOfUnknownElements() {
    static const std::set<std::string> read = {"group",
                                               "group_state",
                                               "end_effector",
                                               "virtual_joint",
                                               "disable_collisions",
                                               "link_sphere_approximation",
                                               "enable_collisions",
                                               "disable_default_collisions"};
    for (const Element* e = root_->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (read.contains(e->Name()) || IgnoredElements().contains(e->Name())) continue;
      srdf_.warnings.push_back(
          fmt::format("{}: <{}> is not known and does not count", Where(*e), e->Name()));
    }
  }

  // They stand beside groups, and in some files in them.
  void FindPassiveJoints(const Element& parent) {
    for (const Element* e : Children(parent, "passive_joint"))
      passive_.insert(Attribute(*e, "name"));
    for (const Element* group : Children(parent, "group")) FindPassiveJoints(*group);
  }

  void ReadVirtualJoint(const Element& element) {
    Srdf::VirtualJoint joint{Attribute(element, "name"), Attribute(element, "type"),
                             Attribute(element, "parent_frame"),
                             LinkName(LinkAt(element, "child_link"))};
    if (joint.type != "fixed" && joint.type != "planar" && joint.type != "floating") {
      Fail(element,
           fmt::format("type: expected fixed, planar or floating, found '{}'", joint.type));
    }
    srdf_.virtual_joints.push_back(std::move(joint));
  }

  void ReadGroups() {
    for (const Element* e : Children(*root_, "group")) {
      const std::string name = Attribute(*e, "name");
      if (!groups_.emplace(name, e).second) {
        Fail(*e, fmt::format("the group '{}' occurs twice", name));
      }
    }
    for (const Element* e : Children(*root_, "group")) ReadGroup(*e);
  }

  void ReadGroup(const Element& element) {
    const std::string name = Attribute(element, "name");
    Members members = MembersOf(element, {});
    std::vector<std::string> joints;
    std::vector<std::string> held;
    for (const int index : members.joints) {
      const Joint& joint = JointAt(index);
      if (joint.type == JointType::kFixed || joint.leader >= 0) continue;
      const bool can_plan = NumPositions(joint.type) == 1 && !passive_.contains(joint.name);
      (can_plan ? joints : held).push_back(joint.name);
    }
    if (!held.empty()) {
      srdf_.left_out.push_back(fmt::format(
          "{}: group '{}': {} held where problems say (passive, planar or floating): {}",
          Where(element), name, held.size() == 1 ? "a joint is" : "joints are",
          fmt::join(held, ", ")));
    }
    if (joints.empty()) {
      srdf_.left_out.push_back(fmt::format("{}: group '{}' has no joint that can be planned with",
                                           Where(element), name));
      return;
    }
    if (members.tips.empty()) members.tips = OutermostLinks(joints);
    const std::vector<std::string> more(members.tips.begin() + 1, members.tips.end());
    try {
      srdf_.groups.push_back(model_.MakeGroup(name, joints, members.tips.front(), more));
    } catch (const InputError& error) {
      Fail(element, error.what());
    }
  }

  Members MembersOf(const Element& group, std::vector<std::string> path) const {
    const std::string name = Attribute(group, "name");
    if (std::find(path.begin(), path.end(), name) != path.end()) {
      Fail(group,
           fmt::format("the groups are parts of each other: {}, {}", fmt::join(path, ", "), name));
    }
    path.push_back(name);
    if (group.FirstChildElement() == nullptr) {
      Fail(group,
           fmt::format("the group '{}' has no joints: name chains, joints, links or groups", name));
    }
    Members members;
    for (const Element* e : Children(group, "joint")) {
      const std::string joint_name = Attribute(*e, "name");
      const int joint = model_.FindJoint(joint_name);
      const auto is_it = [&](const Srdf::VirtualJoint& v) { return v.name == joint_name; };
      if (joint >= 0) {
        members.joints.insert(joint);
      } else if (std::none_of(srdf_.virtual_joints.begin(), srdf_.virtual_joints.end(), is_it)) {
        FailUnknown(*e, "joint", joint_name);
      }
    }
    for (const Element* e : Children(group, "link")) {
      const int joint = ParentJoint(LinkAt(*e, "name"));
      if (joint >= 0) members.joints.insert(joint);
    }
    for (const Element* e : Children(group, "chain")) AddChain(*e, &members);
    for (const Element* e : Children(group, "group")) {
      const auto part = groups_.find(Attribute(*e, "name"));
      if (part == groups_.end()) {
        Fail(*e, fmt::format("there is no group '{}'", Attribute(*e, "name")));
      }
      Members others = MembersOf(*part->second, path);
      members.joints.merge(others.joints);
      for (const std::string& tip : others.tips) AddTip(tip, &members);
    }
    return members;
  }

  void AddChain(const Element& element, Members* members) const {
    const int base = LinkAt(element, "base_link");
    const int tip = LinkAt(element, "tip_link");
    int link = tip;
    while (link != base) {
      const int joint = ParentJoint(link);
      if (joint < 0) {
        Fail(element, fmt::format("no chain of joints leads from link '{}' out to link '{}'",
                                  LinkName(base), LinkName(tip)));
      }
      members->joints.insert(joint);
      link = JointAt(joint).parent_link;
    }
    AddTip(LinkName(tip), members);
  }

  static void AddTip(const std::string& tip, Members* members) {
    auto& tips = members->tips;
    if (std::find(tips.begin(), tips.end(), tip) == tips.end()) tips.push_back(tip);
  }

  // Child links of joints below which there is no other joint of the list.
  std::vector<std::string> OutermostLinks(const std::vector<std::string>& joints) const {
    std::set<int> has_more_below;
    for (const std::string& name : joints) {
      for (int link = JointAt(model_.FindJoint(name)).parent_link; ParentJoint(link) >= 0;
           link = JointAt(ParentJoint(link)).parent_link) {
        has_more_below.insert(ParentJoint(link));
      }
    }
    std::vector<std::string> tips;
    for (const std::string& name : joints) {
      const int joint = model_.FindJoint(name);
      if (!has_more_below.contains(joint)) tips.push_back(LinkName(JointAt(joint).child_link));
    }
    return tips;
  }

  void ReadEndEffector(const Element& element) {
    const char* parent_group = element.Attribute("parent_group");
    Srdf::EndEffector effector{Attribute(element, "name"), Attribute(element, "group"),
                               LinkName(LinkAt(element, "parent_link")),
                               parent_group == nullptr ? "" : parent_group};
    for (const std::string& group : {effector.group, effector.parent_group}) {
      if (!group.empty() && !groups_.contains(group)) {
        Fail(element, fmt::format("there is no group '{}'", group));
      }
    }
    srdf_.end_effectors.push_back(std::move(effector));
  }

  void ReadState(const Element& element) {
    const std::string name = Attribute(element, "name");
    const std::string group_name = Attribute(element, "group");
    if (!groups_.contains(group_name)) {
      Fail(element, fmt::format("there is no group '{}'", group_name));
    }
    const auto group = std::find_if(srdf_.groups.begin(), srdf_.groups.end(),
                                    [&](const PlanningGroup& g) { return g.name == group_name; });
    if (group == srdf_.groups.end()) return;  // It was left out.
    const std::vector<double> defaults = model_.DefaultPositions();
    std::vector<double> q;
    for (const int joint : group->joints) {
      q.push_back(defaults[static_cast<std::size_t>(JointAt(joint).position_index)]);
    }
    std::vector<std::string> ignored;
    for (const Element* e : Children(element, "joint")) {
      const std::string joint_name = Attribute(*e, "name");
      const auto joint =
          std::find(group->joints.begin(), group->joints.end(), model_.FindJoint(joint_name));
      if (joint == group->joints.end()) {
        ignored.push_back(joint_name);
        continue;
      }
      q[static_cast<std::size_t>(joint - group->joints.begin())] = Numbers(*e, "value", 1).front();
    }
    if (!ignored.empty()) {
      srdf_.left_out.push_back(fmt::format("{}: state '{}': the group '{}' is not planned with {}",
                                           Where(element), name, group_name,
                                           fmt::join(ignored, ", ")));
    }
    group->states[name] = std::move(q);
  }

  void ReadDisabledPairs() {
    std::set<std::pair<int, int>> pairs;
    std::set<std::string> unknown;
    int num_unknown = 0;
    const auto link = [&](const Element& element, const char* attribute) {
      const std::string name = Attribute(element, attribute);
      const int index = model_.FindLink(name);
      if (index < 0) unknown.insert(name);
      return index;
    };
    const auto pair = [&](const Element& element) -> std::optional<std::pair<int, int>> {
      const int a = link(element, "link1");
      const int b = link(element, "link2");
      if (a < 0 || b < 0) ++num_unknown;
      if (a < 0 || b < 0 || a == b) return std::nullopt;
      return std::minmax(a, b);
    };
    for (const Element* e : Children(*root_, "disable_default_collisions")) {
      const int a = link(*e, "link");
      for (int b = 0; a >= 0 && b < model_.num_links(); ++b) {
        if (a != b) pairs.insert(std::minmax(a, b));
      }
    }
    for (const Element* e : Children(*root_, "enable_collisions")) {
      if (const auto enabled = pair(*e)) pairs.erase(*enabled);
    }
    const std::vector<const Element*> disabled = Children(*root_, "disable_collisions");
    for (const Element* e : disabled) {
      if (const auto read = pair(*e)) pairs.insert(*read);
    }
    srdf_.disabled_pairs.assign(pairs.begin(), pairs.end());
    if (unknown.empty()) return;
    srdf_.warnings.push_back(fmt::format(
        "{}: {} of {} disabled pairs do not count: the URDF of robot '{}' has no link {}", origin_,
        num_unknown, disabled.size(), model_.name(), fmt::join(unknown, ", ")));
  }

  void ReadSpheres(const Element& element) {
    const int link = LinkAt(element, "link");
    const std::vector<const Element*> spheres = Children(element, "sphere");
    if (spheres.empty()) Fail(element, "has no <sphere>");
    for (const Element* e : spheres) {
      const std::vector<double> center = Numbers(*e, "center", 3);
      const double radius = Numbers(*e, "radius", 1).front();
      if (radius < 0) Fail(*e, fmt::format("radius: must not be negative, is {}", radius));
      if (radius == 0) continue;  // That is how the format says that a link has no spheres.
      srdf_.spheres.push_back({link, Eigen::Vector3d(center.data()), radius});
    }
  }

  const std::string& origin_;
  const RobotModel& model_;
  tinyxml2::XMLDocument document_;
  const Element* root_ = nullptr;
  std::string robot_name_;
  std::set<std::string> passive_;
  std::map<std::string, const Element*> groups_;
  Srdf srdf_;
};

}  // namespace

Srdf ParseSrdf(const std::string& srdf_text, const std::string& origin, const RobotModel& model) {
  return SrdfReader(srdf_text, origin, model).Read();
}

}  // namespace planbench
