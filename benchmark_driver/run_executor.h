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

#include "benchmark_driver/machine.h"
#include "benchmark_driver/planner_client.h"
#include "benchmark_driver/schedule.h"
#include "messaging/rpc.h"

namespace planbench {

/// Counter of a run whose planner improves another's path: how long that took to be handed over, s.
inline constexpr char kFirstPathTime[] = "first_path_time";

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

/// Makes one run: fetches the problem if it is not known yet, has the planner solve it, has the
/// scene server judge the paths. Thread-safe for different planners.
class RunExecutor {
 public:
  /// `conditions`: complete, the referee's step and the contestants' included; `first_planners`
  /// likewise, who are no contestants and find paths that these improve. Answers of others than the
  /// scene server that `registry` knows are none. It is asked for one thing at a time, and for
  /// nothing of a problem that was passed over, as one is at which it fails twice: of one that is
  /// not supervised, each that comes in the place of another tells of a failure. What asks it
  /// throws std::runtime_error when it is given up, or three problems in succession were passed
  /// over, or one whose answer does not come holds up the others, since nobody can start it again.
  RunExecutor(Bus* bus, NodeRegistry* registry, SessionConditions conditions,
              KernelFolders kernel = {}, std::vector<Contestant> first_planners = {},
              std::optional<SupervisedServer> server = {}, ServerPatience patience = {});

  /// The scene server's answer on whether it has such a problem, with ok or without; nothing if
  /// `interrupted`. The server also hands out the scene. That of a server which was started again
  /// on other files is without ok if the problem is not what it was, and so is, with the reason,
  /// that on a problem that is passed over.
  std::optional<ProblemMessage> AskForProblem(const std::string& set, int index,
                                              const std::function<bool()>& interrupted);
  /// Whom a run asks, one after the other: the contestant whose path its planner improves, if it
  /// does, and its planner.
  std::vector<ScheduledRun> RequestsOf(const ScheduledRun& run) const;
  /// The finished record, what kept the planners from working among the answer's counters; nothing
  /// if `interrupted`. `planners`: those of RequestsOf(run). Of several the answer is the last
  /// one's, or, if the limit comes before that has a path, the first one's path; times and counters
  /// are sums (of kToldTime the longest stands). Where the scene server denies the problem, which
  /// it had when the session began, the record says so; where the problem is passed over before
  /// there is a verdict, or the raw path is refused one, it is that of a run that was not asked for
  /// (asked_runs.h).
  std::optional<RunRecordMessage> Execute(const ScheduledRun& run,
                                          const std::vector<PlannerClient*>& planners,
                                          const std::function<bool()>& interrupted);
  /// Has a planner answer a first request, within `time_limit_s`, that is neither judged nor
  /// recorded: what a process does only once is then no part of any run. It is the run's but for
  /// its seed, so that where that counts the search is another. A line says so if there is no
  /// result; of a problem that cannot be had the planner is not asked. One that comes in the place
  /// of a process that dies of it answers another, but no third: it may be the problem's doing.
  /// False if `interrupted`.
  bool WarmUp(const ScheduledRun& run, double time_limit_s, PlannerClient* planner,
              const std::function<bool()>& interrupted);

 private:
  using ProblemKey = std::pair<std::string, int>;  // set and index

  std::optional<ProblemMessage> ProblemOf(const ScheduledRun& run,
                                          const std::function<bool()>& interrupted);
  std::optional<PathCheckReplyMessage> Judge(const std::string& check_id, const Path& path,
                                             const RunRecordMessage& record,
                                             const ScheduledRun& run,
                                             const std::function<bool()>& interrupted);
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
  /// "" if it is not.
  std::string WhyPassedOver(const ProblemKey& problem);

  struct Asked {
    PlannerClient::Answer answer;
    bool is_first_path;  ///< Whoever was to improve it had none when the limit came.
  };
  /// The answer to a run's request, which gets the path that is to be improved.
  Asked Ask(const ScheduledRun& run, const ProblemMessage& problem,
            const std::vector<PlannerClient*>& planners, PlanRequest* request,
            const std::function<bool()>& interrupted) const;
  /// Whether a path that one planner found to a request is, as far as is known, what the other
  /// would have found free to its own.
  bool AreCheckedAlike(const PlanRequest& first, const std::string& first_planner,
                       const PlanRequest& second, const std::string& second_planner) const;
  /// Of planners on this machine; none if one is elsewhere.
  std::vector<pid_t> PidsOf(const std::vector<PlannerClient*>& planners) const;
  const Contestant& ContestantOf(const ScheduledRun& run) const;
  PlanRequest RequestOf(const ScheduledRun& run, const ProblemMessage& problem) const;

  NodeRegistry* registry_;
  SessionConditions conditions_;
  std::vector<Contestant> first_planners_;
  KernelFolders kernel_;
  std::optional<SupervisedServer> server_;
  ServerPatience patience_;
  Service<ProblemRequestMessage, ProblemMessage> problems_;
  Service<PathCheckRequestMessage, PathCheckReplyMessage> path_checks_;
  std::timed_mutex turn_;
  std::mutex mutex_;
  std::map<ProblemKey, ProblemMessage> problems_known_;
  std::map<ProblemKey, ProblemMessage> problems_first_;  // as they were when first asked for
  std::map<ProblemKey, std::string> passed_over_;        // and why
};

}  // namespace planbench
