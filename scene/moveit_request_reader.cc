#include <set>

#include "scene/moveit_fields.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

constexpr const char* kOtherConstraints[] = {"position_constraints", "orientation_constraints",
                                             "visibility_constraints"};

double ReadTolerance(const YamlNode& constraint, const std::string& key) {
  const std::optional<YamlNode> node = constraint.Find(key);
  if (!node) return 0;
  const double tolerance = node->Double();
  if (tolerance < 0) node->Fail("must not be negative");
  return tolerance;
}

std::vector<JointGoal> ReadGoal(const YamlNode& request) {
  const YamlNode sets = request.At("goal_constraints");
  if (sets.Size() == 0) sets.Fail("holds no goal");
  if (sets.Size() > 1) sets.At(1).Fail("only one set of goal constraints is supported");
  const YamlNode constraints = sets.At(0);
  for (const char* other : kOtherConstraints) {
    RefuseElements(constraints, other, "only joint constraints are supported as a goal");
  }
  const YamlNode joint_constraints = constraints.At("joint_constraints");
  if (joint_constraints.Size() == 0) joint_constraints.Fail("holds no goal");
  std::vector<JointGoal> goal;
  std::set<std::string> seen;
  for (const YamlNode& node : joint_constraints.Elements()) {
    JointGoal joint;
    const YamlNode name = node.At("joint_name");
    joint.joint = name.String();
    if (!seen.insert(joint.joint).second) {
      name.Fail("the joint '" + joint.joint + "' is named twice");
    }
    joint.position = node.At("position").Double();
    joint.tolerance_above = ReadTolerance(node, "tolerance_above");
    joint.tolerance_below = ReadTolerance(node, "tolerance_below");
    goal.push_back(joint);
  }
  return goal;
}

void RefusePathConstraints(const YamlNode& request) {
  constexpr const char* kWhy = "constraints on the path are not supported";
  if (const std::optional<YamlNode> path = request.Find("path_constraints")) {
    RefuseElements(*path, "joint_constraints", kWhy);
    for (const char* other : kOtherConstraints) RefuseElements(*path, other, kWhy);
  }
  if (const std::optional<YamlNode> trajectory = request.Find("trajectory_constraints")) {
    RefuseElements(*trajectory, "constraints", kWhy);
  }
}

std::optional<Workspace> ReadWorkspace(const YamlNode& request) {
  const std::optional<YamlNode> node = request.Find("workspace_parameters");
  if (!node) return std::nullopt;
  Workspace workspace;
  workspace.frame = ReadFrame(*node);
  const YamlNode max_corner = node->At("max_corner");
  workspace.min_corner = ReadVector3(node->At("min_corner"));
  workspace.max_corner = ReadVector3(max_corner);
  // All zero is how a message leaves it unset.
  if (workspace.min_corner.isZero(0) && workspace.max_corner.isZero(0)) return std::nullopt;
  if (!(workspace.min_corner.array() < workspace.max_corner.array()).all()) {
    max_corner.Fail("must be greater than min_corner on every axis");
  }
  return workspace;
}

}  // namespace

void ReadRequest(const YamlNode& motion_plan_request, Problem* problem,
                 const ResourceResolver& resources) {
  if (!motion_plan_request.IsMap()) {
    motion_plan_request.Fail("expected a moveit_msgs/MotionPlanRequest, found no map");
  }
  problem->group = motion_plan_request.StringOr("group_name", "");
  if (const std::optional<YamlNode> start = motion_plan_request.Find("start_state")) {
    problem->start = ReadJointState(*start);
    AddAttachedObjects(*start, resources, &problem->scene);
  }
  if (problem->start.names.empty() && problem->scene_state.names.empty()) {
    motion_plan_request.Fail(
        "no start: neither the request's start_state nor the scene's robot_state names a joint");
  }
  problem->goal = ReadGoal(motion_plan_request);
  RefusePathConstraints(motion_plan_request);
  problem->workspace = ReadWorkspace(motion_plan_request);
  problem->time_limit_s = 0;
  if (const auto limit = motion_plan_request.Find("allowed_planning_time")) {
    problem->time_limit_s = limit->Double();
    if (problem->time_limit_s < 0) limit->Fail("must not be negative");
  }
}

Problem ReadProblem(const std::filesystem::path& scene_file,
                    const std::filesystem::path& request_file, const ResourceResolver& resources) {
  Problem problem;
  if (const std::optional<int> index = ProblemIndexOf(scene_file)) {
    problem.index = *index;
    problem.set = ProblemSetNameOf(scene_file.parent_path());
  }
  const YamlNode scene = YamlNode::LoadFile(scene_file.string());
  problem.scene = ReadScene(scene, resources);
  if (const std::optional<YamlNode> robot_state = scene.Find("robot_state")) {
    problem.scene_state = ReadJointState(*robot_state);
  }
  ReadRequest(YamlNode::LoadFile(request_file.string()), &problem, resources);
  return problem;
}

}  // namespace planbench
