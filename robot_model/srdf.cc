#include "robot_model/srdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include "common/error.h"
#include "common/text.h"
#include "robot_model/full_positions.h"
#include "robot_model/group_tips.h"
#include "robot_model/srdf_vocabulary.h"
#include "robot_model/xml_text.h"

namespace planbench {
namespace {

using Element = tinyxml2::XMLElement;

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
    if (robot_name_ != model_.name()) {
      srdf_.warnings.push_back(fmt::format("{}: the SRDF of robot '{}' beside the URDF of '{}'",
                                           Where(*root_), robot_name_, model_.name()));
    }
    std::ranges::move(UnknownParts(*root_, origin_), std::back_inserter(srdf_.warnings));
    for (const Element* e : Children(*root_, "virtual_joint")) ReadVirtualJoint(*e);
    FindPassiveJoints(*root_);
    ReadGroups();
    for (const Element* e : Children(*root_, "end_effector")) ReadEndEffector(*e);
    for (const Element* e : Children(*root_, "group_state")) ReadState(*e);
    ReadPairs();
    auto* const told = &srdf_.sphere_warnings;
    for (const auto& [element, links] : LinksOfAll("link_sphere_approximation", {"link"}, told)) {
      ReadSpheres(*element, links[0]);
    }
    std::stable_sort(srdf_.spheres.begin(), srdf_.spheres.end(),
                     [](const LinkSphere& a, const LinkSphere& b) { return a.link < b.link; });
    return std::move(srdf_);
  }

 private:
  struct Members {
    std::set<int> joints;                     // In URDF order.
    std::vector<int> tips;                    // Links, of chains.
    std::vector<std::string> virtual_joints;  // Planar and floating ones.
  };
  struct LinkNames {
    const Element* element;
    std::vector<int> links;  // In the order of the attributes.
  };

