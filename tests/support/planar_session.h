#pragma once

#include <string>
#include <utility>

#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/messages.h"
#include "messaging/packet_reader.h"

namespace planbench {

/// The file of a request for the planar arm.
inline constexpr char kPlanarRequest[] =
    "{group_name: arm, allowed_planning_time: 1, start_state: {joint_state: {name: [shoulder, "
    "elbow, wrist], position: [0, 0, 0]}}, goal_constraints: [{joint_constraints: [{joint_name: "
    "shoulder, position: 1}, {joint_name: elbow, position: 0}, {joint_name: wrist, position: "
    "0}]}]}\n";

/// Messages of a session with the planar arm, whose scene is empty.
struct PlanarSession {
  PlanarSession() {
    session.run_id = "session";
    session.robot_name = "planar3";
    session.num_runs = 4;
    Contestant contestant;
    contestant.planner = "ara";
    contestant.name = "ARA*";
    session.conditions.contestants = {contestant};
    session.settings["robot"] = std::string(PLANBENCH_SOURCE_DIR) + "/tests/data/planar3";
    scene.scene_id = SceneId(scene.scene);
    request.request_id = "session/shelf/1/ara/forward/2@7";
    request.run_id = session.run_id;
    request.scene_id = scene.scene_id;
    request.start = {{"shoulder", "elbow", "wrist"}, {0, 0, 0}};
    request.goal = {{"shoulder", 0, 0, 0}, {"elbow", 1, 0, 0}, {"wrist", 0, 0, 0}};
    result.planner = "ara";
    result.request_id = request.request_id;
    result.joint_names = {"shoulder", "elbow", "wrist"};
    result.result.status = PlanStatus::kSolved;
    result.result.planning_time_s = 0.25;
    result.result.path = {{0, 0, 0}, {0, 1, 0}};
    record.run_id = result.run_id = "session";
    record.planner = "ara";
    record.request_id = "session/shelf/1/ara/forward/2";
    record.contestant = "ARA*";
    record.problem_set = "shelf";
    record.problem_index = 1;
    record.trial = 2;
    record.status = PlanStatus::kSolved;
    record.request = request;
    record.result = result;
  }

  template <typename Message>
  static ReceivedMessage Received(const std::string& channel, const Message& message) {
    return {channel, Encode(message), 1'000'000};
  }

  SessionMessage session;
  SceneMessage scene;
  PlanRequest request;
  PlanResultMessage result;
  RunRecordMessage record;
};

}  // namespace planbench
