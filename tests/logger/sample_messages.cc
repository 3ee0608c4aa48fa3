#include "sample_messages.h"

namespace planbench {

SessionMessage SampleSession() {
  SessionMessage session;
  session.run_id = "session-1";
  session.start_utime = 1'714'979'289'123'456;  // 2024-05-06T07:08:09.123456Z
  session.num_runs = 12;
  session.version = "0.1.0";
  session.commit = "abc123";
  session.host = "bench-host";
  session.cpu = "Fast CPU";
  session.conditions.request.time_limit_s = 60;
  session.conditions.request.seed = 18'446'744'073'709'551'615u;
  session.robot_name = "fetch";
  session.conditions.request.robot_id = "f00d";
  session.settings = {{"planners", "ara,rrtc"}, {"sets", "shelf"}};
  NodeStatusMessage node;
  node.name = "rrtc";
  node.kind = NodeKind::kPlanner;
  node.host = "bench-host";
  node.pid = 4711;
  node.version = "0.1.0";
  node.commit = "abc123";
  node.robot_name = "fetch";
  node.robot_id = "f00d";
  node.algorithm = "RRT-Connect";
  node.planner_class = "sampling-guided";
  node.can_backward = true;
  node.bidirectional = true;
  node.collision_models = {"spheres"};
  node.settings = {{"range", "2"}};
  session.nodes = {node};
  return session;
}

SessionMessage FinishedSession() {
  SessionMessage session = SampleSession();
  session.finished = true;
  session.total_time_s = 321.5;
  return session;
}

RunRecordMessage SampleRecord(const std::string& request_id) {
  RunRecordMessage record;
  record.run_id = "session-1";
  record.request_id = request_id;
  record.planner = "ara";
  record.contestant = "ARA*";
  record.algorithm = "ARA*";
  record.planner_class = "search-and-sample";
  record.settings = {{"epsilon", "100"}, {"improve", "true"}};
  record.problem_set = "shelf";
  record.problem_index = 7;
  record.trial = 2;
  record.start_utime = 1'714'979'290'000'001;
  record.status = PlanStatus::kSolved;
  record.roundtrip_time_s = 0.875;

  PlanRequest& request = record.request;
  request.run_id = record.run_id;
  request.request_id = request_id;
  request.scene_id = "scene-hash";
  request.group = "arm";
  request.start = {{"lift", "pan"}, {0.1, 0.2}};
  request.goal = {{"lift", 0.3, 0, 0}, {"pan", 0.4, 0, 0}};
  request.direction = Direction::kBackward;
  request.time_limit_s = 30;
  request.seed = 9'223'372'036'854'775'809u;
  request.collision_model = CollisionModel::kVoxels;
  request.edge_resolution_m = 0.05;
  request.edge_check = EdgeCheck::kCertified;
  request.anytime = true;
  request.parameters = {{"epsilon", "5"}};

  PlanResultMessage& answer = record.result;
  answer.planner = record.planner;
  answer.run_id = record.run_id;
  answer.request_id = request_id;
  answer.joint_names = {"lift", "pan"};
  PlanResult& result = answer.result;
  result.status = PlanStatus::kSolved;
  result.planning_time_s = 0.25;
  result.total_time_s = 0.75;
  result.phases = {0.01, 0.02, 0.03, 0.04, 0.05};
  result.path = {{0.1, 0.2}, {0.15, 0.9}, {0.3, 0.4}};
  result.simplified_path = {{0.1, 0.2}, {0.3, 0.4}};
  result.epsilon = 1.5;
  result.cost = 2500;
  result.progress = {{0.25, 5, 4000, 100}, {0.5, 1.5, 2500, 900}};
  result.counters = {{"edges_checked", 11}, {"configurations_checked", 22},
                     {"iterations", 33},    {"expansions", 44},
                     {"states", 55},        {"goal_tries", 66.5}};
  result.peak_memory_mb = 123.5;

  PathCheckReplyMessage& check = record.path_check;
  check.request_id = request_id;
  check.ok = true;
  check.engine = "fcl";
  check.step_m = 0.001;
  PathVerdict verdict;
  verdict.valid = true;
  // 1, 2, 3, ... on the raw path, half as much on the simplified one.
  for (const PathMeasure& measure : PathMeasures()) {
    verdict.measures[measure.name] = static_cast<double>(verdict.measures.size() + 1);
  }
  verdict.num_samples = 300;
  check.verdict = verdict;
  verdict.valid = false;
  verdict.reason = "elbow hits board at segment 1";
  verdict.segment = 1;
  verdict.contact = Contact{"elbow", "board", 0.0125};
  check.mesh_verdict = verdict;

  PathCheckReplyMessage& simplified = record.simplified_check;
  simplified = check;
  for (auto& [name, value] : simplified.verdict->measures) value /= 2;
  simplified.mesh_verdict->valid = true;
  simplified.mesh_verdict->reason = "";
  simplified.mesh_verdict->segment = -1;
  simplified.mesh_verdict->contact.reset();
  return record;
}

RunRecordMessage UnansweredRecord(const std::string& request_id) {
  RunRecordMessage record = SampleRecord(request_id);
  record.planner = "rrtc";
  record.contestant = "RRT-Connect";
  record.status = PlanStatus::kNoAnswer;
  record.message = "rrtc fell silent";
  record.roundtrip_time_s = 0;
  record.result = {};
  record.path_check = {};
  record.simplified_check = {};
  return record;
}

}  // namespace planbench
