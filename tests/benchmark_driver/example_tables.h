#pragma once

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "benchmark_driver/tables.h"

// Records of runs, and what stands in the tables that are made of them.

namespace planbench {

inline RunRecordMessage AttemptOf(PlanStatus status, double planning_time_s,
                                  Direction direction = Direction::kForward) {
  RunRecordMessage record;
  record.planner = "ara";
  record.contestant = "ARA*";
  record.problem_set = "box";
  record.problem_index = 1;
  record.status = status;
  record.request.direction = direction;
  record.request.time_limit_s = 60;
  record.request.edge_check = EdgeCheck::kFixed;
  record.request.edge_resolution_m = 0.02;
  record.roundtrip_time_s = planning_time_s + 0.001;
  PlanResult& result = record.result.result;
  result.planning_time_s = result.total_time_s = planning_time_s;
  result.status = status;
  if (status == PlanStatus::kSolved || status == PlanStatus::kInvalidPath) {
    result.status = PlanStatus::kSolved;
    result.path = {{0}, {1}};
  }
  return record;
}

inline RunRecordMessage Backward(PlanStatus status, double planning_time_s) {
  return AttemptOf(status, planning_time_s, Direction::kBackward);
}

inline RunRecordMessage OfProblem(int index, RunRecordMessage record) {
  record.problem_index = index;
  return record;
}

inline RunRecordMessage OfRrtConnect(RunRecordMessage record) {
  record.planner = "rrtc";
  record.contestant = "RRT-Connect";
  return record;
}

inline SessionConditions Conditions() {
  SessionConditions conditions;
  for (const char* name : {"RRT-Connect", "ARA*"}) {
    Contestant& contestant = conditions.contestants.emplace_back();
    contestant.planner = contestant.name = name;
    contestant.about = fmt::format("what {} is", name);
    contestant.collision_model = CollisionModel::kSpheres;
    contestant.edge_check = EdgeCheck::kFixed;
    contestant.edge_resolution_m = 0.02;
  }
  return conditions;
}

inline RunRows Rows(const std::vector<RunRecordMessage>& records) {
  RunRows rows;
  for (const RunRecordMessage& record : records) rows.Add(record);
  return rows;
}

inline std::string Brief(const std::vector<RunRecordMessage>& records) {
  return MakeTables(Conditions(), Rows(records)).brief;
}
inline std::string Full(const std::vector<RunRecordMessage>& records) {
  return MakeTables(Conditions(), Rows(records)).full;
}

/// The lines of the table of that title, words joined by single blanks: header, rule, rows, notes.
inline std::vector<std::string> Table(const std::string& text, const std::string& title) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line == title) {
      inside = true;
    } else if (inside && line.empty()) {
      break;
    } else if (inside) {
      std::istringstream words(line);
      std::string joined;
      for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
      lines.push_back(joined);
    }
  }
  return lines;
}

/// The rest of a row of a table by its beginning; "" if there is none.
inline std::string Row(const std::string& text, const std::string& title,
                       const std::string& beginning) {
  for (const std::string& line : Table(text, title)) {
    if (line.starts_with(beginning + " ")) return line.substr(beginning.size() + 1);
  }
  return "";
}

inline constexpr char kSuccess[] = "Success";
inline constexpr char kTimes[] = "Planning time, ms";
inline constexpr char kPairs[] = "Problem by problem";
inline constexpr char kDirections[] = "Planning time of confirmed attempts by direction, ms";
inline constexpr char kEffort[] = "Effort of confirmed runs, medians over problems";
inline constexpr char kQuality[] = "Path quality of confirmed runs, medians over problems";
inline constexpr char kMeshes[] = "Paths judged with the robot's meshes";
inline constexpr char kFailed[] = "Attempts without a confirmed path";

/// Four problems of which ARA* solves the first forward, the second backward, the third not; the
/// fourth's goal is in collision. RRT-Connect solves the first; its path for the second is
/// rejected.
inline std::vector<RunRecordMessage> FourProblems() {
  std::vector<RunRecordMessage> session = {
      OfProblem(1, AttemptOf(PlanStatus::kSolved, 0.1)),
      OfProblem(1, Backward(PlanStatus::kSolved, 0.02)),
      OfProblem(2, AttemptOf(PlanStatus::kTimedOut, 60)),
      OfProblem(2, Backward(PlanStatus::kSolved, 0.04)),
      OfProblem(3, AttemptOf(PlanStatus::kTimedOut, 60)),
      OfProblem(3, Backward(PlanStatus::kExhausted, 2)),
      OfProblem(4, AttemptOf(PlanStatus::kGoalInvalid, 0)),
      OfProblem(4, Backward(PlanStatus::kGoalInvalid, 0)),
      OfProblem(1, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 0.0051234))),
      OfProblem(2, OfRrtConnect(AttemptOf(PlanStatus::kInvalidPath, 0.2))),
  };
  session.back().message = "elbow hits board";
  return session;
}

}  // namespace planbench
