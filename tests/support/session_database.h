#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/collision_model.h"
#include "logger/results_database.h"
#include "messaging/messages.h"

namespace planbench {

/// A run of a made-up session; a solved one has paths of the lengths given.
struct MadeRun {
  std::string contestant;
  std::string set = "shelf";
  int problem = 1;
  int trial = 1;
  PlanStatus status = PlanStatus::kSolved;
  double time_s = 1;
  Direction direction = Direction::kForward;
  std::string reason = {};
  double length = 2;
  double length_simplified = 1;
  bool simplified_valid = true;         ///< If the raw path is.
  std::optional<bool> mesh_valid = {};  ///< Verdict of the mesh robot, if it has one.
  std::string mesh_reason = {};
  double mesh_depth_m = 0;  ///< 0: the verdict names no contact.
  std::optional<bool> mesh_valid_simplified = {};
  std::map<std::string, double> counters = {};
  std::vector<PlanProgress> progress = {};
  std::map<std::string, std::string> settings = {};
  CollisionModel model = CollisionModel::kSpheres;
  bool asked = true;         ///< Else there is no round trip, nor an answer.
  bool unjudgeable = false;  ///< Then, for `reason`.
};

inline RunRecordMessage MakeRecord(const MadeRun& run, const std::string& run_id, int number) {
  RunRecordMessage record;
  record.run_id = record.request.run_id = record.result.run_id = run_id;
  record.request_id = record.request.request_id = record.result.request_id =
      fmt::format("{}-{}", run_id, number);
  record.planner = record.result.planner = record.algorithm = "planner";
  record.contestant = run.contestant;
  record.settings = run.settings;
  record.problem_set = run.set;
  record.problem_index = run.problem;
  record.trial = run.trial;
  record.status = run.status;
  record.message = run.reason;
  record.roundtrip_time_s = run.time_s + 0.5;
  record.request.direction = run.direction;
  record.request.collision_model = run.model;
  record.request.time_limit_s = 10;
  if (!run.asked) {
    record.roundtrip_time_s = 0;
    record.result = {};
    if (run.unjudgeable) record.path_check.message = run.reason;
    return record;
  }
  PlanResult& result = record.result.result;
  const bool claimed = run.status == PlanStatus::kSolved || run.status == PlanStatus::kInvalidPath;
  result.status = claimed ? PlanStatus::kSolved : run.status;
  result.planning_time_s = result.total_time_s = run.time_s;
  result.phases = {run.time_s / 8, run.time_s / 2, run.time_s / 4, run.time_s / 8, 0.25};
  result.progress = run.progress;
  result.counters = run.counters;
  if (!claimed) return record;
  record.result.joint_names = {"j"};
  result.path = {{0}, {1}};
  for (PathCheckReplyMessage* check : {&record.path_check, &record.simplified_check}) {
    check->ok = true;
    check->verdict.emplace();
    check->verdict->valid = run.status == PlanStatus::kSolved;
  }
  if (!run.simplified_valid) record.simplified_check.verdict->valid = false;
  record.path_check.verdict->measures["path_length"] = run.length;
  record.simplified_check.verdict->measures["path_length"] = run.length_simplified;
  if (run.mesh_valid) {
    PathVerdict& verdict = record.path_check.mesh_verdict.emplace();
    verdict.valid = *run.mesh_valid;
    verdict.reason = run.mesh_reason;
    if (run.mesh_depth_m > 0) verdict.contact = Contact{"arm", "shelf", run.mesh_depth_m};
  }
  if (run.mesh_valid_simplified) {
    record.simplified_check.mesh_verdict.emplace().valid = *run.mesh_valid_simplified;
  }
  return record;
}

/// Writes FOLDER/results.sqlite as the logger does; the session's message is that given, finished,
/// with `num_runs` as many as there are.
inline void WriteSession(const std::filesystem::path& folder, const std::vector<MadeRun>& runs,
                         SessionMessage session = {}) {
  std::filesystem::create_directories(folder);
  ResultsDatabase database(folder / "results.sqlite");
  if (session.run_id.empty()) session.run_id = folder.filename().string();
  session.start_utime += 1'714'979'289'123'456;  // 2024-05-06T07:08:09.123456Z
  session.finished = true;
  session.num_runs = static_cast<int>(runs.size());
  database.Store(session);
  int number = 0;
  for (const MadeRun& run : runs) database.Store(MakeRecord(run, session.run_id, ++number));
}

}  // namespace planbench
