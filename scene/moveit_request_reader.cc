#include "scene/moveit_request_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "robot_model/full_positions.h"
#include "scene/moveit_fields.h"
#include "scene/moveit_messages.h"
#include "scene/moveit_pose_goal.h"
#include "scene/moveit_state_reader.h"

namespace planbench {
namespace {

/// What a longer time limit counts as, s: there is none.
constexpr double kLongestTime = 1e9;

double ReadTolerance(const YamlNode& constraint, const std::string& key) {
  const std::optional<YamlNode> node = constraint.Find(key);
  return node ? node->NonNegativeDouble() : 0;
}

void RefusePathConstraints(const YamlNode& request) {
  constexpr const char* kWhy =
      "constraints on the path are not supported; leave them out to plan without";
  if (const std::optional<YamlNode> path = request.Find("path_constraints")) {
    for (const char* kind : {"joint_constraints", "position_constraints", "orientation_constraints",
                             "visibility_constraints"}) {
      RefuseElements(*path, kind, kWhy);
    }
  }
  if (const std::optional<YamlNode> trajectory = request.Find("trajectory_constraints")) {
    RefuseElements(*trajectory, "constraints", kWhy);
  }
}

bool Meets(const JointGoal& goal, double position) {
  return position >= goal.position - goal.tolerance_below - JointSpace::kLimitTolerance &&
         position <= goal.position + goal.tolerance_above + JointSpace::kLimitTolerance;
}

const JointGoal* FindGoal(const std::vector<JointGoal>& goals, const std::string& joint) {
  const auto found = std::find_if(goals.begin(), goals.end(),
                                  [&](const JointGoal& goal) { return goal.joint == joint; });
  return found == goals.end() ? nullptr : &*found;
}

// Refuses a goal of a joint outside the group, or of a part of a pose, unless it is met wherever
// the group is, says the same of a follower as `goals` say of its leader, or of a fixed joint what
// a start may say.
void RequireMet(const JointGoal& goal, const YamlNode& node, const RobotModel& model,
                const PlanningGroup& group, const std::vector<JointGoal>& goals,
                const std::vector<double>& start) {
  const auto is_met = [&](double position, bool is_same_after_turn) {
    return Meets(goal, position) ||
           (is_same_after_turn && Meets(goal, goal.position + WrapAngle(position - goal.position)));
  };
  const auto fail = [&](const std::string& why, double position) {
    node.Fail(fmt::format("the joint '{}' {} at {:g}", goal.joint, why, position));
  };
  std::string why = "is not in group '" + group.name + "' and stays";
  if (const std::optional<PosePart> part = FindPosePart(model, goal.joint)) {
    const double position = PositionOf(*part, start);
    if (!is_met(position, part->is_angle)) fail(why, position);
    return;
  }
  const int index = model.FindJoint(goal.joint);
  if (index < 0) node.Fail("the joint '" + goal.joint + "' is unknown");
  const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
  if (NumPositions(joint.type) > 1) {
    node.Fail("the joint '" + goal.joint + "' has a pose; there are no goals for such");
  }
  double position = joint.offset;  // Of a fixed joint, 0.
  if (joint.position_index >= 0) position = start[static_cast<std::size_t>(joint.position_index)];
  if (joint.leader >= 0) {
    const std::string& leader = model.joints()[static_cast<std::size_t>(joint.leader)].name;
    if (group.space.Find(leader) >= 0) {
      const JointGoal* of_leader = FindGoal(goals, leader);
      if (of_leader == nullptr) {
        node.Fail("the joint '" + goal.joint + "' follows '" + leader + "'; give a goal for that");
      }
      position = of_leader->position;
      why = "follows '" + leader + "', whose goal puts it";
    }
    if (joint.position_index >= 0) position = joint.multiplier * position + joint.offset;
  }
  // A turn later its followers would be elsewhere, and this another posture.
  const bool is_same_after_turn =
      joint.type == JointType::kContinuous && model.FollowerThatTurnsMove(index) < 0;
  if (is_met(position, is_same_after_turn)) return;
  if (joint.type == JointType::kFixed) {
    const auto fault = FindPositionFault(model, goal.joint, goal.position);
    if (!fault) return;
    node.Fail("the joint '" + goal.joint + "' " + *fault);
  }
  fail(why, position);
}

// A quaternion and its negative are one rotation: full positions with those of held poses in the
// sign of goals that name all of one that is not 0.
std::vector<double> WithSignsOf(const std::vector<std::pair<JointGoal, YamlNode>>& goals,
                                const RobotModel& model, std::vector<double> full) {
  for (const Joint& joint : model.joints()) {
    if (NumPositions(joint.type) <= 1) continue;
    const int first = joint.position_index + 3;  // After x, y, z.
    double dot = 0;
    double named = 0;  // Squared length of the parts that have a goal.
    for (const auto& [goal, name] : goals) {
      const std::optional<PosePart> part = FindPosePart(model, goal.joint);
      if (!part || part->is_angle) continue;
      if (part->position_index < first || part->position_index > first + 3) continue;
      const double held = PositionOf(*part, full);
      dot += goal.position * held;
      named += held * held;
    }
    if (dot >= 0 || named < 1 - 1e-6) continue;
    for (int i = first; i <= first + 3; ++i) {
      double& position = full[static_cast<std::size_t>(i)];
      position = 0 - position;  // Messages need no -0.
    }
  }
  return full;
}

// What is left of a group's joint limits by the goals, which are those of a set at `node`.
JointSpace Narrowed(const JointSpace& space, const std::vector<JointGoal>& goals,
                    const YamlNode& node) {
  std::vector<JointSpace::Joint> joints = space.joints();
  for (JointSpace::Joint& joint : joints) {
    const JointGoal* goal = FindGoal(goals, joint.name);
    if (goal == nullptr) continue;
    const double lower = goal->position - goal->tolerance_below;
    const double upper = goal->position + goal->tolerance_above;
    if (joint.continuous) {
      if (upper - lower >= 2 * std::numbers::pi) continue;
      joint.continuous = false;
      joint.lower = lower;
      joint.upper = upper;
      continue;
    }
    joint.lower = std::max(joint.lower, lower);
    joint.upper = std::min(joint.upper, upper);
    if (joint.lower <= joint.upper) continue;
    node.Fail("the goal of joint '" + joint.name + "' is outside its limits");
  }
  return JointSpace(std::move(joints));
}

std::vector<JointGoal> ReadAlternatives(const YamlNode& constraints, const Robot& robot,
                                        const PlanningGroup& group,
                                        const std::vector<double>& start, const FrameTree& frames) {
  const RobotModel& model = robot.model;
  RefuseElements(constraints, "visibility_constraints",
                 "constraints on what is visible are not supported");
  const bool of_pose = HasPoseConstraints(constraints);
  if (!of_pose && constraints.At("joint_constraints").Size() == 0) {
    constraints.At("joint_constraints").Fail("holds no goal");
  }
  std::vector<JointGoal> goals;
  std::vector<std::pair<JointGoal, YamlNode>> others;  // With where their names stand.
  std::set<std::string> seen;
  for (const YamlNode& node : OptionalElements(constraints, "joint_constraints")) {
    JointGoal goal;
    const YamlNode name = node.At("joint_name");
    goal.joint = name.String();
    if (!seen.insert(goal.joint).second) {
      name.Fail("the joint '" + goal.joint + "' is named twice");
    }
    const YamlNode position = node.At("position");
    goal.position = position.Double();
    if (const auto doubt = FindPositionDoubt(model, goal.joint, goal.position)) {
      position.Warn("the joint '" + goal.joint + "' " + *doubt);
    }
    goal.tolerance_above = ReadTolerance(node, "tolerance_above");
    goal.tolerance_below = ReadTolerance(node, "tolerance_below");
    if (const int j = group.space.Find(goal.joint); j >= 0) {
      if (const auto doubt = group.space.FindTurnsDoubt(j, goal.position)) {
        position.Warn("the joint '" + goal.joint + "' " + *doubt);
      }
      goals.push_back(goal);
    } else {
      RefuseVirtualJoint(name, robot);
      others.emplace_back(goal, name);
    }
  }
  const std::vector<double> held = WithSignsOf(others, model, start);
  for (const auto& [goal, name] : others) RequireMet(goal, name, model, group, goals, held);
  for (JointGoal& goal : goals) {
    goal.position = group.space.WithoutTurns(group.space.Find(goal.joint), goal.position);
  }
  if (of_pose) {
    const JointSpace limits =
        Narrowed(group.space, goals, constraints.Find("joint_constraints").value_or(constraints));
    std::vector<JointGoal> alternatives;
    for (const std::vector<double>& q :
         FindPoseGoals(constraints, model, group, limits, start, frames)) {
      for (std::size_t k = 0; k < q.size(); ++k) {
        alternatives.push_back({.joint = limits.joints()[k].name, .position = q[k]});
      }
    }
    return alternatives;
  }
  std::vector<JointGoal> in_group_order;
  for (const JointSpace::Joint& joint : group.space.joints()) {
    const JointGoal* goal = FindGoal(goals, joint.name);
    if (goal == nullptr) {
      constraints.At("joint_constraints")
          .Fail("there is no goal for joint '" + joint.name + "' of group '" + group.name + "'");
    }
    in_group_order.push_back(*goal);
  }
  return in_group_order;
}

// Those that are of one of the groups. Others may be named, and say nothing.
std::set<std::string> JointsOfGoals(const YamlNode& request,
                                    const std::vector<PlanningGroup>& groups) {
  std::set<std::string> joints;
  for (const YamlNode& set : OptionalElements(request, "goal_constraints")) {
    for (const YamlNode& goal : OptionalElements(set, "joint_constraints")) {
      const std::string joint = goal.At("joint_name").String();
      const bool is_moved =
          std::any_of(groups.begin(), groups.end(),
                      [&](const PlanningGroup& group) { return group.space.Find(joint) >= 0; });
      if (is_moved) joints.insert(joint);
    }
  }
  return joints;
}

const PlanningGroup& GroupOfGoals(const YamlNode& request, const Robot& robot) {
  const std::set<std::string> joints = JointsOfGoals(request, robot.groups);
  const PlanningGroup* first = nullptr;
  for (const PlanningGroup& group : robot.groups) {
    const bool has_all = std::all_of(joints.begin(), joints.end(), [&](const std::string& joint) {
      return group.space.Find(joint) >= 0;
    });
    if (!has_all) continue;
    if (std::ssize(joints) == group.space.size()) return group;
    if (first == nullptr) first = &group;
  }
  return first == nullptr ? robot.Group("") : *first;
}

}  // namespace

void RequireRequest(const YamlNode& motion_plan_request) {
  if (!motion_plan_request.IsMap()) {
    motion_plan_request.Fail("expected a moveit_msgs/MotionPlanRequest, found no map");
  }
  RequireKnownFields(motion_plan_request, "moveit_msgs/MotionPlanRequest");
  RefusePathConstraints(motion_plan_request);
  const auto references = motion_plan_request.Find("reference_trajectories");
  if (references && !(references->IsSequence() && references->Size() == 0)) {
    references->Warn("are not read: planners are given the start and the goal alone");
  }
}

RequestGroup ReadGroup(const YamlNode& motion_plan_request, const Robot& robot) {
  const std::optional<YamlNode> name = motion_plan_request.Find("group_name");
  const bool is_named = name && !name->String().empty();
  if (!is_named && robot.groups.size() > 1) {
    RequestGroup chosen{.group = &GroupOfGoals(motion_plan_request, robot)};
    chosen.why = fmt::format("no group_name, so '{}'", chosen.group->name);
    std::vector<std::string> names;
    for (const PlanningGroup& group : robot.groups) names.push_back(group.name);
    name.value_or(motion_plan_request)
        .Warn(fmt::format("{}, of the groups {}", chosen.why, fmt::join(names, ", ")));
    return chosen;
  }
  return {.group = AtField(name.value_or(motion_plan_request),
                           [&] { return &robot.Group(is_named ? name->String() : ""); })};
}

std::vector<JointGoal> ReadGoal(const YamlNode& motion_plan_request, const Robot& robot,
                                const PlanningGroup& group, const std::vector<double>& start,
                                const FrameTree& frames) {
  const YamlNode sets = motion_plan_request.At("goal_constraints");
  if (sets.Size() == 0) sets.Fail("holds no goal");
  std::vector<JointGoal> goal;
  std::optional<OutOfReach> fault;  // of the first set that has one
  for (const YamlNode& set : sets.Elements()) {
    try {
      const auto alternatives = ReadAlternatives(set, robot, group, start, frames);
      goal.insert(goal.end(), alternatives.begin(), alternatives.end());
    } catch (const OutOfReach& error) {
      if (sets.Size() > 1) set.Warn("is out of reach, and left out");
      if (!fault) fault = error;
    }
  }
  if (goal.empty() && fault) throw OutOfReach(*fault);
  return goal;
}

std::optional<Workspace> ReadWorkspace(const YamlNode& motion_plan_request,
                                       const FrameTree& frames) {
  const std::optional<YamlNode> node = motion_plan_request.Find("workspace_parameters");
  if (!node) return std::nullopt;
  const std::optional<Workspace> workspace = ReadCorners(*node, ReadFrame(*node));
  if (!workspace || frames.Find(workspace->frame) != nullptr) return workspace;
  FrameNode(*node).Warn("unknown frame '" + workspace->frame +
                        "'; the workspace, which is kept but not enforced, is left out");
  return std::nullopt;
}

std::optional<Workspace> ReadCorners(const YamlNode& node, const std::string& frame) {
  const YamlNode max_corner = node.At("max_corner");
  const Workspace workspace{.frame = frame,
                            .min_corner = ReadVector3(node.At("min_corner")),
                            .max_corner = ReadVector3(max_corner)};
  // All zero is how a message leaves it unset.
  if (workspace.min_corner.isZero(0) && workspace.max_corner.isZero(0)) return std::nullopt;
  if (!(workspace.min_corner.array() < workspace.max_corner.array()).all()) {
    max_corner.Fail("must be greater than min_corner on every axis");
  }
  return workspace;
}

double ReadTimeLimit(const YamlNode& motion_plan_request) {
  const auto limit = motion_plan_request.Find("allowed_planning_time");
  return limit ? std::min(limit->NonNegativeDouble(), kLongestTime) : 0;
}

}  // namespace planbench
