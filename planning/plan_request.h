#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/collision_model.h"
#include "planning/plan_result.h"
#include "robot_model/edge_check.h"
#include "scene/problem.h"

namespace planbench {

/// One request to one planner, in names; Planner resolves it against its robot.
struct PlanRequest {
  std::string run_id;      ///< The benchmark session it belongs to.
  std::string request_id;  ///< Unique; equal ids are the same request.
  std::string scene_id;
  std::string robot_id;         ///< Content id of the robot meant; empty: any.
  std::string group;            ///< Empty: the robot's first group.
  JointState start;             ///< All joints it names; those outside the group are held there.
  std::vector<JointGoal> goal;  ///< Alternatives, as Problem::goal.
  Direction direction = Direction::kForward;
  double time_limit_s = 60;
  std::uint64_t seed = 1;
  CollisionModel collision_model = CollisionModel::kSpheres;
  std::optional<double> edge_resolution_m;  ///< None: the robot's.
  std::optional<EdgeCheck> edge_check;      ///< None: the robot's.
  bool anytime = false;  ///< Keep improving until the time limit; else stop at the first solution.
  bool simplify = true;  ///< Run the shared shortcutting pass on the path.
  /// From start to goal, for a planner that can improve one; empty: none. Names every joint of the
  /// group once, in the order of the waypoints' positions.
  std::vector<std::string> initial_joint_names;
  Path initial_path;
  std::map<std::string, std::string> parameters;  ///< Planner settings for this request only.
  bool operator==(const PlanRequest&) const = default;
};

}  // namespace planbench
