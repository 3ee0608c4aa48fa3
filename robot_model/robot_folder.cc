#include "robot_model/robot_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "common/content_hash.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/named_file.h"
#include "common/read_text.h"
#include "common/yaml.h"
#include "robot_model/group_kinematics.h"
#include "robot_model/link_spheres.h"
#include "robot_model/referee_misfits.h"
#include "robot_model/shipped_robots.h"
#include "robot_model/srdf.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

using LinkPairs = std::vector<std::pair<int, int>>;

// A tip elsewhere in the tree could be brought nowhere.
void RequireMovedTips(const YamlNode& node, const RobotModel& model, const PlanningGroup& group) {
  const GroupKinematics kinematics(model, group, model.DefaultPositions());
  for (const int tip : group.tips()) {
    if (kinematics.Moves(tip)) continue;
    node.Fail(fmt::format("none of the joints of group '{}' moves the link '{}'", group.name,
                          model.links()[static_cast<std::size_t>(tip)].name));
  }
}

PlanningGroup ReadGroup(const YamlNode& node, const RobotModel& model,
                        std::vector<std::string>* warnings) {
  node.AllowOnly({"name", "joints", "tip_link", "states"});
  const std::string name = node.At("name").String();
  if (name.empty()) node.At("name").Fail("must not be empty");
  const std::vector<std::string> joints = node.At("joints").Strings();
  const YamlNode tip = node.At("tip_link");
  const std::vector<std::string> tips =
      tip.IsSequence() ? tip.Strings() : std::vector<std::string>{tip.String()};
  if (tips.empty()) tip.Fail("at least one link is needed");
  PlanningGroup group = AtField(node, [&] {
    return model.MakeGroup(name, joints, tips.front(), {tips.begin() + 1, tips.end()});
  });
  RequireMovedTips(tip, model, group);
  const std::vector<int> counting = group.tips();
  for (const std::string& left_out : tips) {
    if (std::ranges::count(counting, model.FindLink(left_out)) > 0) continue;
    warnings->push_back(
        fmt::format("{}: '{}' does not count: it is rigid to a tip before it; take one of them out",
                    tip.Where(), left_out));
  }
  if (const auto states = node.Find("states")) {
    for (const std::string& key : states->Keys()) {
      const YamlNode state = states->At(key);
      std::vector<double>& q = group.states[key] = state.Doubles(group.space.size());
      for (const std::string& doubt : group.space.TakeTurnsOut(q)) {
        warnings->push_back(fmt::format("{}: {}", state.Where(), doubt));
      }
    }
  }
  return group;
}

std::vector<PlanningGroup> ReadGroups(const YamlNode& node, const RobotModel& model,
                                      std::vector<std::string>* warnings) {
  std::vector<PlanningGroup> groups;
  std::set<std::string> names;
  for (const YamlNode& element : node.Elements()) {
    groups.push_back(ReadGroup(element, model, warnings));
    if (!names.insert(groups.back().name).second) {
      element.At("name").Fail(fmt::format("the group '{}' occurs twice", groups.back().name));
    }
  }
  if (groups.empty()) node.Fail("at least one group is needed");
  return groups;
}

int LinkAt(const YamlNode& node, const std::string& name, const RobotModel& model) {
  const int link = model.FindLink(name);
  if (link < 0) node.Fail(fmt::format("the robot '{}' has no link '{}'", model.name(), name));
  return link;
}

std::vector<VirtualJoint> ReadVirtualJoints(const YamlNode& node, const RobotModel& model) {
  std::vector<VirtualJoint> joints;
  for (const YamlNode& element : node.Elements()) {
    element.AllowOnly({"name", "type", "parent_frame", "child_link"});
    const YamlNode type = element.At("type");
    const std::optional<JointType> parsed = ParseVirtualJointType(type.String());
    if (!parsed) {
      type.Fail(fmt::format("expected fixed, planar or floating, found '{}'", type.String()));
    }
    const YamlNode child = element.At("child_link");
    VirtualJoint joint{element.At("name").String(), *parsed, element.At("parent_frame").String(),
                       LinkAt(child, child.String(), model)};
    const std::string fault = FaultOfName(joint, model, joints);
    if (!fault.empty()) element.At("name").Fail(fault);
    joints.push_back(std::move(joint));
  }
  return joints;
}

