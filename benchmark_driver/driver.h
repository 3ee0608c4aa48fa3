#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_driver/driver_options.h"
#include "benchmark_driver/line_up.h"
#include "benchmark_driver/progress_bar.h"
#include "benchmark_driver/recorder.h"
#include "benchmark_driver/resume.h"
#include "benchmark_driver/run_executor.h"
#include "benchmark_driver/run_rows.h"
#include "benchmark_driver/schedule.h"
#include "benchmark_driver/session_planners.h"
#include "messaging/asked_runs.h"
#include "messaging/bus.h"
#include "messaging/node_registry.h"
#include "results/session_plan.h"

namespace planbench {

/// A benchmark session against live processes: finds them, makes the runs, has them recorded.
class Driver {
 public:
  /// `options`: run_id included. `line_up`: as MakeLineUp gives it. `flags`: for the record.
  /// `earlier`: of the session that is resumed; empty for a new one.
  Driver(Bus* bus, DriverOptions options, std::vector<LineUpEntry> line_up,
         std::map<std::string, std::string> flags, EarlierSession earlier = {});

  /// Waits for scene server, planners and (with `need_logger`) a logger, checks that they fit
  /// together and to the session that is resumed, makes the schedule, and asks for all problems of
  /// it, so that bad ones, at which the scene server fails included, are known before the first
  /// run. `watch` is called while waiting and may throw. `server`: RunExecutor's. `patience`: also
  /// without a live planner; a process that has gone is given as long to come back as it had to
  /// come. `supervised`: SessionPlanners'. Throws InputError naming what is missing or does not
  /// fit, std::runtime_error when the scene server is given up.
  void Discover(bool need_logger, const std::function<void()>& watch,
                std::optional<SupervisedServer> server = {}, ServerPatience patience = {},
                SupervisedPlanners supervised = {});
  /// Makes all runs; `interrupted` and `watch` are asked often. True if every run was made and
  /// recorded; a session that was to make others before it was resumed, or to repeat them, in which
  /// one was not asked (num_not_asked), or which awaits shards, is not finished by that.
  bool Run(const std::function<bool()>& interrupted, const std::function<void()>& watch);

  /// Whatever is left to that planner is recorded as NO_ANSWER for that reason, until the session
  /// is resumed. Thread-safe.
  void GiveUp(const std::string& planner, const std::string& reason) {
    asked_->GiveUp(planner, reason);
  }

  /// All runs that have a record so far, those of the resumed session included, but for what this
  /// call has yet to make.
  const RunRows& runs() const { return runs_; }
  /// Of the session, those not made included.
  int num_runs() const { return num_runs_; }
  /// Of them those that the resumed session was to make and this call is not; some may have a
  /// record, of that they were not asked for.
  int num_owed() const { return num_owed_; }
  /// Of these those that no resumed session makes (messaging/asked_runs.h).
  int num_owed_unjudgeable() const { return num_owed_unjudgeable_; }
  /// Disturbed runs of the resumed session that are still to be made again, and not by this call.
  int num_owed_repeats() const { return num_owed_repeats_; }
  /// These, and those of this call, be it that no request could be sent for them.
  int num_to_repeat() const {
    return num_owed_repeats_ + num_repeats_not_asked_ + static_cast<int>(repeats_.size());
  }
  /// Shards that the session, once merged of others, does not hold: it is not finished without.
  /// In lines.
  const std::vector<std::string>& awaited_shards() const { return awaited_shards_; }
  /// Of this call's runs and repeats those of which no request was sent (messaging/asked_runs.h):
  /// made when the session is resumed with the same flags, but for num_unjudgeable of them. Others
  /// of the resumed session are owed.
  int num_not_asked() const { return num_not_asked_ + num_repeats_not_asked_; }
  int num_unjudgeable() const { return num_unjudgeable_; }
  /// What is not recorded and why, in lines.
  std::vector<std::string> Shortcomings() const { return recorder_.Shortcomings(); }
  /// Planners that were given up, and why.
  std::map<std::string, std::string> given_up() const { return asked_->given_up(); }
  /// Of these and of others that were not asked for runs: why, and for how many, in lines.
  std::vector<std::string> UnaskedRunLines() const {
    return executor_->unasked().Lines(given_up());
  }
  /// SessionMessage's.
  const std::map<std::string, std::string>& left_out() const { return left_out_; }
  /// Complete once the processes are found.
  const SessionConditions& conditions() const { return options_.conditions; }
  /// In what the scene server says that its mesh robot is another one (RefereeMisfits).
  std::string referee_misfits() const;

