#include "problem_generator/problem_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/named_file.h"
#include "common/yaml.h"
#include "scene/moveit_fields.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_request_reader.h"

namespace planbench {
namespace {

constexpr Range kZero{0, 0};
constexpr Range3 kZero3{kZero, kZero, kZero};

Range ReadRange(const YamlNode& node) {
  if (!node.IsSequence()) {
    const double value = node.Double();
    return {value, value};
  }
  const std::vector<double> ends = node.Doubles(2);
  if (ends[0] > ends[1]) node.Fail("a range is [low, high]; its ends are the wrong way round");
  if (std::isinf(ends[1] - ends[0])) node.Fail("the range is too wide to draw from");
  return {ends[0], ends[1]};
}

std::vector<Range> ReadRanges(const YamlNode& node, int count, const std::string& what) {
  if (!node.IsSequence() || node.Size() != count) {
    node.Fail(fmt::format("expected {}, each a number or a range [low, high]", what));
  }
  std::vector<Range> ranges;
  for (const YamlNode& element : node.Elements()) ranges.push_back(ReadRange(element));
  return ranges;
}

Range3 ReadRange3(const YamlNode& node, const std::string& what) {
  const std::vector<Range> ranges = ReadRanges(node, 3, what);
  return {ranges[0], ranges[1], ranges[2]};
}

// Refuses what the problems' readers would.
void RequireNear(const YamlNode& node, const std::vector<Range>& position) {
  for (const Range& range : position) {
    if (std::max(-range.low, range.high) > kFarthestAway) {
      node.Fail(fmt::format("is beyond {} m", kFarthestAway));
    }
  }
}

Range3 ReadPosition(const YamlNode& node) {
  const Range3 position = ReadRange3(node, "x, y, z");
  RequireNear(node, {position.begin(), position.end()});
  return position;
}

Range3 PositionOr0(const YamlNode& map) {
  const auto node = map.Find("position");
  return node ? ReadPosition(*node) : kZero3;
}

Range3 RpyOr0(const YamlNode& map) {
  const auto node = map.Find("rpy");
  return node ? ReadRange3(*node, "roll, pitch, yaw") : kZero3;
}

Range RangeOr0(const YamlNode& map, const std::string& key) {
  const auto node = map.Find(key);
  return node ? ReadRange(*node) : kZero;
}

double ToleranceOr0(const YamlNode& map, const std::string& key) {
  const auto node = map.Find(key);
  return node ? node->DoubleWithin(0, kFarthestAway) : 0;
}

int PositiveInt(const YamlNode& node) { return node.IntWithin(1, 1'000'000); }

PartSpec ReadPart(const YamlNode& node) {
  node.AllowOnly({"name", "box", "cylinder", "sphere", "position", "rpy"});
  PartSpec part;
  part.name = node.StringOr("name", "");
  std::vector<PartKind> kinds = EnumValues<PartKind>();
  std::erase_if(kinds, [&](PartKind kind) { return !node.Find(std::string(EnumName(kind))); });
  if (kinds.size() != 1) node.Fail("needs one of the keys " + EnumChoices<PartKind>());
  part.kind = kinds.front();
  const YamlNode size = node.At(std::string(EnumName(part.kind)));
  switch (part.kind) {
    case PartKind::kBox:
      part.size = ReadRanges(size, 3, "the lengths along x, y, z");
      break;
    case PartKind::kCylinder:
      part.size = ReadRanges(size, 2, "height, radius");
      break;
    case PartKind::kSphere:
      part.size = {ReadRange(size)};
      break;
  }
  for (const Range& range : part.size) {
    if (range.low <= 0) size.Fail("sizes must be greater than zero");
    if (range.high > kLargestShape) size.Fail(fmt::format("is more than {} m", kLargestShape));
  }
  part.position = PositionOr0(node);
  part.rpy = RpyOr0(node);
  return part;
}

int FindObject(const std::vector<ObjectSpec>& objects, const YamlNode& node,
               const std::string& id) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].id == id) return static_cast<int>(i);
  }
  node.Fail(fmt::format("there is no object '{}' (above this line)", id));
}

