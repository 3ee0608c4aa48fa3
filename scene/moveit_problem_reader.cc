#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "common/error.h"
#include "common/text.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_fields.h"
#include "scene/moveit_messages.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_request_reader.h"
#include "scene/moveit_scene_reader.h"
#include "scene/moveit_state_reader.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

// Positions that were measured, or written as text, may be this far outside (rad or m).
constexpr double kBeyondLimit = 1e-3;

// The message itself, of a file that holds it as the one field of a service's request or answer.
YamlNode Unwrapped(const YamlNode& file, const char* field) {
  if (!file.IsMap() || file.Keys() != std::vector<std::string>{field}) return file;
  return file.At(field);
}

// The request of a file that holds it alone, as a service's, or as the goal of MoveIt's action.
YamlNode UnwrappedRequest(const YamlNode& file) {
  const YamlNode message = Unwrapped(file, "motion_plan_request");
  if (!message.IsMap()) return message;
  const std::optional<YamlNode> action = message.Find("goal");
  const YamlNode goal = action.value_or(message);
  const std::optional<YamlNode> request = goal.IsMap() ? goal.Find("request") : std::nullopt;
  if (!request) return message;
  RequireKnownFields(message,
                     action ? "moveit_msgs/MoveGroupActionGoal" : "moveit_msgs/MoveGroupGoal");
  if (const auto options = goal.Find("planning_options")) {
    options->Warn("are not read; the scene is that of its own file alone");
  }
  return *request;
}

RobotStateFields OptionalState(const YamlNode& message, const char* field, const Robot& robot,
                               const PlanningGroup& group) {
  const std::optional<YamlNode> state = message.Find(field);
  return state ? ReadRobotState(*state, robot, group) : RobotStateFields();
}

void RequireRobot(const YamlNode& scene, const Robot& robot) {
  const std::optional<YamlNode> node = scene.Find("robot_model_name");
  const std::string name = node ? node->String() : "";
  if (name.empty() || name == robot.name || name == robot.model.name()) return;
  node->Fail("the scene is for robot '" + name + "', not for '" + robot.name + "'");
}

// Puts the followers in `start` where they are at those full positions.
void PlaceFollowers(const RobotModel& model, const std::vector<double>& full, JointState* start) {
  for (std::size_t i = 0; i < start->names.size(); ++i) {
    const int index = model.FindJoint(start->names[i]);
    if (index < 0) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    if (joint.leader < 0) continue;
    start->positions[i] = joint.offset;
    if (joint.position_index >= 0) {
      start->positions[i] +=
          joint.multiplier * full[static_cast<std::size_t>(joint.position_index)];
    }
  }
}

// Joints outside the group stay where they are: no planner and no referee asks for their limits.
// Those that none of the `names` of the start means are where a follower puts them.
void WarnOfHeldJoints(const YamlNode& node, const RobotModel& model, const PlanningGroup& group,
                      const std::vector<std::string>& names, const std::vector<double>& full) {
  std::vector<std::string> outside;
  for (const Joint& joint : model.joints()) {
    if (NumPositions(joint.type) != 1 || joint.leader >= 0) continue;
    if (group.space.Find(joint.name) >= 0) continue;
    const double position = full[static_cast<std::size_t>(joint.position_index)];
    if (position >= joint.lower - kBeyondLimit && position <= joint.upper + kBeyondLimit) continue;
    const std::string puts = FollowerThatPuts(model, model.FindJoint(joint.name), names);
    outside.push_back(fmt::format("'{}'{} at {:g} of [{}, {}]", joint.name,
                                  puts.empty() ? "" : fmt::format(", where '{}' has it,", puts),
                                  position, joint.lower, joint.upper));
  }
  if (outside.empty()) return;
  node.Warn(fmt::format("held joints are outside their limits: {}", fmt::join(outside, ", ")));
}

void RequireStartOfGroup(const YamlNode& request, const PlanningGroup& group,
                         const JointState& start) {
  const YamlNode node = request.Find("start_state").value_or(request);
  if (start.names.empty()) {
    node.Fail(
        "no start: neither the request's start_state nor the scene's robot_state names a "
        "joint");
  }
  for (const JointSpace::Joint& joint : group.space.joints()) {
    if (std::find(start.names.begin(), start.names.end(), joint.name) == start.names.end()) {
      node.Fail("the start does not name joint '" + joint.name + "' of group '" + group.name + "'");
    }
  }
}

