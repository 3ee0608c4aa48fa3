#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "messaging/answer_memory.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "planning/planner.h"

namespace planbench {

/// A planner as a process on the bus: takes requests one at a time, fetches scenes it lacks, and
/// solves on a thread of its own, so that heartbeats and cancellation work meanwhile. Who asks
/// repeats the request, or its cancellation, until the result comes; each repetition is answered at
/// once: with the result, which is remembered, or with what is being done (working, busy with
/// another, refused and why).
class PlannerNode {
 public:
  /// Scenes kept.
  static constexpr std::size_t kSceneCacheSize = 16;
  /// How long a scene is asked for before the request fails.
  static constexpr std::chrono::seconds kSceneTimeout{10};

  /// Goes live when the planner has prepared the collision models that it is to offer, those of
  /// `models` that it can. `name` must be free on the bus. `program`: announced as
  /// kProgramSetting, if it has a name.
  PlannerNode(Bus* bus, const std::string& name, std::unique_ptr<Planner> planner,
              const std::vector<CollisionModel>& models = EnumValues<CollisionModel>(),
              const std::string& program = "",
              std::chrono::milliseconds scene_timeout = kSceneTimeout);
  /// Leaves. What is being solved is stopped, and gets no result; one that is ready is sent.
  ~PlannerNode();

  /// Runs until `stop` (asked every 50 ms) says so; throws InputError if an older process has the
  /// name.
  void Run(const std::function<bool()>& stop);

 private:
  struct Job {
    PlanRequest request;
    PacketSender sender;                 // of the request
    std::shared_ptr<const Scene> scene;  // null until it has arrived
    std::string scene_fault;             // Why what came in its place cannot be used.
    std::int64_t num_incomplete = 0;     // Of the bus, when the request came.
    std::chrono::steady_clock::time_point accepted;
    std::chrono::steady_clock::time_point next_scene_request;
    PlanControl control;
  };
  void OnRequest(const PlanRequest& request, const PacketSender& sender);
  void OnBadRequest(const MessageError& error);
  void OnScene(SceneMessage message);
  void OnBadScene(const MessageError& error);
  void OnStatus(const NodeStatusMessage& status, const PacketSender& sender);
  void OnCancel(const PlanCancelMessage& message, const PacketSender& sender);
  NodeStatusMessage Status() const;
  std::string ReasonToRefuse(const PlanRequest& request) const;
  void Solve();
  void AskForScene();
  /// By which this node asks for the job's scene.
  std::string SceneRequestId() const;
  /// Of a scene that did not come, though nothing is wrong with it: who was heard, and what to do.
  std::string WhoWasHeard() const;
  /// Ends the job, which lacks its scene, and says why it does if that is known.
  void FinishWithoutScene(PlanStatus status, std::string message);
  /// Publishes the result of a request again; false if there is none.
  bool SendResultOf(const std::string& request_id);
  void Finish(PlanResult result);
  void Acknowledge(const std::string& request_id, PlanAckVerdict verdict,
                   const std::string& message);

  Bus* bus_;
  std::string name_;
  std::chrono::milliseconds scene_timeout_;
  PlannerChannels channels_;
  std::unique_ptr<Planner> planner_;
  PlannerDescription description_;  // with the collision models that can be used
  std::map<CollisionModel, std::string> unusable_models_;
  NodeStatusMessage status_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::unique_ptr<Job> job_;
  AnswerMemory results_;
  std::list<std::pair<std::string, std::shared_ptr<const Scene>>> scenes_;
  std::string scene_server_;  // host and address of the one heard last
  std::chrono::steady_clock::time_point scene_server_heard_;

  std::unique_ptr<NodeAnnouncer> announcer_;
  Subscription requests_;
  Subscription scene_messages_;
  Subscription statuses_;
  Subscription cancels_;
  std::thread solver_;
};

}  // namespace planbench
