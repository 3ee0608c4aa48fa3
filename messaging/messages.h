#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "planning/path_judge.h"
#include "planning/plan_request.h"
#include "planning/plan_result.h"
#include "scene/problem.h"
#include "scene/scene.h"

/// The messages as value types; lcmtypes/ has the wire types, codec.h the conversions. `utime`
/// fields are left out where only the moment of sending matters: Encode sets them.
namespace planbench {

struct DiscoverMessage {
  std::string sender;
  bool operator==(const DiscoverMessage&) const = default;
};

enum class NodeKind { kSceneServer = 0, kPlanner = 1, kDriver = 2, kLogger = 3 };
template <>
struct EnumNames<NodeKind> {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"scene server", "planner", "driver", "logger"});
};

/// Setting of a planner that PlannerMain runs: its program, "planner_rrtc", whatever its name.
inline constexpr char kProgramSetting[] = "program";

struct NodeStatusMessage {
  std::int64_t utime = 0;        ///< us since the Unix epoch.
  std::int64_t start_utime = 0;  ///< us since the Unix epoch.
  std::string instance;          ///< 64 random bits, of the process.
  std::string name;
  NodeKind kind = NodeKind::kPlanner;
  bool busy = false;
  std::string request_id;
  std::string trouble;  ///< Why it cannot do its work at the moment; empty: it can.
  std::string host;
  std::int32_t pid = 0;
  std::string version;
  std::string commit;
  std::string robot_name;
  std::string robot_id;
  std::string algorithm;
  std::string planner_class;
  bool can_backward = false;
  bool can_anytime = false;
  bool can_improve = false;
  bool bidirectional = false;
  bool deterministic = false;
  std::vector<std::string> collision_models;
  std::map<std::string, std::string> unusable_models;  ///< Why these are not offered.
  std::map<std::string, std::string> settings;
  bool operator==(const NodeStatusMessage&) const = default;
};

struct ProblemSetSummary {
  std::string name;
  std::vector<int> indices;  ///< Ascending.
  std::string content_id;    ///< Equal sets, equal ids.
  bool operator==(const ProblemSetSummary&) const = default;
};

struct ProblemSetsMessage {
  std::string server;
  std::string robot_name;
  std::string robot_id;
  double edge_resolution_m = 0;              ///< The robot's default, > 0.
  EdgeCheck edge_check = EdgeCheck::kFixed;  ///< The robot's default.
  std::string mesh_robot_id;                 ///< Of the robot and its meshes (MeshRobotId).
  std::string referee_robot_id;  ///< The same of the mesh robot that judges paths too; empty: none.
  std::vector<ProblemSetSummary> sets;
  bool operator==(const ProblemSetsMessage&) const = default;
};

struct ProblemRequestMessage {
  std::string request_id;
  std::string problem_set;
  int problem_index = 0;
  bool operator==(const ProblemRequestMessage&) const = default;
};

struct ProblemMessage {
  std::string request_id;
  bool ok = true;
  std::string message;  ///< Why not; or, of a problem, what was read otherwise than written.
  std::string problem_set;
  int problem_index = 0;
  std::string scene_id;
  std::string group;
  JointState start;             ///< Every joint the problem names.
  std::vector<JointGoal> goal;  ///< Of the group's n joints, in m alternatives: m * n.
  double time_limit_s = 0;
  bool operator==(const ProblemMessage&) const = default;
};

struct SceneRequestMessage {
  std::string request_id;
  std::string scene_id;
  bool operator==(const SceneRequestMessage&) const = default;
};

struct SceneMessage {
  std::string request_id;
  std::string scene_id;
  bool ok = true;
  std::string message;
  Scene scene;
};

enum class PlanAckVerdict { kWorking = 0, kBusy = 1, kRefused = 2 };
template <>
struct EnumNames<PlanAckVerdict> {
  static constexpr auto kNames = std::to_array<std::string_view>({"WORKING", "BUSY", "REFUSED"});
};

struct PlanAckMessage {
  std::string planner;
  std::string request_id;
  PlanAckVerdict verdict = PlanAckVerdict::kWorking;
  std::string message;
  bool operator==(const PlanAckMessage&) const = default;
};

struct PlanProgressMessage {
  std::string planner;
  std::string request_id;
  PlanProgress progress;
  bool operator==(const PlanProgressMessage&) const = default;
};

struct PlanResultMessage {
  std::string planner;
  std::string run_id;
  std::string request_id;
  std::vector<std::string> joint_names;  ///< Of the paths' waypoints; empty if there is no path.
  PlanResult result;
  bool operator==(const PlanResultMessage&) const = default;
};

struct PlanCancelMessage {
  std::string request_id;
  bool operator==(const PlanCancelMessage&) const = default;
};

struct AckMessage {
  std::string id;
  std::string sender;
  bool ok = true;
  std::string message;
  bool operator==(const AckMessage&) const = default;
};

/// A straight joint motion.
struct EdgeQuery {
  Configuration from;
  Configuration to;
  bool operator==(const EdgeQuery&) const = default;
};