 private:
  std::string Missing(bool need_logger) const;
  using ProblemKey = std::pair<std::string, int>;  // set and index
  /// Lists the schedule's bad problems with their reasons; throws InputError, or leaves them out.
  /// One that has gone bad since the resumed session had runs of it (`met`, with a request of such
  /// a run) ends it no more than it would have ended that session, and is not left out either: the
  /// runs it has are recorded. One that is another than it was ends it.
  void CheckProblems(const std::map<ProblemKey, PlanRequest>& met,
                     const std::function<void()>& watch);
  std::vector<PlannedPlanner> PlannedPlanners() const;
  /// What is known of the session when this call goes on with it; of a new one that is the call.
  struct Known {
    SessionMessage last;                    ///< What it told before.
    std::optional<SessionPlan> plan;        ///< This call included; nothing if it is not known.
    std::vector<ScheduledRun> planned;      ///< Of that, by the calls before.
    std::vector<ScheduledRun> call;         ///< All of this one, whatever is made or cannot be.
    std::map<PlannedRun, bool> recorded;    ///< Whatever has a record: CountOwed's `made`.
    std::map<ProblemKey, PlanRequest> met;  ///< CheckProblems'.
    std::set<std::string> done;             ///< Request ids of records of requests.
    std::set<std::string> not_asked;        ///< Of others, but for what this call makes.
    bool all_in_call = true;                ///< Whatever has a record.
  };
  /// Takes over what was told and made of the resumed session, and leaves to do what it lacks.
  Known TakeUp(EarlierSession earlier, const PlannedCall& call);
  /// Counts what the session was to make and this call is not, problems considered that either
  /// leaves out, and says how all of it is made.
  void Owe(const Known& known);
  /// Of a plan that is not known, by the number of runs that was told.
  int CountOwedByNumber(const Known& known) const;
  /// Whether a run has to be made as far as records tell.
  bool IsToDo(const ScheduledRun& run, const Known& known) const;
  SessionMessage Session(bool finished) const;
  bool IsToRepeat(const RunStanding& attempt) const;
  /// A run whose forward attempt found a path is not made, and waits while that one is to be
  /// repeated, which may yet fail. `mutex_` is held.
  enum class Need { kMake, kWait, kDrop };
  Need NeedOf(const ScheduledRun& run) const;
  /// Tells in an attempt's record whether it was disturbed and which repeat it is, and whether
  /// another is to follow in `repeats_`. False for a repeat that was not asked for: none is
  /// recorded.
  bool TakeIn(RunRecordMessage* record);
  /// Makes the runs of a lane, then those that were disturbed again, if they are to be repeated.
  /// Every attempt is recorded at once, a repeat's record in the place of the one before, so that a
  /// session that is interrupted lacks no run for having been disturbed, as long ones are sooner.
  void RunLane(const std::vector<ScheduledRun>& lane, const std::function<bool()>& interrupted);
  /// The record of a run, nothing if interrupted.
  std::optional<RunRecordMessage> Make(const ScheduledRun& run,
                                       const std::function<bool()>& interrupted);
  const RunRow& Keep(const RunRecordMessage& record);

  Bus* bus_;
  DriverOptions options_;
  std::vector<LineUpEntry> line_up_;
  std::map<std::string, std::string> flags_;  // once discovered: those of the session
  EarlierSession earlier_;
  std::int64_t begun_utime_;   // of the session's first part
  double earlier_time_s_ = 0;  // of its parts before
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();  // of this
  NodeRegistry registry_;
  Recorder recorder_;
  ProblemSetsMessage served_;
  std::optional<NodeStatusMessage> scene_server_;  // as found
  std::vector<ScheduledRun> schedule_;             // what is left to do
  int num_runs_ = 0;                               // of the session, those done earlier included
  int num_owed_ = 0;  // of those the resumed session's that are not to do
  int num_owed_unjudgeable_ = 0;
  int num_owed_repeats_ = 0;
  std::vector<std::string> awaited_shards_;
  std::map<std::string, std::string> left_out_;  // SessionMessage's
  std::vector<std::string> problem_warnings_;    // of the session's problems
  std::vector<std::string> planner_warnings_;    // of its parts before
  std::vector<Contestant> first_planners_;       // who find paths for contestants and are none
  std::unique_ptr<RunExecutor> executor_;

  /// By name, as found: processes that are described otherwise are not asked.
  std::map<std::string, NodeStatusMessage> planners_;
  /// By name and host, as the resumed session told: others than these.
  std::map<std::pair<std::string, std::string>, NodeStatusMessage> earlier_planners_;
  std::unique_ptr<SessionPlanners> asked_;  // once discovered

  std::mutex mutex_;
  RunRows runs_;
  int num_not_asked_ = 0;
  int num_unjudgeable_ = 0;  // of them
  int num_repeats_not_asked_ = 0;
  /// Of attempts that others depend on, by request id: whether these are not made, since the
  /// planner found a path, by its own word, or could not be asked (asked_runs.h): then nobody knows
  /// yet whether they are needed.
  std::map<std::string, bool> suffices_;
  /// Of runs whose recorded attempt was disturbed and gives way to a repeat's, by request id: which
  /// repeat that attempt was.
  std::map<std::string, int> repeats_;
  std::set<std::string> one_of_two_;  ///< Request ids (ScheduledRun::is_one_of_two).
  std::unique_ptr<ProgressBar> progress_;
};

/// A new run id: UTC date and time and 64 random bits, e.g. "20261122T153000Z-4f2a0c93b1d85e67".
std::string NewRunId();

}  // namespace planbench
