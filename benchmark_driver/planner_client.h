#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "benchmark_driver/request_exchange.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_registry.h"

namespace planbench {

/// Sends requests to one planner and waits for their results, whatever happens to it meanwhile:
/// RequestExchange on a bus. One request at a time.
class PlannerClient {
 public:
  using Outcome = RequestExchange::Outcome;
  using Answer = RequestExchange::Answer;

  /// What a session holds its planner to.
  struct Terms {
    /// A process that is described otherwise (FindConditionDifference) is not asked.
    std::optional<NodeStatusMessage> expected = {};
    /// Why the planner will not come any more; "" while it may.
    std::function<std::string()> given_up = [] { return std::string(); };
    /// How long one that is not live is waited for, beyond the time limit of a request that it may
    /// be at still; then it is given up, and `on_absence` told why, once.
    std::chrono::milliseconds patience = std::chrono::seconds(60);
    std::function<void(const std::string& why)> on_absence = [](const std::string&) {};
    /// Supervisor::HowEnded of the planner.
    std::function<std::string(std::chrono::steady_clock::time_point since)> how_ended =
        [](std::chrono::steady_clock::time_point) { return std::string(); };
  };

  PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner);
  PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner, Terms terms);

  const std::string& planner() const { return planner_; }

  /// Waits until the planner is live, or given up, or the caller interrupts. Of one that is not
  /// live it says once for how long.
  void AwaitPlanner(const std::function<bool()>& interrupted) { WaitUntilLive(interrupted); }
  /// The process that is live, if it is to be asked.
  std::optional<NodeStatusMessage> ToBeAsked() const;
  /// Whether the process that is live is to be asked and has given this client no result yet, and
  /// is not known to give none, however long it is waited for.
  bool IsCold() const;
  /// The process that is live is to be told to end, so that another comes in its place: it is not
  /// asked any more, and of the wait for the other nothing is said while that is short. False if
  /// nobody is to be told: it is given up, or none is live, nor, as far as is seen from here, only
  /// silent, so that whoever comes is another.
  bool ExpectAnother();
  /// Waits until the planner is live and asks it until the request has come to its end. Only what
  /// comes from the process asked, and answers what was asked, is an answer. A planner that dies or
  /// restarts meanwhile, is given up, or is another than the terms say, gives none; `interrupted`
  /// (asked every 50 ms) cancels the request.
  Answer Solve(const PlanRequest& request, const std::function<bool()>& interrupted);

 private:
  using TimePoint = RequestExchange::TimePoint;

  std::optional<NodeRegistry::Node> WaitUntilLive(const std::function<bool()>& interrupted);
  std::optional<NodeRegistry::Node> Live() const;
  std::string WhyGivenUp() const { return given_up_.empty() ? terms_.given_up() : given_up_; }
  /// Of a process that has been seen on this machine, at once: whether it has ended.
  bool HasEnded(const NodeStatusMessage& process) const;
  /// Whether it has, or is about to.
  bool IsOver(const NodeStatusMessage& process) const;
  /// Why that process is not to be asked; "" if it is.
  std::string ReasonNotToAsk(const NodeStatusMessage& process) const;
  void OnAck(const PlanAckMessage& ack, const Origin& origin);
  /// Why that is no answer to what was asked; "" if it is. Holds mutex_.
  std::string WhyUnusable(const PlanResultMessage& result) const;
  void OnResult(const PlanResultMessage& result, const Origin& origin);
  void OnBadResult(const MessageError& error, const Origin& origin);
  /// For the request under way; of what is from another than the process asked, only that.
  /// `result`: which the event is of; null if of none.
  void Add(RequestExchange::Event event, const PacketSender& sender, const std::string& channel,
           const PlanResultMessage* result = nullptr);
  /// The next message; nothing if none has come by then.
  std::optional<RequestExchange::Event> NextMessage(TimePoint until);

  Bus* bus_;
  NodeRegistry* registry_;
  std::string planner_;
  PlannerChannels channels_;
  Terms terms_;
  NodeStatusMessage seen_here_;  // the process asked last, if it was seen on this machine
  std::string warm_;  // instance of the process that gave a result, or none, last: it is not cold
  std::optional<std::string> told_to_end_;  // instance of the process, until another has come
  std::string given_up_;                    // why, if for its absence
  /// Of the last request, if it had no answer and the process may be at it still.
  std::chrono::milliseconds unanswered_limit_{0};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<PacketSender> asked_;  // while a request is under way
  std::string run_id_, request_id_;    // its
  bool has_refused_ = false;           // somebody else's message to it
  /// To the last request that had one, as it came: what differs from it contradicts it.
  std::optional<PlanResultMessage> first_result_;
  std::deque<RequestExchange::Event> messages_;  // since the request under way began
  Subscription acks_;
  Subscription results_;
};

}  // namespace planbench