struct CollisionRequestMessage {
  std::string request_id;
  std::string scene_id;
  std::string group;
  JointState state;
  CollisionModel collision_model = CollisionModel::kSpheres;
  std::optional<double> edge_resolution_m;  ///< None: the robot's.
  std::optional<EdgeCheck> edge_check;      ///< None: the robot's.
  bool with_distance = false;
  std::vector<Configuration> states;  ///< Group order; all of one size.
  std::vector<EdgeQuery> edges;
  bool operator==(const CollisionRequestMessage&) const = default;
};

struct CollisionVerdict {
  bool within_limits = true;
  bool free = true;
  std::string body_a;
  std::string body_b;
  double depth_m = 0;
  double fraction = 0;
  double distance_m = 0;  ///< May be infinite: nothing to collide with.
  std::string nearest_a;
  std::string nearest_b;
  bool operator==(const CollisionVerdict&) const = default;
};

struct CollisionReplyMessage {
  std::string request_id;
  bool ok = true;
  std::string message;
  std::string engine;
  std::vector<CollisionVerdict> states;
  std::vector<CollisionVerdict> edges;
  bool operator==(const CollisionReplyMessage&) const = default;
};

struct PathCheckRequestMessage {
  std::string request_id;
  std::string scene_id;
  std::string group;
  JointState start;
  std::vector<JointGoal> goal;           ///< Alternatives; the path may end in any.
  std::vector<std::string> joint_names;  ///< Of the waypoints.
  Path path;
  CollisionModel collision_model = CollisionModel::kSpheres;
  double step_m = 0;
  bool with_clearance = false;
  bool operator==(const PathCheckRequestMessage&) const = default;
};

struct PathCheckReplyMessage {
  std::string request_id;
  bool ok = false;
  std::string message;
  std::string engine;
  double step_m = 0;
  std::optional<PathVerdict> verdict;  ///< With the geometry of the request's collision model.
  std::optional<PathVerdict>
      mesh_verdict;  ///< With the referee's mesh robot, if the server has one.
  bool operator==(const PathCheckReplyMessage&) const = default;
};

/// One of those that a session compares: a planner on the bus, and the conditions of its requests.
struct Contestant {
  std::string planner;        ///< Its name on the bus.
  std::string name;           ///< In tables and results.
  std::string about;          ///< What it is, in a line; may be empty.
  std::string published;      ///< Algorithm of the reference study whose figures stand beside it.
  std::string command;        ///< How it is started; empty: planbench's own.
  std::string first_path_of;  ///< Whose path it is given to improve (planner); empty: nobody's.
  std::optional<CollisionModel> collision_model;  ///< None, here and below: the session's.
  std::optional<double> edge_resolution_m;
  std::optional<EdgeCheck> edge_check;
  bool operator==(const Contestant&) const = default;
};

/// What can change a result and is no matter of which runs are made, nor of which processes make
/// them (SessionMessage::nodes).
struct SessionConditions {
  /// What all requests have in common; ids, problem and direction are left open, the seed is the
  /// session's.
  PlanRequest request;
  std::optional<double> referee_step_m;  ///< None: the driver's default.
  bool with_clearance = true;
  bool parallel = false;
  std::string mesh_robot_id;     ///< ProblemSetsMessage's; empty unless meshes are what is checked.
  std::string referee_robot_id;  ///< ProblemSetsMessage's.
  std::map<std::string, std::string> problem_sets;  ///< Content ids by name.
  std::vector<Contestant> contestants;              ///< In the order of the line-up.
  bool operator==(const SessionConditions&) const = default;
};

struct SessionMessage {
  std::string run_id;
  std::int64_t start_utime = 0;  ///< When it was begun, however often it was resumed since.
  bool finished = false;
  double total_time_s = 0;  ///< Steady clock; of the parts that told of their end, and the present.
  int num_runs = 0;
  std::string version;
  std::string commit;
  std::string host;
  std::string cpu;
  std::string robot_name;
  SessionConditions conditions;
  std::map<std::string, std::string> settings;  ///< The driver's flags.
  /// Problems that were to be run and that the scene server refuses, with its reasons; named
  /// "table_pick 3".
  std::map<std::string, std::string> left_out;
  std::vector<NodeStatusMessage> nodes;
  bool operator==(const SessionMessage&) const = default;
};

/// Of the messages about one session the last in this order tells how it stands.
inline auto SessionOrder(const SessionMessage& session) {
  return std::make_tuple(session.start_utime, session.total_time_s, session.finished);
}

struct RunRecordMessage {
  std::string run_id;
  std::string request_id;
  std::string planner;
  std::string contestant;  ///< The planner's name in tables and results.
  std::string algorithm;
  std::string planner_class;
  std::map<std::string, std::string> settings;
  std::string problem_set;
  int problem_index = 0;
  int trial = 1;
  std::int64_t start_utime = 0;
  PlanStatus status = PlanStatus::kNoAnswer;
  std::string message;
  double roundtrip_time_s = 0;
  PlanRequest request;
  PlanResultMessage result;
  PathCheckReplyMessage path_check;
  PathCheckReplyMessage simplified_check;
  bool operator==(const RunRecordMessage&) const = default;
};

}  // namespace planbench