std::pair<int, int> ReadPair(const YamlNode& node, const RobotModel& model) {
  if (node.Size() != 2) node.Fail("expected a pair of links: [link_a, link_b]");
  const int a = LinkAt(node, node.At(0).String(), model);
  const int b = LinkAt(node, node.At(1).String(), model);
  if (a == b) node.Fail("the two links are the same");
  return {a, b};
}

// What is checked anyway, or never, would be named in vain.
void ReadCheckedPairs(const YamlNode& node, Robot* robot) {
  for (const YamlNode& element : node.Elements()) {
    const auto [a, b] = ReadPair(element, robot->model);
    if (!robot->model.Joined(a, b)) {
      element.Fail(robot->model.Rigid(a, b)
                       ? "the two links are rigid to each other: they are never checked"
                       : "no joint keeps the two links together: they are checked unless "
                         "allowed_pairs names them");
    }
    if (robot->NeverChecks(a, b)) {
      element.Fail("the pair is among those that are never checked (allowed_pairs, or the SRDF's)");
    }
    robot->checked_pairs.emplace_back(a, b);
  }
}

bool HoldsPair(const LinkPairs& pairs, int link_a, int link_b) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const std::pair<int, int>& pair) {
    return std::minmax(pair.first, pair.second) == std::minmax(link_a, link_b);
  });
}

// What is checked for an SRDF's sake is part of the robot's identity: its text alone does not tell.
void AddCheckedPairs(const LinkPairs& of_srdf, Robot* robot, ContentHash* hash) {
  if (!of_srdf.empty()) hash->Add(std::string("checked_pairs"));
  for (const auto& [a, b] : of_srdf) {
    hash->Add(robot->model.links()[static_cast<std::size_t>(a)].name);
    hash->Add(robot->model.links()[static_cast<std::size_t>(b)].name);
    robot->checked_pairs.emplace_back(a, b);
  }
}

void AddWarnings(const std::vector<std::string>& warnings, Robot* robot) {
  robot->warnings.insert(robot->warnings.end(), warnings.begin(), warnings.end());
}

// Groups, pairs, virtual joints and spheres: those of the SRDF, if there is one, and what
// robot.yaml says itself. `other_spheres`: the SRDF's do not count. The result are the pairs that
// are checked only because the SRDF does not disable them.
LinkPairs ReadSemantics(const YamlNode& root, const fs::path& folder, bool other_spheres,
                        Robot* robot, ContentHash* hash) {
  const auto groups = root.Find("groups");
  LinkPairs checked_by_srdf;
  LinkPairs enabled;
  if (const auto file = root.Find("srdf")) {
    const NamedFile named = ReadNamedFile(*file, folder);
    hash->Add(named.text);
    Srdf srdf = ParseSrdf(named.text, named.path.string(), robot->model);
    robot->allowed_pairs = std::move(srdf.disabled_pairs);
    checked_by_srdf = std::move(srdf.checked_pairs);
    enabled = std::move(srdf.enabled_pairs);
    robot->spheres = std::move(srdf.spheres);
    AddWarnings(srdf.warnings, robot);
    if (!other_spheres) AddWarnings(srdf.sphere_warnings, robot);
    robot->virtual_joints = std::move(srdf.virtual_joints);
    if (!groups) {
      if (srdf.groups.empty()) file->Fail(NoGroupFault(srdf, named.path.string()));
      AddWarnings(srdf.group_warnings, robot);
      robot->why_no_group = std::move(srdf.why_no_group);
    }
    robot->groups = std::move(srdf.groups);
  }
  if (const auto joints = root.Find("virtual_joints")) {
    robot->virtual_joints = ReadVirtualJoints(*joints, robot->model);
  }
  if (groups || robot->groups.empty()) {
    robot->groups = ReadGroups(root.At("groups"), robot->model, &robot->warnings);
  }
  if (const auto pairs = root.Find("allowed_pairs")) {
    for (const YamlNode& pair : pairs->Elements()) {
      robot->allowed_pairs.push_back(ReadPair(pair, robot->model));
    }
  }
  if (const auto pairs = root.Find("checked_pairs")) ReadCheckedPairs(*pairs, robot);
  LinkPairs left = checked_by_srdf;
  std::erase_if(left, [&](const auto& pair) {
    const auto [a, b] = pair;
    return HoldsPair(enabled, a, b) || HoldsPair(robot->checked_pairs, a, b) ||
           robot->NeverChecks(a, b);
  });
  AddCheckedPairs(checked_by_srdf, robot, hash);
  return left;
}