// Warns of followers that contradict their leaders: in the scene's own state, or else at the start.
void WarnOfContradictions(const YamlNode& planning_scene, const YamlNode& request,
                          const RobotModel& model, const JointState& scene_state,
                          const JointState& start) {
  const auto of_scene = FindContradictions(model, scene_state.names, scene_state.positions);
  for (const std::string& what : of_scene) planning_scene.At("robot_state").Warn(what);
  for (const std::string& what : FindContradictions(model, start.names, start.positions)) {
    if (std::find(of_scene.begin(), of_scene.end(), what) != of_scene.end()) continue;
    request.Find("start_state").value_or(request).Warn(what);
  }
}

// The start: its joints, with followers where they are and without the whole turns of the group's,
// go to `joints`.
Stance ReadStart(const YamlNode& request, const RobotModel& model, const PlanningGroup& group,
                 const RobotStateFields& start, JointState* joints) {
  RequireStartOfGroup(request, group, start.joints);
  const YamlNode node = request.Find("start_state").value_or(request);
  std::vector<double> full =
      FullPositions(model, start.joints.names, start.joints.positions, "start");
  *joints = start.joints;
  for (std::size_t i = 0; i < joints->names.size(); ++i) {
    const int j = group.space.Find(joints->names[i]);
    if (j < 0) continue;
    const int joint = group.joints[static_cast<std::size_t>(j)];
    const int index = model.joints()[static_cast<std::size_t>(joint)].position_index;
    joints->positions[i] = group.space.WithoutTurns(j, joints->positions[i]);
    full[static_cast<std::size_t>(index)] = joints->positions[i];
  }
  PlaceFollowers(model, full, joints);
  WarnOfHeldJoints(node, model, group, joints->names, full);
  return {.positions = full, .placed_links = start.placed_links};
}

// The frame that the file is in: that which fixed_frame_transforms relate to themselves, else what
// the robot's state is in, else, of a transform between frames that the robot does not have, the
// child, which is where MoveIt writes it (a guess: tf has chains of such), else what the robot's
// virtual joint joins it to. "" if nothing names it.
PlanningFrame FindPlanningFrame(const Robot& robot, const RobotStateFields& start,
                                const RobotStateFields& scene_state,
                                const std::vector<FixedTransform>& transforms) {
  for (const FixedTransform& transform : transforms) {
    if (transform.header == transform.child) return {transform.child};
  }
  if (!start.placed_frame.empty()) return {start.placed_frame};
  for (const PlacedLink& placed : start.placed_links) {
    if (!placed.frame.empty()) return {placed.frame};
  }
  for (const std::string& name : {scene_state.frame, start.frame}) {
    if (!name.empty()) return {name};
  }
  const auto is_of_robot = [&](const std::string& name) {
    return robot.model.FindLink(name) >= 0 ||
           std::any_of(
               robot.virtual_joints.begin(), robot.virtual_joints.end(),
               [&](const VirtualJoint& joint) { return WithoutSlash(joint.parent_frame) == name; });
  };
  const auto is_outside = [&](const FixedTransform& transform) {
    return !transform.header.empty() && !is_of_robot(transform.header) &&
           !is_of_robot(transform.child);
  };
  const auto guess = std::find_if(transforms.begin(), transforms.end(), is_outside);
  if (guess != transforms.end()) {
    std::set<std::string> outside;  // Frames that lead on.
    for (const FixedTransform& transform : transforms) {
      if (is_outside(transform)) outside.insert({transform.header, transform.child});
    }
    for (const FixedTransform& transform : transforms) {
      if (robot.model.FindLink(transform.child) < 0) continue;
      if (!outside.contains(transform.header)) continue;
      transform.node.Warn(fmt::format(
          "taken as the pose of the frame '{}' in that of the link '{}', and so on outwards, as "
          "nothing names the planning frame; if it says where the robot stands, give the planning "
          "frame a transform to itself",
          transform.header, transform.child));
    }
    return {.name = guess->child, .is_guessed = true};
  }
  if (robot.virtual_joints.empty()) return {};
  return {WithoutSlash(robot.virtual_joints.front().parent_frame)};
}

