#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_driver/machine.h"
#include "benchmark_driver/planner_client.h"
#include "benchmark_driver/scene_server_client.h"
#include "benchmark_driver/schedule.h"
#include "benchmark_driver/unasked_runs.h"

namespace planbench {

/// Counter of a run whose planner improves another's path: how long that took to be handed over, s.
inline constexpr char kFirstPathTime[] = "first_path_time";

/// Makes one run: fetches the problem if it is not known yet, has the planner solve it, has the
/// scene server judge the paths. Thread-safe for different planners.
class RunExecutor {
 public:
  /// `conditions`: complete, the referee's step and the contestants' included; `first_planners`
  /// likewise, who are no contestants and find paths that these improve. What asks the scene server
  /// throws as SceneServerClient does.
  RunExecutor(Bus* bus, NodeRegistry* registry, SessionConditions conditions,
              KernelFolders kernel = {}, std::vector<Contestant> first_planners = {},
              std::optional<SupervisedServer> server = {}, ServerPatience patience = {});

  /// SceneServerClient's.
  std::optional<ProblemMessage> AskForProblem(const std::string& set, int index,
                                              const std::function<bool()>& interrupted) {
    return scene_server_.AskForProblem(set, index, interrupted);
  }
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

  /// Runs whose planners were not asked.
  const UnaskedRuns& unasked() const { return unasked_; }

 private:
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
  /// Of planners on this machine; none if one is not seen here.
  std::vector<pid_t> PidsOf(const std::vector<PlannerClient*>& planners) const;
  const Contestant& ContestantOf(const ScheduledRun& run) const;
  PlanRequest RequestOf(const ScheduledRun& run, const ProblemMessage& problem) const;

  NodeRegistry* registry_;
  SessionConditions conditions_;
  std::vector<Contestant> first_planners_;
  KernelFolders kernel_;
  SceneServerClient scene_server_;
  UnaskedRuns unasked_;
};

}  // namespace planbench
