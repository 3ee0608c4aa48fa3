#include "planning/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "common/error.h"
#include "robot_model/full_positions.h"

namespace planbench {
namespace {

/// How far the start of a path may be from the asked one (rad or m), the rounding of
/// interpolation.
constexpr double kStartRounding = 1e-9;

void RequireFinite(double value, const std::string& origin, const std::string& what,
                   const std::string& joint) {
  if (!std::isfinite(value)) {
    throw InputError(
        fmt::format("{}: {} of joint '{}' is {}, not a finite number", origin, what, joint, value));
  }
}

std::vector<double> ResolveStart(const Robot& robot, const PlanningGroup& group,
                                 const JointState& start, const std::string& origin) {
  std::vector<double> positions = FullPositions(robot.model, start.names, start.positions, origin);
  for (std::size_t i = 0; i < start.names.size(); ++i) {
    RequireFinite(start.positions[i], origin, "start position", start.names[i]);
  }
  for (const JointSpace::Joint& joint : group.space.joints()) {
    if (std::find(start.names.begin(), start.names.end(), joint.name) == start.names.end()) {
      throw InputError(fmt::format("{}: the start does not name joint '{}' of group '{}'", origin,
                                   joint.name, group.name));
    }
  }
  return positions;
}

void PutGoal(const JointSpace& space, const JointGoal& goal, std::size_t k, GoalBox* box) {
  box->nominal[k] = goal.position;
  box->lower[k] = goal.position - goal.tolerance_below;
  box->upper[k] = goal.position + goal.tolerance_above;
  const JointSpace::Joint& joint = space.joint(static_cast<int>(k));
  if (joint.continuous) return;
  // The part beyond the joint limits cannot be reached; min and max keep a nominal goal that is
  // itself beyond them inside its box, for the planner to report.
  box->lower[k] = std::min(box->nominal[k], std::max(box->lower[k], joint.lower));
  box->upper[k] = std::max(box->nominal[k], std::min(box->upper[k], joint.upper));
}

GoalBox ResolveAlternative(const PlanningGroup& group, std::span<const JointGoal> goals,
                           const std::string& origin) {
  const JointSpace& space = group.space;
  const auto n = static_cast<std::size_t>(space.size());
  GoalBox box = {Configuration(n), Configuration(n), Configuration(n)};
  std::vector<bool> given(n, false);
  for (const JointGoal& goal : goals) {
    const int j = space.Find(goal.joint);
    if (j < 0) {
      throw InputError(fmt::format("{}: goal for joint '{}', which is not in group '{}'", origin,
                                   goal.joint, group.name));
    }
    const auto k = static_cast<std::size_t>(j);
    if (given[k]) {
      throw InputError(fmt::format("{}: two goals for joint '{}'", origin, goal.joint));
    }
    given[k] = true;
    RequireFinite(goal.position, origin, "goal position", goal.joint);
    for (const double tolerance : {goal.tolerance_above, goal.tolerance_below}) {
      RequireFinite(tolerance, origin, "goal tolerance", goal.joint);
      if (tolerance < 0) {
        throw InputError(fmt::format("{}: goal tolerance of joint '{}' is {}, must not be negative",
                                     origin, goal.joint, tolerance));
      }
    }
    PutGoal(space, goal, k, &box);
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (!given[k]) {
      throw InputError(fmt::format("{}: no goal for joint '{}' of group '{}'", origin,
                                   space.joint(static_cast<int>(k)).name, group.name));
    }
  }
  return box;
}

}  // namespace

ResolvedQuery ResolveQuery(const Robot& robot, const PlanningGroup& group, const JointState& start,
                           const std::vector<JointGoal>& goal, const std::string& origin) {
  const auto n = static_cast<std::size_t>(group.space.size());
  ResolvedQuery query;
  query.base_positions = ResolveStart(robot, group, start, origin);
  query.start.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Joint& joint = robot.model.joints()[static_cast<std::size_t>(group.joints[k])];
    query.start[k] = query.base_positions[static_cast<std::size_t>(joint.position_index)];
  }

  const std::size_t num_alternatives = std::max<std::size_t>(1, (goal.size() + n - 1) / n);
  for (std::size_t i = 0; i < num_alternatives; ++i) {
    const std::size_t first = i * n;
    query.goals.push_back(ResolveAlternative(
        group, std::span(goal).subspan(first, std::min(n, goal.size() - first)),
        num_alternatives == 1 ? origin
                              : fmt::format("{}: alternative {} of the goal", origin, i + 1)));
  }
  return query;
}

Path ResolveInitialPath(const PlanningGroup& group, const ResolvedQuery& query,
                        const std::vector<std::string>& joint_names, const Path& path,
                        const std::string& origin) {
  if (path.empty()) return {};
  const JointSpace& space = group.space;
  const auto n = static_cast<std::size_t>(space.size());
  std::vector<std::size_t> column(n, n);  // by joint of the group
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    const int j = space.Find(joint_names[i]);
    if (j < 0 || column[static_cast<std::size_t>(j)] != n) {
      throw InputError(
          fmt::format("{}: initial_path names joint '{}'{}", origin, joint_names[i],
                      j < 0 ? ", which is not in group '" + group.name + "'" : " twice"));
    }
    column[static_cast<std::size_t>(j)] = i;
  }
  Path resolved;
  for (const Configuration& waypoint : path) {
    if (joint_names.size() != n || waypoint.size() != n) {
      throw InputError(fmt::format(
          "{}: initial_path has {} joints and waypoints of {}, group '{}' has {} joints", origin,
          joint_names.size(), waypoint.size(), group.name, n));
    }
    Configuration& q = resolved.emplace_back(n);
    for (std::size_t k = 0; k < n; ++k) {
      q[k] = waypoint[column[k]];
      RequireFinite(q[k], origin, "initial_path", joint_names[column[k]]);
    }
  }
  if (!(space.Distance(resolved.front(), query.start) <= kStartRounding)) {
    throw InputError(origin + ": initial_path does not begin at the start");
  }
  // A path of one waypoint is one only if the start is in the goal.
  resolved.front() = query.start;
  if (std::none_of(query.goals.begin(), query.goals.end(),
                   [&](const GoalBox& goal) { return goal.Contains(space, resolved.back()); })) {
    throw InputError(origin + ": initial_path does not end in a goal");
  }
  return resolved;
}

}  // namespace planbench