// The frame that stands still while the robot goes from the scene's state to the start: the
// planning frame, or another that the robot is placed in; the root link where that is a link.
std::string StillFrame(const RobotModel& model, const std::vector<PlacedLink>& placed_links,
                       const std::string& planning_frame) {
  const bool is_placed_in =
      placed_links.empty() ||
      std::any_of(placed_links.begin(), placed_links.end(), [&](const PlacedLink& placed) {
        return placed.frame.empty() || placed.frame == planning_frame;
      });
  const std::string& frame = is_placed_in ? planning_frame : placed_links.front().frame;
  return model.FindLink(frame) >= 0 ? model.links().front().name : frame;
}

// Links without a body may share their name with an object, but not what the matrix allows them.
void RequireNamesOfOne(const YamlNode& matrix, const Robot& robot, const Scene& scene) {
  std::set<std::string> allowed;
  for (const auto& [pair, allows] : scene.allowed_collisions.entries()) {
    if (allows) allowed.insert({pair.first, pair.second});
  }
  for (const auto& [name, allows] : scene.allowed_collisions.default_entries()) {
    if (allows) allowed.insert(name);
  }
  const auto require = [&](const std::string& id) {
    if (robot.model.FindLink(id) < 0 || !allowed.contains(id)) return;
    matrix.Fail("allows collisions of '" + id + "', which is the name of a link and of an object");
  };
  for (const SceneObject& object : scene.objects) require(object.id);
  for (const AttachedObject& attached : scene.attached) require(attached.object.id);
}

// Names of what is not there are common. One nearly that of a link that the matrix does not name is
// a slip.
void WarnOfMisspelledLinks(const YamlNode& matrix, const RobotModel& model, const Scene& scene) {
  std::vector<YamlNode> names = OptionalElements(matrix, "entry_names");
  for (const YamlNode& name : OptionalElements(matrix, "default_entry_names")) {
    names.push_back(name);
  }
  std::set<std::string> known;
  for (const SceneObject& object : scene.objects) known.insert(object.id);
  for (const AttachedObject& attached : scene.attached) known.insert(attached.object.id);
  std::set<std::string> named;
  for (const YamlNode& name : names) named.insert(name.String());
  std::vector<std::string_view> unnamed_links;
  for (const Link& link : model.links()) {
    known.insert(link.name);
    if (!named.contains(link.name)) unnamed_links.push_back(link.name);
  }
  for (const YamlNode& name : names) {
    if (known.contains(name.String())) continue;
    const std::string nearest = NearestName(name.String(), unnamed_links);
    if (nearest.empty()) continue;
    name.Warn(fmt::format("'{}' is no link and no object; did you mean the link '{}'?",
                          name.String(), nearest));
  }
}

// Adds a frame, if it is known, no link and not yet `added`, where it is in the base frame.
void AddFixedFrame(const std::string& name, const FrameTree& frames, const RobotModel& model,
                   std::set<std::string>* added, std::vector<FrameTransform>* fixed) {
  const Eigen::Isometry3d* X_BF = frames.Find(name);
  if (X_BF == nullptr || name.empty() || model.FindLink(name) >= 0) return;
  if (added->insert(name).second) fixed->push_back({name, *X_BF});
}

// What `read` reads for that group. Its errors say why it is that group.
template <typename Read>
auto ReadFor(const RequestGroup& chosen, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    if (chosen.why.empty()) throw;
    throw InputError(fmt::format("{} ({})", error.what(), chosen.why));
  }
}

}  // namespace