// Nothing else would tell that the SRDF has links checked that a joint connects.
void WarnOfCheckedPairs(const YamlNode& srdf, const LinkPairs& left, Robot* robot) {
  constexpr std::size_t kMostNamed = 5;
  const auto has_body = [&](int link) {
    return !robot->model.links()[static_cast<std::size_t>(link)].collision.empty() ||
           std::ranges::find(robot->spheres, link, &LinkSphere::link) != robot->spheres.end();
  };
  std::vector<std::string> names;
  for (const auto& [a, b] : left) {
    if (!has_body(a) || !has_body(b)) continue;
    names.push_back(fmt::format("{} and {}", robot->model.links()[static_cast<std::size_t>(a)].name,
                                robot->model.links()[static_cast<std::size_t>(b)].name));
  }
  if (names.empty()) return;
  if (names.size() > kMostNamed) {
    const std::size_t more = names.size() - kMostNamed;
    names.resize(kMostNamed);
    names.push_back(fmt::format("{} more", more));
  }
  robot->warnings.push_back(fmt::format(
      "{}: checked, though a joint connects them, as the SRDF does not disable them: {}; if that "
      "is meant, name them in checked_pairs, otherwise in allowed_pairs",
      srdf.Where(), fmt::join(names, "; ")));
}

// Links with a body in the URDF that no sphere is on, and that are not `meant` to have none:
// nothing else would tell that they go unchecked.
std::vector<std::string> LinksWithout(const std::vector<LinkSphere>& spheres, std::set<int> meant,
                                      const RobotModel& model) {
  for (const LinkSphere& sphere : spheres) meant.insert(sphere.link);
  std::vector<std::string> unchecked;
  for (int link = 0; link < model.num_links(); ++link) {
    const Link& description = model.links()[static_cast<std::size_t>(link)];
    if (description.collision.empty() || meant.contains(link)) continue;
    unchecked.push_back(description.name);
  }
  return unchecked;
}

void WarnOfUncheckedLinks(const YamlNode& root, const std::string& spheres, Robot* robot) {
  std::set<int> meant;
  if (const auto names = root.Find("links_without_spheres")) {
    for (const YamlNode& name : names->Elements()) {
      meant.insert(LinkAt(name, name.String(), robot->model));
    }
  }
  if (robot->spheres.empty()) return;
  robot->unchecked_links = LinksWithout(robot->spheres, meant, robot->model);
  if (robot->unchecked_links.empty()) return;
  robot->warnings.push_back(fmt::format(
      "{}: no spheres for {}, which have bodies in the URDF: they are not checked; if that is "
      "meant, name them in links_without_spheres",
      spheres, fmt::join(robot->unchecked_links, ", ")));
}

VoxelSettings ReadVoxels(const YamlNode& node) {
  node.AllowOnly({"resolution_m", "lower", "upper", "walls", "hollow"});
  VoxelSettings settings;
  settings.resolution_m = node.At("resolution_m").PositiveDouble();
  settings.lower = Eigen::Vector3d(node.At("lower").Doubles(3).data());
  settings.upper = Eigen::Vector3d(node.At("upper").Doubles(3).data());
  settings.walls = node.At("walls").Bool();
  settings.hollow = node.BoolOr("hollow", false);
  AtField(node, [&] { return NumVoxels(settings); });
  return settings;
}

