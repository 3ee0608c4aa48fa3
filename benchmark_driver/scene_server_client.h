#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "messaging/bus.h"
#include "messaging/messages.h"
#include "messaging/node_registry.h"
#include "messaging/rpc.h"

namespace planbench {

/// How long a scene server that does not answer is waited for.
struct ServerPatience {
  /// Until it is said what is waited for, again and again.
  std::chrono::milliseconds until_told = std::chrono::seconds(10);
  /// Without a live one, until it is given up.
  std::chrono::milliseconds until_given_up = std::chrono::seconds(60);
  /// For one answer in all, until its problem is passed over: large scenes take long.
  std::chrono::milliseconds until_passed_over = std::chrono::minutes(10);
};

/// A scene server whose process is this one's to start.
struct SupervisedServer {
  /// How often it has failed at its work so far (died, fell silent).
  std::function<int()> failures;
  /// Whatever it is at.
  std::function<void()> start_again;
};

/// In what a problem is another than an earlier answer, or a request made of one, says: "scene",
/// "group", "start" or "goal"; empty: in nothing.
template <typename Before>
std::string_view ChangedPart(const Before& before, const ProblemMessage& now) {
  if (before.scene_id != now.scene_id) return "scene";
  if (before.group != now.group) return "group";
  if (before.start != now.start) return "start";
  return before.goal != now.goal ? "goal" : "";
}

/// Asks the scene server, and whoever came in its place, for problems and for verdicts on paths:
/// for one thing at a time, and for nothing of a problem that was passed over, as one is at which
/// it fails twice: of one that is not supervised, each that comes in the place of another tells of
/// a failure. Answers of others than the scene server that `registry` knows are none. What asks
/// throws std::runtime_error when it is given up, or three problems in succession were passed over,
/// or one whose answer does not come holds up the others, since nobody can start it again.
/// Thread-safe.
class SceneServerClient {
 public:
  using ProblemKey = std::pair<std::string, int>;  // set and index

  /// `conditions`: complete, the referee's step included; they must outlive the client.
  SceneServerClient(Bus* bus, NodeRegistry* registry, const SessionConditions* conditions,
                    std::optional<SupervisedServer> server, ServerPatience patience);

  /// Its answer on whether it has such a problem, with ok or without; nothing if `interrupted`. It
  /// also hands out the scene. That of a server which was started again on other files is without
  /// ok if the problem is not what it was, and so is, with the reason, that on a problem that is
  /// passed over.
  std::optional<ProblemMessage> AskForProblem(const std::string& set, int index,
                                              const std::function<bool()>& interrupted);
  /// The same, asked for once, and anew where it is denied, since it was there before.
  std::optional<ProblemMessage> FetchProblem(const std::string& set, int index,
                                             const std::function<bool()>& interrupted);
  /// The verdict on a path of a run of which `record` has the request and the names of the joints;
  /// without ok if there is none, the problem having been passed over included; nothing if
  /// `interrupted`. `check_id`: of the request.
  std::optional<PathCheckReplyMessage> Judge(const std::string& check_id, const Path& path,
                                             const RunRecordMessage& record,
                                             const std::function<bool()>& interrupted);
  /// "" if it is not.
  std::string WhyPassedOver(const ProblemKey& problem);

 private:
  /// Of whoever asks the scene server about a problem, one after the other: what it fails at
  /// meanwhile is that.
  struct Turn {
    std::unique_lock<std::timed_mutex> lock;
    ProblemKey problem;
    int failures_before = 0;
    std::string server;  ///< Its instance, as last seen.
    int num_new_servers = 0;
  };
  /// Nothing if `interrupted`.
  std::optional<Turn> TakeTurn(const ProblemKey& problem, const std::function<bool()>& interrupted);
  int FailuresIn(Turn* turn) const;
  std::optional<ProblemMessage> AskForProblem(Turn* turn, const std::function<bool()>& interrupted);
  /// One thing that the scene server does.
  template <typename Request, typename Reply>
  struct Service {
    RpcClient<Request, Reply> client;
    std::set<std::string> failed_at;  // problems passed over since it answered; whose turn it is
  };
  /// The reply is without ok if the problem is passed over. `what`: is asked for, in words;
  /// `advice`: what is told of it behind the word that the server is silent.
  template <typename Request, typename Reply>
  std::optional<Reply> AskServer(Service<Request, Reply>* service, const Request& request,
                                 Turn* turn, const std::string& what, const std::string& advice,
                                 const std::function<bool()>& interrupted);
  void PassOver(const Turn& turn, const std::string& why, std::set<std::string>* failed_at);

  NodeRegistry* registry_;
  const SessionConditions* conditions_;
  std::optional<SupervisedServer> server_;
  ServerPatience patience_;
  Service<ProblemRequestMessage, ProblemMessage> problems_;
  Service<PathCheckRequestMessage, PathCheckReplyMessage> path_checks_;
  std::timed_mutex turn_;
  bool has_answered_ = false;  // anything at all; whose turn it is
  std::mutex mutex_;
  std::map<ProblemKey, ProblemMessage> problems_known_;
  std::map<ProblemKey, ProblemMessage> problems_first_;  // as they were when first asked for
  std::map<ProblemKey, std::string> passed_over_;        // and why
};

}  // namespace planbench