Problem ParseProblem(const YamlNode& scene_file, const YamlNode& request_file, const Robot& robot,
                     const ResourceResolver& resources) {
  const YamlNode planning_scene = Unwrapped(scene_file, "scene");
  const YamlNode request = UnwrappedRequest(request_file);
  RequireScene(planning_scene);
  RequireRequest(request);
  RequireRobot(planning_scene, robot);

  Problem problem;
  const RequestGroup chosen = ReadGroup(request, robot);
  const PlanningGroup& group = *chosen.group;
  problem.group = group.name;
  const RobotStateFields scene_state = OptionalState(planning_scene, "robot_state", robot, group);
  const RobotStateFields start_state = OptionalState(request, "start_state", robot, group);
  const RobotStateFields start = Overlaid(scene_state, start_state);
  WarnOfContradictions(planning_scene, request, robot.model, scene_state.joints, start.joints);
  const Stance at_start = ReadFor(
      chosen, [&] { return ReadStart(request, robot.model, group, start, &problem.start); });
  // Where a scene's things are is said with the robot in the scene's own state. What that leaves
  // open is as at the start.
  Stance in_scene = at_start;
  PutPositions(robot.model, scene_state.joints.names, scene_state.joints.positions,
               &in_scene.positions);
  in_scene.placed_links = Overlaid(start, scene_state).placed_links;

  const std::vector<FixedTransform> transforms = ReadFixedTransforms(planning_scene);
  const PlanningFrame planning_frame = FindPlanningFrame(robot, start, scene_state, transforms);
  FrameTree frames(robot, at_start, planning_frame, transforms);
  FrameTree scene_frames(robot, in_scene, planning_frame, transforms);
  scene_frames.MoveToBaseOf(
      frames, StillFrame(robot.model, start.placed_links, planning_frame.name),
      start.placed_links.empty() ? planning_scene : start.placed_links.front().node);
  Scene& scene = problem.scene;
  scene.name = planning_scene.StringOr("name", "");
  scene.robot_name = planning_scene.StringOr("robot_model_name", "");
  scene.world_frame = robot.model.links().front().name;
  std::set<std::string> fixed;
  for (const FixedTransform& transform : transforms) {
    for (const std::string& name : {transform.header, transform.child}) {
      AddFixedFrame(name, frames, robot.model, &fixed, &scene.fixed_frames);
    }
  }
  AddSceneObjects(planning_scene, resources, robot, &scene_frames, &scene);
  frames.SetObjectsOf(scene_frames);
  if (const auto state = request.Find("start_state")) {
    AddAttachedObjects(*state, resources, robot, &frames, &scene);
    // A whole state says all that is attached, as in MoveIt, for which one without joints is no
    // state. Who leaves is_diff out means what the scene attaches to stay.
    const auto is_diff = state->Find("is_diff");
    const bool has_joints = !start_state.joints.names.empty() || !start_state.placed_links.empty();
    if (is_diff && !ReadFlag(*is_diff) && has_joints) {
      DetachUnnamed(*state, *is_diff, &frames, &scene);
    }
  }
  if (const auto matrix = planning_scene.Find("allowed_collision_matrix")) {
    scene.allowed_collisions = ReadAllowedCollisions(*matrix, robot.model);
    RequireNamesOfOne(*matrix, robot, scene);
    WarnOfMisspelledLinks(*matrix, robot.model, scene);
  }

  problem.goal =
      ReadFor(chosen, [&] { return ReadGoal(request, robot, group, at_start.positions, frames); });
  problem.workspace = ReadWorkspace(request, frames);
  // Nothing else tells of its frame, once all that is given in one is in the base frame.
  if (problem.workspace) {
    AddFixedFrame(problem.workspace->frame, frames, robot.model, &fixed, &scene.fixed_frames);
  }
  problem.time_limit_s = ReadTimeLimit(request);
  problem.warnings = scene_file.warnings();
  problem.warnings.insert(problem.warnings.end(), request_file.warnings().begin(),
                          request_file.warnings().end());
  return problem;
}

Problem ReadProblem(const std::filesystem::path& scene_file,
                    const std::filesystem::path& request_file, const Robot& robot) {
  RequireProblemFiles(scene_file, request_file);
  const YamlNode scene = YamlNode::LoadFile(scene_file.string());
  const YamlNode request = YamlNode::LoadFile(request_file.string());
  Problem problem =
      ParseProblem(scene, request, robot, {scene_file.parent_path(), robot.resources.packages});
  if (const std::optional<int> index = ProblemIndexOf(scene_file)) {
    problem.index = *index;
    problem.set = ProblemSetNameOf(scene_file.parent_path());
  }
  return problem;
}

}  // namespace planbench
