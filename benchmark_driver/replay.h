#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_driver/planner_client.h"
#include "benchmark_driver/planner_renewal.h"
#include "messaging/bus.h"
#include "messaging/messages.h"
#include "messaging/node_registry.h"
#include "messaging/record_log.h"

namespace planbench {

/// How the answer to a request differs from the recorded one, in words; "" if it does not. Status,
/// joints, both paths and the cost are compared, each exactly; messages, counters and times are
/// not. Of a path that the referee rejected it is what the planner said that counts.
std::string Difference(const RunRecordMessage& recorded, const PlannerClient::Answer& answer);

/// The planners that were asked something, in the order of their first requests.
std::vector<std::string> PlannersAsked(const std::vector<RunRecordMessage>& runs);

/// A line for each session of which the log holds fewer runs than it has, `log` being its name.
std::vector<std::string> MissingRuns(const std::string& log, const RecordedSession& recorded);

/// Asks live planners again what they were asked in recorded sessions, with the scenes of then, one
/// request after the other, and compares their answers.
class Replay {
 public:
  /// `run_id`: under which they are asked. `runs`: of those that `planners` were asked. Throws
  /// InputError if one of these was asked nothing, or a scene is lacking. `patience`: with a
  /// planner that is not live any more (PlannerClient::Terms); then its requests are not made.
  /// `problems_per_process` and `start_anew`: PlannerRenewal's.
  Replay(Bus* bus, NodeRegistry* registry, std::string run_id, std::vector<RunRecordMessage> runs,
         std::map<std::string, Scene> scenes, const std::vector<std::string>& planners,
         std::chrono::milliseconds patience = PlannerClient::Terms().patience,
         std::optional<int> problems_per_process = {},
         std::function<void(const std::string& planner)> start_anew = {});

  /// Asks and compares everything; `tell` gets a line for each answer that differs. Returns early
  /// if `interrupted` (asked every 50 ms; may throw). True if all was asked and all answers agree.
  /// The planners must be live.
  bool Run(const std::function<bool()>& interrupted,
           const std::function<void(const std::string&)>& tell);

  /// A row for each planner: its requests, how many were answered as before, and how long it took
  /// compared with then.
  std::string Table() const;

 private:
  struct Tally {
    int num_requests = 0;
    int num_equal = 0;
    int num_different = 0;
    std::vector<double> time_ratios;  // planning time, now / then, of equal answers with a path
  };
  void OnSceneRequest(const SceneRequestMessage& request);
  /// Warns of what a planner is otherwise set than it was then.
  void CompareSettings(const RunRecordMessage& run) const;

  Bus* bus_;
  NodeRegistry* registry_;
  std::string run_id_;
  std::vector<RunRecordMessage> runs_;
  std::map<std::string, Scene> scenes_;
  std::map<std::string, Tally> tallies_;  // by planner
  std::chrono::milliseconds patience_;
  PlannerRenewal renewal_;
  Subscription scene_requests_;  // last: it uses the rest
};

}  // namespace planbench