  std::string Where(const Element& element) const {
    return fmt::format("{}:{}", origin_, element.GetLineNum());
  }
  [[noreturn]] void Fail(const Element& element, const std::string& what) const {
    throw InputError(fmt::format("{}: <{}>: {}", Where(element), element.Name(), what));
  }
  // For messages: that the robot has no such link.
  std::string NoLink(const std::string& name) const {
    std::vector<std::string_view> known;
    for (const Link& link : model_.links()) known.push_back(link.name);
    return None("link", name, known);
  }
  // The same of a joint that neither the URDF nor the file itself has.
  std::string NoJoint(const std::string& name) const {
    std::vector<std::string_view> known;
    for (const Joint& joint : model_.joints()) known.push_back(joint.name);
    for (const VirtualJoint& joint : srdf_.virtual_joints) known.push_back(joint.name);
    return None("joint", name, known);
  }
  std::string None(const char* kind, const std::string& name,
                   const std::vector<std::string_view>& known) const {
    return fmt::format(
        "the URDF of robot '{}' has no {} '{}'{}{}", model_.name(), kind, name,
        Nearest(name, known),
        robot_name_ == model_.name() ? "" : fmt::format("; this is the SRDF of '{}'", robot_name_));
  }
  std::string NoGroup(const std::string& name) const {
    std::vector<std::string_view> known;
    for (const auto& [group, element] : groups_) known.push_back(group);
    return fmt::format("there is no group '{}'{}", name, Nearest(name, known));
  }
  static std::string Nearest(const std::string& name, const std::vector<std::string_view>& known) {
    const std::string nearest = NearestName(name, known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
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
    if (link < 0) Fail(element, NoLink(name));
    return link;
  }
  // Whether the URDF or the file itself has it.
  bool HasJoint(const std::string& name) const {
    return model_.FindJoint(name) >= 0 || FindVirtualJoint(name) != nullptr;
  }
  // The joint that an element names, unless there is none, so that it does not count, as in
  // MoveIt: files are kept for robots with and without a hand.
  std::optional<std::string> KnownJoint(const Element& element, const std::string& part_of) {
    const std::string name = Attribute(element, "name");
    if (HasJoint(name)) return name;
    srdf_.group_warnings.push_back(fmt::format("{}: {}<{}> does not count: {}", Where(element),
                                               part_of, element.Name(), NoJoint(name)));
    return std::nullopt;
  }
  const VirtualJoint* FindVirtualJoint(const std::string& name) const {
    const auto joint = std::ranges::find(srdf_.virtual_joints, name, &VirtualJoint::name);
    return joint == srdf_.virtual_joints.end() ? nullptr : &*joint;
  }
  const std::string& LinkName(int link) const {
    return model_.links()[static_cast<std::size_t>(link)].name;
  }
  const Joint& JointAt(int joint) const { return model_.joints()[static_cast<std::size_t>(joint)]; }
  int ParentJoint(int link) const {
    return model_.links()[static_cast<std::size_t>(link)].parent_joint;
  }

  // They stand beside groups, and in some files in them.
  void FindPassiveJoints(const Element& parent) {
    for (const Element* e : Children(parent, "passive_joint")) {
      if (const auto joint = KnownJoint(*e, "")) passive_.insert(*joint);
    }
    for (const Element* group : Children(parent, "group")) FindPassiveJoints(*group);
  }

  void ReadVirtualJoint(const Element& element) {
    const std::string type = Attribute(element, "type");
    const std::optional<JointType> parsed = ParseVirtualJointType(type);
    if (!parsed) {
      Fail(element, fmt::format("type: expected fixed, planar or floating, found '{}'", type));
    }
    VirtualJoint joint{Attribute(element, "name"), *parsed, Attribute(element, "parent_frame"),
                       LinkAt(element, "child_link")};
    const std::string fault = FaultOfName(joint, model_, srdf_.virtual_joints);
    if (!fault.empty()) Fail(element, fault);
    srdf_.virtual_joints.push_back(std::move(joint));
  }

  void ReadGroups() {
    for (const Element* e : Children(*root_, "group")) {
      const std::string name = Attribute(*e, "name");
      if (!groups_.emplace(name, e).second) {
        Fail(*e, fmt::format("the group '{}' occurs twice", name));
      }
    }
    for (const Element* e : Children(*root_, "end_effector")) FindHandJoints(*e);
    for (const Element* e : Children(*root_, "group")) ReadGroup(*e);
  }

  void FindHandJoints(const Element& effector) {
    const auto group = groups_.find(Attribute(effector, "group"));
    if (group != groups_.end()) hand_joints_.merge(MembersOf(*group->second, {}).joints);
  }

  void ReadGroup(const Element& element) {
    const std::string name = Attribute(element, "name");
    const Members members = MembersOf(element, {});
    std::set<int> joints;
    std::vector<std::string> passive;
    std::vector<std::string> following;
    std::vector<std::string> with_pose = members.virtual_joints;
    for (const int index : members.joints) {
      const Joint& joint = JointAt(index);
      if (joint.type == JointType::kFixed) continue;
      if (joint.leader >= 0) {
        following.push_back(fmt::format("{} follows {}", joint.name, JointAt(joint.leader).name));
      } else if (NumPositions(joint.type) > 1) {
        with_pose.push_back(joint.name);
      } else if (passive_.contains(joint.name)) {
        passive.push_back(joint.name);
      } else {
        joints.insert(index);
      }
    }
    const std::string group = fmt::format("{}: group '{}'", Where(element), name);
    if (!joints.empty()) {
      if (!with_pose.empty()) {
        srdf_.group_warnings.push_back(
            fmt::format("{}: planar and floating joints cannot be planned with, and are held where "
                        "problems say: {}",
                        group, fmt::join(with_pose, ", ")));
      }
      if (!passive.empty()) {
        srdf_.left_out.push_back(fmt::format("{}: passive joints are held where problems say: {}",
                                             group, fmt::join(passive, ", ")));
      }
      AddGroup(element, name, joints, members.tips);
      return;
    }
    std::string& why = srdf_.why_no_group[name];
    if (members.joints.empty() && with_pose.empty()) {
      why = group + " is left out: it has no joint; name chains, joints, links or groups";
      srdf_.group_warnings.push_back(why);
      return;
    }
    why = group + " is left out: it has no joint that can be planned with";
    std::vector<std::string>& lines = with_pose.empty() ? srdf_.left_out : srdf_.group_warnings;
    with_pose.insert(with_pose.end(), passive.begin(), passive.end());
    if (!with_pose.empty()) {
      why += fmt::format("; held where problems say: {}", fmt::join(with_pose, ", "));
    }
    if (!following.empty()) why += fmt::format("; {}", fmt::join(following, ", "));
    lines.push_back(why);
  }

  void AddGroup(const Element& element, const std::string& name, const std::set<int>& joints,
                const std::vector<int>& chain_tips) {
    std::vector<std::string> joint_names;
    for (const int joint : joints) joint_names.push_back(JointAt(joint).name);
    std::vector<std::string> tips;
    for (const int tip : GroupTips(model_, joints, chain_tips, hand_joints_)) {
      tips.push_back(LinkName(tip));
    }
    try {
      srdf_.groups.push_back(
          model_.MakeGroup(name, joint_names, tips.front(), {tips.begin() + 1, tips.end()}));
    } catch (const InputError& error) {
      std::string& why = srdf_.why_no_group[name];
      why = fmt::format("{}: group '{}' is left out: {}", Where(element), name, error.what());
      srdf_.group_warnings.push_back(why);
    }
  }

  Members MembersOf(const Element& group, std::vector<std::string> path) const {
    const std::string name = Attribute(group, "name");
    if (std::find(path.begin(), path.end(), name) != path.end()) {
      Fail(group,
           fmt::format("the groups are parts of each other: {}, {}", fmt::join(path, ", "), name));
    }
    path.push_back(name);
    Members members;
    for (const Element* e : Children(group, "joint")) {
      const std::string joint_name = Attribute(*e, "name");
      if (!HasJoint(joint_name)) Fail(*e, NoJoint(joint_name));
      const int joint = model_.FindJoint(joint_name);
      if (joint >= 0) {
        members.joints.insert(joint);
      } else if (FindVirtualJoint(joint_name)->type != JointType::kFixed) {
        AddNew(joint_name, &members.virtual_joints);
      }
    }
    for (const Element* e : Children(group, "link")) {
      const int joint = ParentJoint(LinkAt(*e, "name"));
      if (joint >= 0) members.joints.insert(joint);
    }
    for (const Element* e : Children(group, "chain")) AddChain(*e, &members);
    for (const Element* e : Children(group, "group")) {
      const auto part = groups_.find(Attribute(*e, "name"));
      if (part == groups_.end()) Fail(*e, NoGroup(Attribute(*e, "name")));
      Members others = MembersOf(*part->second, path);
      members.joints.merge(others.joints);
      for (const int tip : others.tips) AddNew(tip, &members.tips);
      for (const std::string& joint : others.virtual_joints) {
        AddNew(joint, &members.virtual_joints);
      }
    }
    return members;
  }

  void AddChain(const Element& element, Members* members) const {
    const int base = LinkAt(element, "base_link");
    const int tip = LinkAt(element, "tip_link");
    std::vector<int> from_tip = JointsToRoot(model_, tip);
    std::vector<int> from_base = JointsToRoot(model_, base);
    int beneath = -1;  // The joint where they meet, -1 at the root.
    while (!from_tip.empty() && !from_base.empty() && from_tip.back() == from_base.back()) {
      beneath = from_tip.back();
      from_tip.pop_back();
      from_base.pop_back();
    }
    members->joints.insert(from_tip.begin(), from_tip.end());
    if (!from_tip.empty()) AddNew(tip, &members->tips);
    if (from_base.empty()) return;
    // The base is not on the way from the root to the tip.
    members->joints.insert(from_base.begin(), from_base.end());
    if (beneath >= 0) members->joints.insert(beneath);
    AddNew(base, &members->tips);
  }

  template <typename Value>
  static void AddNew(const Value& value, std::vector<Value>* values) {
    if (std::find(values->begin(), values->end(), value) == values->end()) values->push_back(value);
  }

  void ReadEndEffector(const Element& element) {
    const char* parent_group = element.Attribute("parent_group");
    Srdf::EndEffector effector{Attribute(element, "name"), Attribute(element, "group"),
                               Attribute(element, "parent_link"),
                               parent_group == nullptr ? "" : parent_group};
    // Without its joints a hand might be taken for an arm, and a finger for the tip.
    if (!groups_.contains(effector.group)) Fail(element, NoGroup(effector.group));
    std::string lack;
    if (model_.FindLink(effector.parent_link) < 0) {
      lack = NoLink(effector.parent_link);
    } else if (!effector.parent_group.empty() && !groups_.contains(effector.parent_group)) {
      lack = NoGroup(effector.parent_group);
    }
    if (lack.empty()) {
      srdf_.end_effectors.push_back(std::move(effector));
    } else {
      srdf_.group_warnings.push_back(
          fmt::format("{}: end effector '{}' is left out, though its group counts as a hand: {}",
                      Where(element), effector.name, lack));
    }
  }

  // Whether a joint is one of the group's, or follows one.
  bool IsMovedBy(const PlanningGroup& group, const std::string& name) const {
    const int index = model_.FindJoint(name);
    if (index < 0) return false;  // A virtual joint.
    const int leader = JointAt(index).leader;
    return std::ranges::find(group.joints, leader < 0 ? index : leader) != group.joints.end();
  }

  void ReadState(const Element& element) {
    const std::string name = Attribute(element, "name");
    const std::string group_name = Attribute(element, "group");
    if (!groups_.contains(group_name)) {
      srdf_.group_warnings.push_back(
          fmt::format("{}: state '{}' is left out: {}", Where(element), name, NoGroup(group_name)));
      return;
    }
    if (!states_.insert({group_name, name}).second) {
      Fail(element, fmt::format("the state '{}' of group '{}' occurs twice", name, group_name));
    }
    std::vector<std::pair<std::string, const Element*>> values;  // By joint, as the file has them.
    std::set<std::string> seen;
    for (const Element* e : Children(element, "joint")) {
      const auto joint = KnownJoint(*e, fmt::format("state '{}': ", name));
      if (!joint) continue;
      if (!seen.insert(*joint).second) {
        Fail(*e, fmt::format("the state '{}' names the joint '{}' twice", name, *joint));
      }
      values.emplace_back(*joint, e);
    }
    const auto group = std::find_if(srdf_.groups.begin(), srdf_.groups.end(),
                                    [&](const PlanningGroup& g) { return g.name == group_name; });
    if (group == srdf_.groups.end()) return;  // It was left out.
    std::vector<std::string> names;           // Of what the group moves.
    std::vector<double> positions;
    std::vector<std::string> ignored;
    for (const auto& [joint, e] : values) {
      if (!IsMovedBy(*group, joint)) {
        ignored.push_back(joint);
        continue;
      }
      names.push_back(joint);
      positions.push_back(Numbers(*e, "value", 1).front());
    }
    const std::vector<double> full = FullPositionsWherePossible(model_, names, positions);
    std::vector<double> q;
    std::vector<std::string> filled;
    for (const int index : group->joints) {
      const Joint& joint = JointAt(index);
      q.push_back(full[static_cast<std::size_t>(joint.position_index)]);
      if (seen.contains(joint.name) || !FollowerThatPuts(model_, index, names).empty()) continue;
      filled.push_back(fmt::format("{} at {}", joint.name, q.back()));
    }
    const std::string state = fmt::format("{}: state '{}'", Where(element), name);
    for (const std::string& contradiction : FindContradictions(model_, names, positions)) {
      srdf_.group_warnings.push_back(fmt::format("{}: {}", state, contradiction));
    }
    for (const std::string& doubt : group->space.TakeTurnsOut(q)) {
      srdf_.group_warnings.push_back(fmt::format("{}: {}", state, doubt));
    }
    if (!filled.empty()) {
      srdf_.group_warnings.push_back(
          fmt::format("{}: joints of the group '{}' that it does not name are at their defaults: "
                      "{}",
                      state, group_name, fmt::join(filled, ", ")));
    }
    if (!ignored.empty()) {
      srdf_.left_out.push_back(fmt::format("{}: the group '{}' is not planned with {}", state,
                                           group_name, fmt::join(ignored, ", ")));
    }
    group->states[name] = std::move(q);
  }

  // The links that each element of a kind names, of those elements that name no other than the
  // robot has; says how many do.
  std::vector<LinkNames> LinksOfAll(const char* kind, const std::vector<const char*>& attributes,
                                    std::vector<std::string>* warnings) {
    std::vector<LinkNames> all;
    std::set<std::string> unknown;
    const std::vector<const Element*> elements = Children(*root_, kind);
    const Element* first_unknown = nullptr;
    for (const Element* e : elements) {
      LinkNames named{e, {}};
      for (const char* attribute : attributes) {
        const std::string name = Attribute(*e, attribute);
        named.links.push_back(model_.FindLink(name));
        if (named.links.back() < 0) unknown.insert(name);
      }
      const bool is_known = *std::ranges::min_element(named.links) >= 0;
      if (is_known) {
        all.push_back(std::move(named));
      } else if (first_unknown == nullptr) {
        first_unknown = e;
      }
    }
    if (first_unknown != nullptr) {
      warnings->push_back(
          fmt::format("{}: {} of {} <{}> do not count: the URDF of robot '{}' has no link {}",
                      Where(*first_unknown), elements.size() - all.size(), elements.size(), kind,
                      model_.name(), fmt::join(unknown, ", ")));
    }
    return all;
  }

  void ReadPairs() {
    auto* const told = &srdf_.warnings;
    std::set<std::pair<int, int>> disabled;
    for (const auto& [element, links] : LinksOfAll("disable_default_collisions", {"link"}, told)) {
      for (int b = 0; b < model_.num_links(); ++b) {
        if (b != links[0]) disabled.insert(std::minmax(links[0], b));
      }
    }
    std::set<std::pair<int, int>> enabled;
    for (const auto& [element, links] : LinksOfAll("enable_collisions", {"link1", "link2"}, told)) {
      if (model_.Rigid(links[0], links[1])) {
        srdf_.warnings.push_back(
            fmt::format("{}: {} and {} are rigid to each other, and are never "
                        "checked, though the file enables them",
                        Where(*element), LinkName(links[0]), LinkName(links[1])));
        continue;
      }
      enabled.insert(std::minmax(links[0], links[1]));
      disabled.erase(std::minmax(links[0], links[1]));
    }
    for (const auto& [element, links] :
         LinksOfAll("disable_collisions", {"link1", "link2"}, told)) {
      if (links[0] == links[1]) continue;
      disabled.insert(std::minmax(links[0], links[1]));
      if (enabled.erase(std::minmax(links[0], links[1])) == 0) continue;
      srdf_.warnings.push_back(
          fmt::format("{}: {} and {} are not checked, as in MoveIt, though the "
                      "file enables them, too",
                      Where(*element), LinkName(links[0]), LinkName(links[1])));
    }
    for (const Joint& joint : model_.joints()) {
      const std::pair<int, int> pair = std::minmax(joint.parent_link, joint.child_link);
      const bool is_left = !disabled.empty() && !disabled.contains(pair);
      if (model_.Joined(pair.first, pair.second) && (is_left || enabled.contains(pair))) {
        srdf_.checked_pairs.push_back(pair);
      }
    }
    srdf_.disabled_pairs.assign(disabled.begin(), disabled.end());
    srdf_.enabled_pairs.assign(enabled.begin(), enabled.end());
  }

  void ReadSpheres(const Element& element, int link) {
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
  std::set<int> hand_joints_;  // Of end effectors.
  std::map<std::string, const Element*> groups_;
  std::set<std::pair<std::string, std::string>> states_;  // Their groups and names.
  Srdf srdf_;
};

}  // namespace

std::string NoGroupFault(const Srdf& srdf, const std::string& origin) {
  std::vector<std::string> lines;
  for (const auto& [name, why] : srdf.why_no_group) lines.push_back(why);
  return fmt::format("{} has no group with joints that can be planned with{}{}", origin,
                     lines.empty() ? "" : ": ", fmt::join(lines, "; "));
}

Srdf ParseSrdf(const std::string& srdf_text, const std::string& origin, const RobotModel& model) {
  return SrdfReader(srdf_text, origin, model).Read();
}

}  // namespace planbench
