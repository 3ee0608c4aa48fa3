#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messaging/asked_runs.h"
#include "messaging/bus.h"
#include "messaging/messages.h"
#include "planning/improvement_rule.h"
#include "report/shown_robot.h"
#include "report/shown_scene.h"
#include "report/table.h"

namespace planbench {

/// What goes on on a bus, as its messages tell: the nodes, the session, what is being planned and
/// what came of it. Messages of a bus, or of an event log. Not thread-safe.
class LiveSession {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// `robot_folder`: empty: the one that the session or its scene server names; `packages`: as of
  /// LoadSessionRobot. Throws InputError if there is no robot in the folder.
  explicit LiveSession(std::filesystem::path robot_folder,
                       std::map<std::string, std::filesystem::path> packages = {});

  /// Takes a message that came at `now`; one that cannot be decoded, or is of an improvement that
  /// is none (ImprovementRule), is counted.
  void Hear(const ReceivedMessage& message, TimePoint now);

  /// {session: {run_id, robot, num_runs, finished}, contestants: [{name, runs, solved}],
  ///  nodes: [{name, kind, busy, request, host, gone}],
  ///  progress: [{time_s, cost, bound}] of the last request, the latest 200,
  ///  runs: [{contestant, problem, status, reason, time_s}], the newest first,
  ///  lost, dropped, malformed, undecodable}. A node unheard of for 3 s before `now` is gone;
  /// one of before the session is then left out.
  Json State(TimePoint now, const Bus::Counters& counters) const;

  /// Grows with every message that changes View.
  std::int64_t view_number() const { return view_number_; }
  /// The last request in 3D (report/view_data.h), with its paths once there are any; nothing before
  /// the first, or {message} that says why it cannot be shown.
  std::optional<Json> View() const;

 private:
  struct Node {
    NodeStatusMessage status;
    TimePoint heard;
  };
  static bool IsGone(const Node& node, TimePoint now);

  void HearStatus(NodeStatusMessage status, TimePoint now);
  /// `planner`: what its channel calls the planner, in capitals.
  void HearRequest(const PlanRequest& request, const std::string& planner);
  void HearProgress(const PlanProgressMessage& progress);
  void HearResult(const PlanResultMessage& result);
  std::string ContestantOf(const std::string& planner) const;
  void HearRecord(const RunRecordMessage& record);
  const ShownRobot& LoadedRobot() const;

  std::filesystem::path robot_folder_;
  std::map<std::string, std::filesystem::path> packages_;
  mutable std::unique_ptr<const ShownRobot> robot_;
  std::optional<SessionMessage> session_;
  TimePoint session_heard_;                        ///< Its first message.
  std::optional<NodeStatusMessage> scene_server_;  ///< Heard last: a bus has one at a time.
  std::map<std::pair<NodeKind, std::string>, Node> nodes_;
  std::map<std::string, ShownScene> scenes_;  ///< By content id.
  /// The last request and what is known of it.
  std::optional<RunRecordMessage> shown_;
  bool is_answered_ = false;  ///< The last request, by its planner or by a record.
  std::vector<PlanProgress> progress_;
  ImprovementRule progress_rule_;  ///< Of the last request, until it is answered.
  std::map<std::string, std::pair<int, int>> tallies_;  ///< Runs and solved, by contestant.
  std::deque<RunRecordMessage> records_;                ///< The newest first.
  struct Seen {
    RunStanding standing;
    bool is_solved = false;
  };
  std::map<std::string, Seen> seen_;  ///< Of records, by request id.
  std::int64_t view_number_ = 0;
  std::int64_t num_undecodable_ = 0;
};

}  // namespace planbench