// "stands_on: shelf.lower_board" or "stands_on: table", whose only part it is.
void ReadSupport(const YamlNode& node, const std::vector<ObjectSpec>& above, ObjectSpec* object) {
  const std::string text = node.String();
  const std::size_t dot = text.find('.');
  object->parent = FindObject(above, node, text.substr(0, dot));
  const std::vector<PartSpec>& parts = above[static_cast<std::size_t>(object->parent)].parts;
  if (dot == std::string::npos) {
    if (parts.size() != 1) {
      node.Fail(fmt::format("'{0}' has {1} parts: say which, {0}.PART", text, parts.size()));
    }
    object->support_part = 0;
  } else {
    const std::string name = text.substr(dot + 1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!name.empty() && parts[i].name == name) object->support_part = static_cast<int>(i);
    }
    if (object->support_part < 0) {
      node.Fail(fmt::format("'{}' has no part '{}'", text.substr(0, dot), name));
    }
  }
  if (parts[static_cast<std::size_t>(object->support_part)].kind != PartKind::kBox) {
    node.Fail("objects stand on boxes only");
  }
}

// An id that the problems' readers take, and that no other object has.
std::string ReadId(const YamlNode& node, const Robot& robot, const ProblemSpec& spec) {
  std::string id = ReadObjectId(node, robot);
  if (id.find('.') != std::string::npos) node.Fail("an id has no dot");
  for (const ObjectSpec& other : spec.objects) {
    if (other.id == id) node.Fail("another object has this id");
  }
  for (const auto& [pair, allowed] : spec.allowed_collisions.entries()) {
    if (pair.first == id || pair.second == id) {
      node.Fail("the object has the name of a link, '" + id +
                "', whose collisions the setup allows");
    }
  }
  return id;
}

ObjectSpec ReadObject(const YamlNode& node, const Robot& robot, const ProblemSpec& spec) {
  const std::vector<ObjectSpec>& above = spec.objects;
  node.AllowOnly({"id", "parts", "probability", "stands_on", "relative_to", "position", "rpy",
                  "yaw", "about_base"});
  ObjectSpec object;
  object.where = node.Where();
  object.id = ReadId(node.At("id"), robot, spec);
  const YamlNode parts = node.At("parts");
  if (parts.Size() == 0) parts.Fail("an object needs at least one part");
  for (const YamlNode& part : parts.Elements()) {
    object.parts.push_back(ReadPart(part));
    for (std::size_t i = 0; i + 1 < object.parts.size(); ++i) {
      if (!object.parts[i].name.empty() && object.parts[i].name == object.parts.back().name) {
        part.Fail("another part of the object has this name");
      }
    }
  }
  if (const auto probability = node.Find("probability")) {
    object.probability = probability->NonNegativeDouble();
    if (object.probability > 1) probability->Fail("a probability is at most 1");
  }
  const auto support = node.Find("stands_on");
  const auto frame = node.Find("relative_to");
  const auto about_base = node.Find("about_base");
  if (support && frame) frame->Fail("an object has either 'stands_on' or 'relative_to'");
  if ((support || frame) && about_base) {
    about_base->Fail("only for objects whose position is in the robot's base frame");
  }
  if (about_base) object.about_base = ReadRange(*about_base);
  if (frame) object.parent = FindObject(above, *frame, frame->String());
  if (support) {
    ReadSupport(*support, above, &object);
    if (const auto rpy = node.Find("rpy")) rpy->Fail("an object that stands has 'yaw' instead");
    const YamlNode position = node.At("position");
    const std::vector<Range> xy =
        ReadRanges(position, 2, "x, y from the middle of the face it stands on");
    RequireNear(position, xy);
    object.position = {xy[0], xy[1], kZero};
    object.rpy = {kZero, kZero, RangeOr0(node, "yaw")};
  } else {
    if (const auto yaw = node.Find("yaw")) yaw->Fail("only with 'stands_on'; otherwise 'rpy'");
    object.position = ReadPosition(node.At("position"));
    object.rpy = RpyOr0(node);
  }
  return object;
}

// Named joint positions, of joints that can move. `group`: only those of the group.
void ReadJoints(const YamlNode& map, const RobotModel& model, const PlanningGroup* group,
                std::vector<double>* full_positions) {
  for (const std::string& name : map.Keys()) {
    const YamlNode node = map.At(name);
    const int index = model.FindJoint(name);
    if (index < 0) node.Fail("the robot has no such joint");
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    if (NumPositions(joint.type) != 1)
      node.Fail("the joint has no position, it is fixed or has a pose");
    if (joint.leader >= 0) node.Fail("the joint follows another one (mimic); name that");
    if (group != nullptr && group->space.Find(name) < 0) {
      node.Fail(fmt::format("no joint of the group '{}'", group->name));
    }
    const double position = node.Double();
    if (position < joint.lower || position > joint.upper) {
      node.Fail(fmt::format("outside the joint's limits, {} to {}", joint.lower, joint.upper));
    }
    // Who reads the problems asks, too, but of every one.
    const auto doubt = JointSpace({SpaceJoint(joint)}).FindTurnsDoubt(0, position);
    if (doubt) node.Warn(*doubt);
    (*full_positions)[static_cast<std::size_t>(joint.position_index)] = position;
  }
}

