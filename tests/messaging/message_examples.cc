#include "tests/messaging/message_examples.h"

#include <cmath>
#include <limits>

namespace planbench {
namespace {

Eigen::Isometry3d Pose(double x, double y, double z, double angle) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.linear() =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  return pose;
}

JointState ExampleState() {
  return {{"lift", "shoulder", "wrist"}, {0.1, -1.0 / 3, 3.141592653589793}};
}

std::vector<JointGoal> ExampleGoal() {
  return {{"shoulder", 0.7, 0.01, 0.02}, {"wrist", -3.14, 0, 1e-300}};
}

PathVerdict ExampleVerdict() {
  PathVerdict verdict;
  verdict.valid = false;
  verdict.reason = "wrist touches can";
  verdict.segment = 2;
  verdict.fraction = 0.25;
  verdict.contact = Contact{"wrist", "can", 0.003};
  verdict.length = 4.5;
  verdict.tip_travel_m = 1.25;
  verdict.smoothness = 0.5;
  verdict.clearance_min_m = 0.01;
  verdict.clearance_mean_m = std::numeric_limits<double>::infinity();
  verdict.num_samples = 77;
  return verdict;
}

}  // namespace

TriangleMesh ExampleMesh() {
  return {{{1.0 / 3, 0.1, -1e-17}, {0.2, 1.0 / 7, 0}, {-0.3, 0.1, 1e-3}, {0.1, 0.1, std::sqrt(2)}},
          {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
}

Scene ExampleScene() {
  Scene scene;
  scene.name = "table";
  scene.robot_name = "arm";
  scene.world_frame = "base";
  SceneObject table{"table", Pose(0.5, 0, 0.2, 0.3), {}};
  table.shapes.push_back({Box{{1, 0.5, 0.04}}, Pose(0, 0, 0.1, 0)});
  table.shapes.push_back({Cylinder{0.03, 0.5}, Pose(0.1, 0.2, 0, 1.7)});
  table.shapes.push_back({Sphere{0.1}, Pose(0.3, 0, 0, 3.1)});
  table.shapes.push_back({Cone{0.1, 0.2}, Pose(0, -0.3, 0, -2)});
  table.shapes.push_back({Capsule{0.05, 0.3}, Pose(0, 0.4, 0, 0.5)});
  table.shapes.push_back({HalfSpace{}, Pose(0, 0, -0.2, 1)});
  scene.objects.push_back(table);
  Mesh mesh;
  mesh.triangles = ExampleMesh();
  scene.objects.push_back({"rock", Pose(1.0 / 3, 2, 0, 0.1), {{mesh, Pose(0, 0, 0.7, 0.9)}}});
  scene.attached.push_back(
      {"gripper", {"can", Pose(0.1, 0, 0, 1), {{Cylinder{0.03, 0.14}}}}, {"finger_l", "finger_r"}});
  scene.allowed_collisions.SetEntry("base", "shoulder", true);
  scene.allowed_collisions.SetEntry("can", "table", false);
  scene.allowed_collisions.SetDefaultEntry("estop", true);
  scene.fixed_frames.push_back({"camera", Pose(0, 0, 1, 2)});
  return scene;
}

template <>
DiscoverMessage Example() {
  return {"driver"};
}

template <>
NodeStatusMessage Example() {
  NodeStatusMessage status;
  status.utime = 1700000000123456;
  status.start_utime = 1700000000000000;
  status.name = "rrtc-2";
  status.kind = NodeKind::kPlanner;
  status.busy = true;
  status.request_id = "r1";
  status.host = "machine";
  status.pid = 4711;
  status.version = "0.1.0";
  status.commit = "abcdef";
  status.robot_name = "arm";
  status.robot_id = "0123";
  status.algorithm = "RRT-Connect";
  status.planner_class = "sampling-guided";
  status.can_backward = true;
  status.can_anytime = true;
  status.collision_models = {"spheres", "meshes"};
  status.settings = {{"range", "1.0"}, {"empty", ""}};
  return status;
}

template <>
ProblemSetsMessage Example() {
  return {"scene-server",
          "arm",
          "0123",
          0.02,
          EdgeCheck::kCertified,
          true,
          {{"shelf", {1, 2, 100}}, {"box", {}}}};
}

template <>
ProblemRequestMessage Example() {
  return {"r2", "shelf", 17};
}

template <>
ProblemMessage Example() {
  ProblemMessage message;
  message.request_id = "r3";
  message.ok = true;
  message.message = "note";
  message.problem_set = "shelf";
  message.problem_index = 17;
  message.scene_id = "5c";
  message.group = "arm";
  message.start = ExampleState();
  message.goal = ExampleGoal();
  message.time_limit_s = 60;
  return message;
}

template <>
SceneRequestMessage Example() {
  return {"r4", "5c"};
}

template <>
SceneMessage Example() {
  const Scene scene = ExampleScene();
  return {"r5", SceneId(scene), true, "note", scene};
}

template <>
PlanRequest Example() {
  PlanRequest request;
  request.run_id = "session";
  request.request_id = "r6";
  request.scene_id = "5c";
  request.robot_id = "0123";
  request.group = "arm";
  request.start = ExampleState();
  request.goal = ExampleGoal();
  request.direction = Direction::kBackward;
  request.time_limit_s = 12.5;
  request.seed = 0xfedcba9876543210;
  request.collision_model = CollisionModel::kMeshes;
  request.edge_resolution_m = 0.05;
  request.edge_check = EdgeCheck::kCertified;
  request.anytime = true;
  request.simplify = false;
  request.parameters = {{"range", "2"}, {"epsilon", "100"}};
  return request;
}

template <>
PlanAckMessage Example() {
  return {"ara", "r7", PlanAckVerdict::kRefused, "unknown joint"};
}

template <>
PlanProgressMessage Example() {
  return {"ara", "r8", {0.5, 3.0, 1e6, 1LL << 40}};
}

template <>
PlanResultMessage Example() {
  PlanResultMessage message;
  message.planner = "ara";
  message.run_id = "session";
  message.request_id = "r9";
  message.joint_names = {"shoulder", "wrist"};
  PlanResult& result = message.result;
  result.status = PlanStatus::kSolved;
  result.message = "note";
  result.planning_time_s = 0.25;
  result.total_time_s = 1.5;
  result.phases = {0.01, 0.1, 0.02, 0.12, 0.3};
  result.path = {{0, 1}, {0.5, 1.0 / 3}, {1, 2}};
  result.simplified_path = {{0, 1}, {1, 2}};
  result.epsilon = 2.5;
  result.cost = -1;
  result.progress = {{0.2, 5, 3000, 12}, {0.4, 2.5, 2000, 99}};
  result.counters = {{"edges_checked", 1234}, {"expansions", 99}};
  result.peak_memory_mb = 55.5;
  return message;
}

template <>
PlanCancelMessage Example() {
  return {"r10"};
}

template <>
AckMessage Example() {
  return {"r11", "logger", false, "disk full"};
}

template <>
CollisionRequestMessage Example() {
  CollisionRequestMessage message;
  message.request_id = "r12";
  message.scene_id = "5c";
  message.group = "arm";
  message.state = ExampleState();
  message.collision_model = CollisionModel::kMeshes;
  message.edge_resolution_m = 0.01;
  message.with_distance = true;
  message.states = {{0, 1}, {2, 3}, {4, 5}};
  message.edges = {{{0.1, 0.2}, {0.3, 0.4}}};
  return message;
}

template <>
CollisionReplyMessage Example() {
  CollisionVerdict hit{false, false, "wrist", "can", 0.01, 0.75, -0.01, "wrist", "can"};
  CollisionVerdict clear;
  clear.distance_m = std::numeric_limits<double>::infinity();
  return {"r13", true, "note", "fcl", {hit, clear}, {hit}};
}

template <>
PathCheckRequestMessage Example() {
  PathCheckRequestMessage message;
  message.request_id = "r14";
  message.scene_id = "5c";
  message.group = "arm";
  message.start = ExampleState();
  message.goal = ExampleGoal();
  message.joint_names = {"shoulder", "wrist"};
  message.path = {{0, 1}, {1, 2}};
  message.collision_model = CollisionModel::kMeshes;
  message.step_m = 0.005;
  message.with_clearance = true;
  return message;
}

template <>
PathCheckReplyMessage Example() {
  PathVerdict good;
  good.valid = true;
  return {"r15", true, "note", "fcl", 0.005, ExampleVerdict(), good};
}

template <>
SessionMessage Example() {
  SessionMessage message;
  message.run_id = "session";
  message.start_utime = 1700000000000000;
  message.finished = true;
  message.total_time_s = 123.5;
  message.num_runs = 300;
  message.version = "0.1.0";
  message.commit = "abcdef";
  message.host = "machine";
  message.cpu = "EPYC";
  message.time_limit_s = 60;
  message.seed = 7;
  message.robot_name = "arm";
  message.robot_id = "0123";
  message.settings = {{"--sets", "shelf"}};
  message.nodes = {Example<NodeStatusMessage>()};
  return message;
}

template <>
RunRecordMessage Example() {
  RunRecordMessage message;
  message.run_id = "session";
  message.request_id = "r16";
  message.planner = "ara";
  message.algorithm = "ARA*";
  message.planner_class = "search-and-sample";
  message.settings = {{"epsilon", "100"}};
  message.problem_set = "shelf";
  message.problem_index = 17;
  message.trial = 3;
  message.start_utime = 1700000000000000;
  message.status = PlanStatus::kInvalidPath;
  message.message = "wrist touches can";
  message.roundtrip_time_s = 1.75;
  message.request = Example<PlanRequest>();
  message.result = Example<PlanResultMessage>();
  message.path_check = Example<PathCheckReplyMessage>();
  message.simplified_check = Example<PathCheckReplyMessage>();
  message.simplified_check.request_id = "r17";
  return message;
}

}  // namespace planbench