std::vector<std::string> JointNames(const PlanningGroup& group) {
  std::vector<std::string> names;
  for (const JointSpace::Joint& joint : group.space.joints()) names.push_back(joint.name);
  return names;
}

// The planning robot's group made of the referee's joints and links of the same names.
PlanningGroup MatchGroup(const PlanningGroup& group, const Robot& planning_robot,
                         const RobotModel& model, const std::string& origin) {
  const auto link_name = [&](int link) {
    return planning_robot.model.links()[static_cast<std::size_t>(link)].name;
  };
  std::vector<std::string> more_tips;
  for (const int tip : group.more_tips) more_tips.push_back(link_name(tip));
  try {
    return model.MakeGroup(group.name, JointNames(group), link_name(group.tip_link), more_tips);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: does not fit the robot '{}': {}", origin, planning_robot.name,
                                 error.what()));
  }
}

std::vector<fs::path> UrdfsIn(const fs::path& folder) {
  std::vector<fs::path> found;
  if (!IsFolder(folder)) return found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".urdf") {
      found.push_back(entry.path());
    }
  }
  return found;
}

// ROS packages have theirs in a folder `urdf`.
fs::path OnlyUrdf(const fs::path& folder) {
  std::vector<fs::path> found = UrdfsIn(folder);
  if (found.empty()) found = UrdfsIn(folder / "urdf");
  if (found.size() != 1) {
    throw InputError(
        fmt::format("{}: expected a robot.yaml or exactly one .urdf file, there or in its folder "
                    "urdf, found {} .urdf files",
                    folder.string(), found.size()));
  }
  return found.front();
}

bool MovesWithAGroup(const Robot& robot, int link) {
  while (robot.model.links()[static_cast<std::size_t>(link)].parent_joint >= 0) {
    const int index = robot.model.links()[static_cast<std::size_t>(link)].parent_joint;
    const Joint& joint = robot.model.joints()[static_cast<std::size_t>(index)];
    for (const PlanningGroup& group : robot.groups) {
      const auto& joints = group.joints;
      if (std::find(joints.begin(), joints.end(), index) != joints.end()) return true;
      if (std::find(joints.begin(), joints.end(), joint.leader) != joints.end()) return true;
    }
    link = joint.parent_link;
  }
  return false;
}

// A scene must have a place relative to the referee.
void RequireCommonBase(const Robot& planning_robot, const Robot& referee) {
  const std::string& root = planning_robot.model.links().front().name;
  const std::string& referee_root = referee.model.links().front().name;
  const int in_referee = referee.model.FindLink(root);
  const int in_planning = planning_robot.model.FindLink(referee_root);
  if (in_referee >= 0 ? !MovesWithAGroup(referee, in_referee)
                      : in_planning >= 0 && !MovesWithAGroup(planning_robot, in_planning)) {
    return;
  }
  throw InputError(
      fmt::format("{}: cannot be placed where the robot '{}' is: its root link '{}' and "
                  "that one's, '{}', have no fixed place in the other robot",
                  referee.folder.string(), planning_robot.name, referee_root, root));
}

// A referee with a robot.yaml of its own must still be able to judge every group that plans.
void AddPlanningGroups(const Robot& planning_robot, Robot* referee) {
  for (const PlanningGroup& group : planning_robot.groups) {
    const std::string origin = (referee->folder / "robot.yaml").string();
    PlanningGroup matched = MatchGroup(group, planning_robot, referee->model, origin);
    const auto own = std::find_if(referee->groups.begin(), referee->groups.end(),
                                  [&](const PlanningGroup& g) { return g.name == group.name; });
    if (own == referee->groups.end()) {
      referee->groups.push_back(std::move(matched));
    } else if (own->joints != matched.joints) {
      throw InputError(fmt::format("{}: group '{}' has other joints than in {}", origin, group.name,
                                   (planning_robot.folder / "robot.yaml").string()));
    }
  }
}