// What a robot's specifications share.
struct Setup {
  const RobotModel* model;
  const PlanningGroup* group;
  std::map<std::string, std::vector<double>> configurations;  // Group order.
};

// The files of the scenes say of all pairs of the links that they name whether these may touch.
// That links which are not checked by themselves may is not for a specification to say.
void AllowJoinedLinks(const Robot& robot, AllowedCollisionMatrix* matrix) {
  std::set<int> named;
  for (const auto& [pair, allowed] : matrix->entries()) {
    named.insert({robot.model.FindLink(pair.first), robot.model.FindLink(pair.second)});
  }
  const std::vector<Link>& links = robot.model.links();
  for (const int a : named) {
    for (const int b : named) {
      if (!robot.model.Joined(a, b) || robot.ChecksLinks(a, b)) continue;
      matrix->SetEntry(links[static_cast<std::size_t>(a)].name,
                       links[static_cast<std::size_t>(b)].name, true);
    }
  }
}

Setup ReadSetup(const YamlNode& node, const Robot& robot, ProblemSpec* spec) {
  node.AllowOnly({"robot", "group", "rest", "configurations", "workspace", "time_limit_s",
                  "allowed_collisions"});
  const RobotModel& model = robot.model;
  const YamlNode name = node.At("robot");
  if (name.String() != robot.name) {
    name.Fail(fmt::format("made for the robot '{}', given is '{}'", name.String(), robot.name));
  }
  const YamlNode group_node = node.At("group");
  const std::string group_name = group_node.String();
  const PlanningGroup* group = AtField(group_node, [&] { return &robot.Group(group_name); });
  spec->group = group->name;

  std::vector<double> rest = model.DefaultPositions();
  if (const auto joints = node.Find("rest")) ReadJoints(*joints, model, nullptr, &rest);
  spec->rest = {model.position_names(), rest};

  Setup setup{&model, group, group->states};
  if (const auto configurations = node.Find("configurations")) {
    for (const std::string& key : configurations->Keys()) {
      const YamlNode joints = configurations->At(key);
      std::vector<double> full = rest;
      ReadJoints(joints, model, group, &full);
      std::vector<double>& q = setup.configurations[key];
      for (const int joint : group->joints) {
        const Joint& moved = model.joints()[static_cast<std::size_t>(joint)];
        if (!joints.Find(moved.name)) joints.Fail(fmt::format("lacks the joint {}", moved.name));
        q.push_back(full[static_cast<std::size_t>(moved.position_index)]);
      }
    }
  }
  if (const auto workspace = node.Find("workspace")) {
    workspace->AllowOnly({"min_corner", "max_corner"});
    spec->workspace = ReadCorners(*workspace, model.links().front().name);
  }
  const auto limit = node.Find("time_limit_s");
  spec->time_limit_s = limit ? limit->PositiveDouble() : 60.0;
  if (const auto allowed = node.Find("allowed_collisions")) {
    for (const std::string& link : allowed->Keys()) {
      const YamlNode partners = allowed->At(link);
      if (model.FindLink(link) < 0) partners.Fail("the robot has no such link");
      for (const YamlNode& partner : partners.Elements()) {
        if (model.FindLink(partner.String()) < 0) partner.Fail("the robot has no such link");
        if (spec->allowed_collisions.Entry(link, partner.String())) {
          partner.Fail(fmt::format("the pair of {} and {} is given twice", link, partner.String()));
        }
        spec->allowed_collisions.SetEntry(link, partner.String(), true);
      }
    }
    AllowJoinedLinks(robot, &spec->allowed_collisions);
  }
  return setup;
}

// The tip that a gripper's pose is of. With several, none is meant by itself.
int ReadTip(const YamlNode& gripper, const Setup& setup) {
  const auto tip = gripper.Find("tip");
  const std::vector<int> tips = setup.group->tips();
  if (!tip && tips.size() == 1) return tips.front();
  std::vector<std::string> names;
  for (const int link : tips) {
    names.push_back(setup.model->links()[static_cast<std::size_t>(link)].name);
    if (tip && tip->String() == names.back()) return link;
  }
  const std::string known =
      fmt::format("the group '{}' has the tips {}", setup.group->name, fmt::join(names, ", "));
  if (!tip) gripper.Fail("needs the key tip: " + known);
  tip->Fail(fmt::format("'{}' is no tip: {}", tip->String(), known));
}

