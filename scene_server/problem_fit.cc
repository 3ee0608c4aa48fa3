#include "scene_server/problem_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "common/error.h"
#include "planning/resolve.h"

namespace planbench {
namespace {

const PlanningGroup& GroupOf(const Problem& problem, const ProblemFiles& files,
                             const Robot& robot) {
  try {
    return robot.Group(problem.group);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: group_name: {}", files.request.string(), error.what()));
  }
}

void RequireJointsKnown(const JointState& state, const Robot& robot, const std::string& origin) {
  FullPositions(robot.model, state.names, state.positions,
                fmt::format("{}: not a problem for robot '{}'", origin, robot.name));
}

}  // namespace

JointState StartOf(const Problem& problem) {
  JointState start = problem.scene_state;
  for (std::size_t i = 0; i < problem.start.names.size(); ++i) {
    const auto found = std::find(start.names.begin(), start.names.end(), problem.start.names[i]);
    if (found == start.names.end()) {
      start.names.push_back(problem.start.names[i]);
      start.positions.push_back(problem.start.positions[i]);
    } else {
      start.positions[static_cast<std::size_t>(found - start.names.begin())] =
          problem.start.positions[i];
    }
  }
  return start;
}

void RequireProblemFits(const Problem& problem, const ProblemFiles& files, const Robot& robot) {
  const std::string& name = problem.scene.robot_name;
  if (!name.empty() && name != robot.name && name != robot.model.name()) {
    throw InputError(fmt::format("{}: robot_model_name: the scene is for robot '{}', not for '{}'",
                                 files.scene.string(), name, robot.name));
  }
  for (const AttachedObject& attached : problem.scene.attached) {
    if (robot.model.FindLink(attached.link) < 0) {
      throw InputError(fmt::format(
          "{}: attached_collision_objects: '{}' is attached to link '{}', which robot '{}' lacks",
          files.scene.string(), attached.object.id, attached.link, robot.name));
    }
  }
  RequireJointsKnown(problem.scene_state, robot,
                     files.scene.string() + ": robot_state.joint_state");
  RequireJointsKnown(problem.start, robot, files.request.string() + ": start_state.joint_state");
  const PlanningGroup& group = GroupOf(problem, files, robot);
  ResolveQuery(robot, group, StartOf(problem), problem.goal,
               files.request.string() + ": start_state and goal_constraints");
}

}  // namespace planbench
