#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "messaging/node_registry.h"
#include "messaging/rpc.h"
#include "tests/support/message_collector.h"

namespace planbench {

inline constexpr char kFakeRobotId[] = "robot-1";

/// A path of the fake planner's two joints.
Path FakePath();

/// A planner as the bus sees it: what it answers is up to the test.
class FakePlanner {
 public:
  explicit FakePlanner(Bus* bus, const std::string& name = "arm");

  /// What to do with a request, in its handler. At first: Solve. A request that is repeated may
  /// come until the planner ends: what the handler uses must live as long.
  void OnRequest(std::function<void(const PlanRequest&)> handler);
  void Acknowledge(const PlanRequest& request, PlanAckVerdict verdict,
                   const std::string& message = "");
  void SendResult(const std::string& request_id, PlanResult result);
  /// Sends SolvedResult.
  void Solve(const PlanRequest& request);
  static PlanResult SolvedResult();

  /// Says nothing any more.
  void FallSilent() { announcer_.reset(); }
  /// As if the process had been started anew.
  void Restart();

  MessageCollector<PlanRequest>& requests() { return requests_; }
  MessageCollector<PlanCancelMessage>& cancels() { return cancels_; }

  /// What it announces. To be changed before Restart().
  NodeStatusMessage status;

 private:
  Bus* bus_;
  PlannerChannels channels_;
  std::mutex mutex_;
  std::function<void(const PlanRequest&)> handler_;
  MessageCollector<PlanRequest> requests_;
  MessageCollector<PlanCancelMessage> cancels_;
  std::unique_ptr<NodeAnnouncer> announcer_;
  Subscription subscription_;  ///< Ends first: what a handler does to the announcer is done then.
};

/// Has the planner announce itself as it now is, and waits until that is what is heard.
void Reannounce(NodeRegistry* registry, FakePlanner* planner);

/// A scene server of one set, "cans", problems 1 to 3; finds every path valid.
class FakeSceneServer {
 public:
  /// `settings`: what else its announcements say.
  explicit FakeSceneServer(Bus* bus, const std::map<std::string, std::string>& settings = {});

  /// Refuses a problem from now on.
  void RefuseProblem(int index, const std::string& reason);
  /// Serves one that it refused from now on.
  void ServeProblem(int index);
  /// What it makes of the problems that it serves.
  void AlterProblems(std::function<void(ProblemMessage*)> alter);
  /// What it does before it answers a request for a problem.
  void BeforeAnswers(std::function<void(const ProblemRequestMessage&)> handler);
  /// What the referee says instead.
  void OnPathCheck(std::function<PathCheckReplyMessage(const PathCheckRequestMessage&)> handler);
  static PathCheckReplyMessage Verdict(bool valid, const std::string& reason = "");

  MessageCollector<ProblemRequestMessage>& problem_requests() { return problem_requests_; }
  MessageCollector<PathCheckRequestMessage>& path_checks() { return path_checks_; }

 private:
  std::mutex mutex_;
  std::map<int, std::string> refused_;
  std::function<void(ProblemMessage*)> alter_ = [](ProblemMessage*) {};
  std::function<void(const ProblemRequestMessage&)> before_answers_;
  std::function<PathCheckReplyMessage(const PathCheckRequestMessage&)> judge_;
  MessageCollector<ProblemRequestMessage> problem_requests_;
  MessageCollector<PathCheckRequestMessage> path_checks_;
  RpcServer<ProblemRequestMessage, ProblemMessage> problems_;
  RpcServer<PathCheckRequestMessage, PathCheckReplyMessage> judgements_;
  NodeAnnouncer announcer_;
};

/// A logger that stores everything it is sent, or does what the test says.
class FakeLogger {
 public:
  /// `describe`: what else its announcements say.
  explicit FakeLogger(Bus* bus, const std::string& name = "logger",
                      const std::function<void(NodeStatusMessage*)>& describe = nullptr);

  /// Copies of a message that it does not answer, as if they or the answers had been lost.
  std::atomic<int> num_to_ignore = 0;
  std::atomic<bool> refuse = false;
  /// Says that it cannot record, and acknowledges nothing.
  std::atomic<bool> troubled = false;

  void Announce() { announcer_->Announce(); }

  MessageCollector<RunRecordMessage>& records() { return records_; }
  MessageCollector<SessionMessage>& sessions() { return sessions_; }

 private:
  void Answer(const std::string& channel, const std::string& id);

  Bus* bus_;
  std::string name_;
  MessageCollector<RunRecordMessage> records_;
  MessageCollector<SessionMessage> sessions_;
  Subscription record_subscription_;
  Subscription session_subscription_;
  std::unique_ptr<NodeAnnouncer> announcer_;
};

}  // namespace planbench