GripperSpec ReadGripper(const YamlNode& node, const Setup& setup,
                        const std::vector<ObjectSpec>& objects) {
  node.AllowOnly({"tip", "object", "around", "position", "rpy", "position_tolerance",
                  "orientation_tolerance"});
  GripperSpec gripper;
  gripper.tip_link = ReadTip(node, setup);
  const YamlNode object = node.At("object");
  if (object.IsSequence()) {
    for (const YamlNode& id : object.Elements()) {
      gripper.objects.push_back(FindObject(objects, id, id.String()));
    }
    if (gripper.objects.empty()) object.Fail("needs at least one object");
  } else {
    gripper.objects.push_back(FindObject(objects, object, object.String()));
  }
  gripper.around = RangeOr0(node, "around");
  gripper.position = ReadPosition(node.At("position"));
  gripper.rpy = RpyOr0(node);
  gripper.position_tolerance_m = ToleranceOr0(node, "position_tolerance");
  gripper.orientation_tolerance_rad = ToleranceOr0(node, "orientation_tolerance");
  return gripper;
}

EndSpec ReadEnd(const YamlNode& query, const std::string& key, const Setup& setup,
                const std::vector<ObjectSpec>& objects) {
  const YamlNode node = query.At(key);
  node.AllowOnly({"configuration", "gripper"});
  EndSpec end;
  end.where = node.Where();
  end.name = query.At("name").String() + " " + key;
  const auto configuration = node.Find("configuration");
  const auto gripper = node.Find("gripper");
  if (configuration.has_value() == gripper.has_value()) {
    node.Fail("needs one of the keys configuration, gripper");
  }
  if (configuration) {
    const auto found = setup.configurations.find(configuration->String());
    if (found == setup.configurations.end()) {
      configuration->Fail(
          fmt::format("neither the setup nor the robot's group has a configuration '{}'",
                      configuration->String()));
    }
    if (const auto fault = setup.group->space.FindLimitFault(found->second)) {
      configuration->Fail(fmt::format(
          "the robot's state '{}' of group '{}' cannot be used: {}; mend it, or give the setup a "
          "configuration of that name",
          configuration->String(), setup.group->name, *fault));
    }
    end.configuration = found->second;
  } else {
    end.gripper = ReadGripper(*gripper, setup, objects);
  }
  return end;
}

Effort ReadEffort(const YamlNode& node) {
  node.AllowOnly({"scenes", "poses", "solutions", "ik_starts"});
  return {.scenes = PositiveInt(node.At("scenes")),
          .poses = PositiveInt(node.At("poses")),
          .solutions = PositiveInt(node.At("solutions")),
          .ik_starts = PositiveInt(node.At("ik_starts"))};
}

}  // namespace

ProblemSpec LoadProblemSpec(const std::filesystem::path& file, const Robot& robot) {
  const YamlNode root = YamlNode::LoadFile(file.string());
  root.AllowOnly(
      {"setup", "clearance", "object_gap", "min_joint_distance", "effort", "objects", "queries"});
  ProblemSpec spec;
  spec.name = file.stem().string();
  const NamedFile named = ReadNamedFile(root.At("setup"), file.parent_path());
  const YamlNode setup_root = YamlNode::Parse(named.text, named.path.string());
  const Setup setup = ReadSetup(setup_root, robot, &spec);
  spec.warnings = setup_root.warnings();
  spec.clearance_m = root.At("clearance").NonNegativeDouble();
  spec.object_gap_m = root.At("object_gap").NonNegativeDouble();
  spec.min_joint_distance = root.At("min_joint_distance").NonNegativeDouble();
  spec.effort = ReadEffort(root.At("effort"));
  for (const YamlNode& object : root.At("objects").Elements()) {
    spec.objects.push_back(ReadObject(object, robot, spec));
  }
  const YamlNode queries = root.At("queries");
  if (queries.Size() == 0) queries.Fail("a specification needs at least one query");
  double weights = 0;
  for (const YamlNode& node : queries.Elements()) {
    node.AllowOnly({"name", "weight", "start", "goal"});
    QuerySpec query;
    query.name = ReadName(node.At("name"));
    if (const auto weight = node.Find("weight")) query.weight = weight->PositiveDouble();
    weights += query.weight;
    if (std::isinf(weights)) node.Fail("the weights up to here add up to infinity");
    query.start = ReadEnd(node, "start", setup, spec.objects);
    query.goal = ReadEnd(node, "goal", setup, spec.objects);
    if (query.start.configuration && query.goal.configuration) {
      node.Fail("start and goal cannot both be named configurations");
    }
    spec.queries.push_back(std::move(query));
  }
  return spec;
}

}  // namespace planbench
