#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_registry.h"

namespace planbench {

/// Sends requests to one planner and waits for their results, whatever happens to it meanwhile. One
/// request at a time.
class PlannerClient {
 public:
  /// Silence after which a live planner counts as not answering: no acknowledgement at all, or no
  /// result that long after the time limit.
  static constexpr std::chrono::seconds kAckTimeout{10};
  static constexpr std::chrono::seconds kResultGrace{15};
  /// How long an interrupted request is cancelled again and again without a result to it.
  static constexpr std::chrono::seconds kCancelPatience{1};

  enum class Outcome { kResult, kRefused, kNoAnswer, kInterrupted };
  struct Answer {
    Outcome outcome = Outcome::kNoAnswer;
    PlanResultMessage result;     ///< kResult only.
    std::string message;          ///< Why, for the other outcomes.
    double roundtrip_time_s = 0;  ///< Request sent -> result arrived, or given up.
  };

  PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner);

  const std::string& planner() const { return planner_; }

  /// Waits until the planner is live, sends the request until it is acknowledged (or while it is
  /// busy), and waits for the result, which it acknowledges. A planner that dies, restarts or falls
  /// silent meanwhile is a kNoAnswer; `interrupted` (asked every 50 ms) cancels the request, again
  /// until the planner answers or kCancelPatience is over.
  Answer Solve(const PlanRequest& request, const std::function<bool()>& interrupted);

 private:
  std::optional<NodeStatusMessage> WaitUntilLive(const std::function<bool()>& interrupted);

  Bus* bus_;
  NodeRegistry* registry_;
  std::string planner_;
  PlannerChannels channels_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string request_id_;  // of the request under way
  std::optional<PlanAckMessage> ack_;
  std::optional<PlanResultMessage> result_;
  std::string unusable_result_;  // why, if one came that could not be read
  std::chrono::steady_clock::time_point result_arrival_;
  Subscription acks_;
  Subscription results_;
};

}  // namespace planbench