void FindMisfits(const Robot& planning_robot, Robot* referee) {
  referee->referee_misfits = RefereeMisfits(planning_robot, *referee);
  if (referee->referee_misfits.empty()) return;
  referee->warnings.push_back(fmt::format("{}: as the referee's robot: {}",
                                          referee->folder.string(), referee->referee_misfits));
}

}  // namespace

bool Robot::NeverChecks(int link_a, int link_b) const {
  return model.Rigid(link_a, link_b) || HoldsPair(allowed_pairs, link_a, link_b);
}

bool Robot::ChecksLinks(int link_a, int link_b) const {
  return !NeverChecks(link_a, link_b) &&
         (!model.Joined(link_a, link_b) || HoldsPair(checked_pairs, link_a, link_b));
}

const PlanningGroup& Robot::Group(const std::string& group_name) const {
  if (group_name.empty() && !groups.empty()) return groups.front();
  std::vector<std::string_view> known;
  for (const PlanningGroup& group : groups) {
    if (group.name == group_name) return group;
    known.push_back(group.name);
  }
  const auto why = why_no_group.find(group_name);
  throw InputError(fmt::format("robot '{}' has no group '{}'{}; known are: {}", name, group_name,
                               why == why_no_group.end() ? "" : " (" + why->second + ")",
                               fmt::join(known, ", ")));
}

Robot LoadRobot(const fs::path& folder_or_name, const std::map<std::string, fs::path>& packages,
                const fs::path& spheres) {
  const fs::path folder = FindRobotFolder(folder_or_name);
  Robot robot;
  robot.folder = fs::absolute(folder);
  robot.resources = {robot.folder, packages};

  const fs::path robot_file = folder / "robot.yaml";
  if (!IsRobotFolder(folder)) {
    throw InputError(robot_file.string() + ": no such file; make_robot writes it from a URDF");
  }
  const std::string robot_text = ReadText(robot_file);
  const YamlNode root = YamlNode::Parse(robot_text, robot_file.string());
  root.AllowOnly({"name", "urdf", "srdf", "spheres", "enclosing_spheres", "edge_resolution_m",
                  "edge_check", "groups", "allowed_pairs", "checked_pairs", "links_without_spheres",
                  "planners", "voxels", "virtual_joints"});
  ContentHash hash;
  hash.Add(robot_text);

  robot.name = root.At("name").String();
  if (robot.name.empty()) root.At("name").Fail("must not be empty");
  const NamedFile urdf = ReadNamedFile(root.At("urdf"), folder);
  hash.Add(urdf.text);
  robot.resources.own_folder = fs::absolute(urdf.path).parent_path();
  robot.model = RobotModel::FromUrdf(urdf.text, urdf.path.string(), &robot.warnings);
  const auto own_spheres = root.Find("spheres");
  const bool other_spheres = own_spheres || !spheres.empty();
  const LinkPairs left = ReadSemantics(root, folder, other_spheres, &robot, &hash);
  const auto read_spheres = [&](const NamedFile& file) {
    hash.Add(file.text);
    return ReadLinkSpheres(file.path, file.text, robot.model, &robot.warnings);
  };
  if (!spheres.empty()) {
    robot.spheres = read_spheres({spheres, ReadText(spheres)});
    robot.spheres_file = fs::absolute(spheres);
    if (robot.spheres.empty()) throw InputError(spheres.string() + ": no spheres");
    WarnOfUncheckedLinks(root, spheres.string(), &robot);
  } else if (own_spheres) {
    robot.spheres = read_spheres(ReadNamedFile(*own_spheres, folder));
    WarnOfUncheckedLinks(root, own_spheres->Where(), &robot);
  } else if (const auto srdf = root.Find("srdf")) {
    WarnOfUncheckedLinks(root, srdf->Where(), &robot);
  }
  if (const auto srdf = root.Find("srdf")) WarnOfCheckedPairs(*srdf, left, &robot);
  if (const auto named = root.Find("enclosing_spheres")) {
    robot.enclosing_spheres = read_spheres(ReadNamedFile(*named, folder));
    const auto bare = LinksWithout(robot.enclosing_spheres, {}, robot.model);
    if (!bare.empty()) {
      named->Fail(fmt::format("the spheres enclose nothing of {}, which have bodies in the URDF",
                              fmt::join(bare, ", ")));
    }
  }
  if (const auto resolution = root.Find("edge_resolution_m")) {
    robot.edge_resolution_m =
        resolution->DoubleWithin(kFinestEdgeResolution, kCoarsestEdgeResolution);
  }
  if (const auto method = root.Find("edge_check")) {
    robot.edge_check = method->Enum<EdgeCheck>();
  }
  if (const auto voxels = root.Find("voxels")) robot.voxels = ReadVoxels(*voxels);
  if (const auto planners = root.Find("planners")) {
    for (const std::string& planner : planners->Keys()) {
      // Planners read their own settings when they start: other programs must not need the files.
      const YamlNode file = planners->At(planner);
      file.String();
      robot.planner_settings.emplace(planner, file);
    }
  }
  robot.content_id = hash.HexDigest();
  return robot;
}

