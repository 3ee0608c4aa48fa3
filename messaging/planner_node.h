#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "planning/planner.h"

namespace planbench {

/// A planner as a process on the bus: takes requests one at a time, acknowledges them at once
/// (accepted, busy, refused and why), fetches scenes it lacks, solves on a thread of its own so
/// that heartbeats and cancellation work meanwhile, and repeats the result until it is
/// acknowledged. A repeated request is answered from the cache, unless it was cancelled: then it is
/// solved.
class PlannerNode {
 public:
  /// Results and scenes kept.
  static constexpr std::size_t kResultCacheSize = 64;
  static constexpr std::size_t kSceneCacheSize = 16;
  /// How long a scene is asked for before the request fails.
  static constexpr std::chrono::seconds kSceneTimeout{10};
  /// How long an unacknowledged result is repeated.
  static constexpr std::chrono::seconds kResultTimeout{60};

  /// Goes live. `name` must be free on the bus.
  PlannerNode(Bus* bus, const std::string& name, std::unique_ptr<Planner> planner);
  /// Cancels what is being solved and leaves.
  ~PlannerNode();

  /// Runs until `stop` (asked every 50 ms) says so; throws InputError if an older process has the
  /// name.
  void Run(const std::function<bool()>& stop);

 private:
  struct Job {
    PlanRequest request;
    std::shared_ptr<const Scene> scene;  // null until it has arrived
    std::chrono::steady_clock::time_point accepted;
    std::chrono::steady_clock::time_point next_scene_request;
    PlanControl control;
  };
  struct Outcome {
    PlanResultMessage message;
    bool acknowledged = false;
    std::chrono::steady_clock::time_point ready;
    std::chrono::steady_clock::time_point next_send;
    std::chrono::milliseconds period;
  };

  void OnRequest(const PlanRequest& request);
  void OnBadRequest(const MessageError& error);
  void OnScene(const SceneMessage& message);
  void OnCancel(const PlanCancelMessage& message);
  void OnResultAck(const AckMessage& message);
  NodeStatusMessage Status() const;
  std::string ReasonToRefuse(const PlanRequest& request) const;
  void Solve();
  void Tick();
  void Finish(PlanResult result);
  void Acknowledge(const std::string& request_id, PlanAckVerdict verdict,
                   const std::string& message);

  Bus* bus_;
  std::string name_;
  PlannerChannels channels_;
  std::unique_ptr<Planner> planner_;
  PlannerDescription description_;
  NodeStatusMessage status_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::unique_ptr<Job> job_;
  std::list<Outcome> outcomes_;
  std::list<std::pair<std::string, std::shared_ptr<const Scene>>> scenes_;

  std::unique_ptr<NodeAnnouncer> announcer_;
  Subscription requests_;
  Subscription scene_messages_;
  Subscription cancels_;
  Subscription result_acks_;
  std::thread solver_;
};

}  // namespace planbench