Robot LoadRefereeRobot(const fs::path& folder_or_name, const Robot& planning_robot,
                       const std::map<std::string, fs::path>& packages) {
  const fs::path folder =
      IsFolder(folder_or_name) ? folder_or_name : FindRobotFolder(folder_or_name);
  if (IsRobotFolder(folder)) {
    Robot referee = LoadRobot(folder, packages);
    AddPlanningGroups(planning_robot, &referee);
    RequireCommonBase(planning_robot, referee);
    FindMisfits(planning_robot, &referee);
    return referee;
  }

  const fs::path urdf_file = OnlyUrdf(folder);
  const std::string urdf_text = ReadText(urdf_file);
  Robot referee;
  referee.folder = fs::absolute(folder);
  referee.resources = {referee.folder, packages, fs::absolute(urdf_file).parent_path()};
  referee.model = RobotModel::FromUrdf(urdf_text, urdf_file.string(), &referee.warnings);
  referee.name = referee.model.name();
  referee.edge_resolution_m = planning_robot.edge_resolution_m;
  referee.edge_check = planning_robot.edge_check;
  for (const PlanningGroup& group : planning_robot.groups) {
    referee.groups.push_back(MatchGroup(group, planning_robot, referee.model, urdf_file.string()));
  }
  RequireCommonBase(planning_robot, referee);
  FindMisfits(planning_robot, &referee);
  // What the planning robot checks, and what it never does, holds for its judge, too.
  ContentHash hash;
  hash.Add(urdf_text);
  const auto add_pair = [&](const std::pair<int, int>& pair,
                            std::vector<std::pair<int, int>>* pairs) {
    const auto& links = planning_robot.model.links();
    const std::string& name_a = links[static_cast<std::size_t>(pair.first)].name;
    const std::string& name_b = links[static_cast<std::size_t>(pair.second)].name;
    const int link_a = referee.model.FindLink(name_a);
    const int link_b = referee.model.FindLink(name_b);
    if (link_a < 0 || link_b < 0) return;  // A pair that this robot does not have.
    pairs->emplace_back(link_a, link_b);
    hash.Add(name_a);
    hash.Add(name_b);
  };
  for (const auto& pair : planning_robot.allowed_pairs) add_pair(pair, &referee.allowed_pairs);
  if (!planning_robot.checked_pairs.empty()) hash.Add(std::string("checked_pairs"));
  for (const auto& pair : planning_robot.checked_pairs) add_pair(pair, &referee.checked_pairs);
  referee.content_id = hash.HexDigest();
  return referee;
}

}  // namespace planbench
