#include "benchmark_driver/driver.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <set>
#include <thread>

#include "benchmark_driver/await_nodes.h"
#include "benchmark_driver/contestant_names.h"
#include "benchmark_driver/earlier_plan.h"
#include "benchmark_driver/session_contestants.h"
#include "common/error.h"
#include "common/lookup.h"
#include "common/random_id.h"
#include "common/utime.h"
#include "messaging/asked_runs.h"
#include "messaging/node_announcer.h"
#include "messaging/session_conditions.h"
#include "planning/told_edges.h"
#include "planning/told_warnings.h"
#include "results/reason_count.h"
#include "results/training.h"
#include "robot_model/referee_misfits.h"

namespace planbench {
namespace {

/// Tells among their settings how planners are asked to check for collisions: who finds first paths
/// alone is none of the contestants, of which the conditions tell it.
void TellChecks(const SessionConditions& conditions, const std::vector<Contestant>& asked,
                std::vector<NodeStatusMessage>* nodes) {
  for (const Contestant& one : asked) {
    const auto model = one.collision_model.value_or(conditions.request.collision_model);
    for (NodeStatusMessage& node : *nodes) {
      if (node.kind != NodeKind::kPlanner || node.name != one.planner) continue;
      node.settings["collision checks"] =
          fmt::format("{}, edges {}", EnumName(model),
                      DescribeEdges(one.edge_check, one.edge_resolution_m, node.settings));
    }
  }
}

std::set<std::string> IdsOf(const std::vector<ScheduledRun>& runs) {
  std::set<std::string> ids;
  for (const ScheduledRun& run : runs) ids.insert(run.request_id);
  return ids;
}

}  // namespace

std::string NewRunId() {
  return fmt::format("{:%Y%m%dT%H%M%SZ}-{}", fmt::gmtime(std::time(nullptr)), RandomId());
}

Driver::Driver(Bus* bus, DriverOptions options, std::vector<LineUpEntry> line_up,
               std::map<std::string, std::string> flags, EarlierSession earlier)
    : bus_(bus),
      options_(std::move(options)),
      line_up_(std::move(line_up)),
      flags_(std::move(flags)),
      earlier_(std::move(earlier)),
      begun_utime_(NowUtime()),
      registry_(bus),
      recorder_(bus, &registry_, options_.record_folder) {
  if (earlier_.sessions.empty()) return;
  begun_utime_ = earlier_.sessions.front().start_utime;
  earlier_time_s_ = earlier_.sessions.back().total_time_s;
}

std::string Driver::Missing(bool need_logger) const {
  std::vector<std::string> missing;
  if (registry_.Live(NodeKind::kSceneServer).empty() || !registry_.ProblemSets()) {
    missing.emplace_back("a scene server");
  }
  for (const LineUpEntry& entry : line_up_) {
    if (registry_.Find(entry.contestant.planner, NodeKind::kPlanner)) continue;
    missing.push_back("a planner named '" + entry.contestant.planner + "'");
  }
  if (need_logger && registry_.Live(NodeKind::kLogger).empty()) missing.emplace_back("a logger");
  return fmt::format("{}", fmt::join(missing, ", "));
}

void Driver::Discover(bool need_logger, const std::function<void()>& watch,
                      std::optional<SupervisedServer> server, ServerPatience patience,
                      SupervisedPlanners supervised) {
  AwaitNodes(
      &registry_, options_.DiscoveryTimeout(), [&] { return Missing(need_logger); }, watch);
  for (const NodeKind kind : {NodeKind::kSceneServer, NodeKind::kLogger}) {
    for (const NodeStatusMessage& node : registry_.Live(kind)) RequireSameBuild(node);
  }
  served_ = *registry_.ProblemSets();
  scene_server_ = registry_.Find(served_.server, NodeKind::kSceneServer);
  FoundPlanners found_planners =
      CompleteConditions(registry_, served_, line_up_, NamesGiven(earlier_.sessions), &options_);
  planners_ = std::move(found_planners.planners);
  first_planners_ = std::move(found_planners.first_planners);
  const PlannedCall call = PlanCall(options_, PlannedPlanners(), served_);
  for (const std::string& line : ShortOfRange(options_, call)) spdlog::warn("{}", line);
  schedule_ = MakeSchedule(call, options_.conditions.request);
  std::set<std::string> sets;
  for (const ScheduledRun& run : schedule_) sets.insert(run.problem_set);
  for (const ProblemSetSummary& set : served_.sets) {
    if (sets.contains(set.name)) options_.conditions.problem_sets[set.name] = set.content_id;
  }
  for (const auto& session : earlier_.sessions) RequireSameConditions(session, Session(false));
  if (const auto line = DescribeInstructionDifference(earlier_.sessions, Session(false).cpu)) {
    spdlog::warn("--resume: {}", *line);
  }
  const Known known = TakeUp(std::exchange(earlier_, {}), call);
  const std::chrono::milliseconds to_come = options_.TimeToComeBack();
  patience.until_passed_over = std::max(patience.until_passed_over, to_come);
  patience.until_given_up = std::max(patience.until_given_up, to_come);
  executor_ = std::make_unique<RunExecutor>(bus_, &registry_, options_.conditions, options_.kernel,
                                            first_planners_, std::move(server), patience);
  asked_ = std::make_unique<SessionPlanners>(bus_, &registry_, executor_.get(), planners_,
                                             patience.until_given_up, options_.problems_per_process,
                                             std::move(supervised));
  CheckProblems(known.met, watch);
  Owe(known);  // not before it is known which problems are left out
  // A resumed session may be given other sets or problems than before. What a first attempt makes
  // needless goes when it is known.
  num_runs_ = static_cast<int>(known.done.size() + schedule_.size() - repeats_.size()) + num_owed_;
}

Driver::Known Driver::TakeUp(EarlierSession earlier, const PlannedCall& call) {
  Known known;
  known.call = schedule_;
  known.plan.emplace();
  if (!earlier.sessions.empty()) {
    known.last = earlier.sessions.back();
    known.plan = EarlierPlan(known.last, call);
  }
  for (const PlannedCall& before : known.plan.value_or(SessionPlan())) {
    std::vector<ScheduledRun> runs = MakeSchedule(before, options_.conditions.request);
    std::move(runs.begin(), runs.end(), std::back_inserter(known.planned));
  }
  if (known.plan) AddCalls({call}, &*known.plan);
  for (const std::vector<ScheduledRun>* runs : {&known.call, &known.planned}) {
    for (const ScheduledRun& run : *runs) {
      if (run.unless_solved) suffices_[*run.unless_solved] = false;
      if (run.is_one_of_two) one_of_two_.insert(run.request_id);
    }
  }
  const std::set<std::string> in_call = IdsOf(known.call);
  earlier.each_run([&](const RunRecordMessage& record) {
    PlanRequest& met = known.met[{record.problem_set, record.problem_index}];
    if (met.scene_id.empty()) met = record.request;
    const bool is_in_call = in_call.contains(record.request_id);
    known.all_in_call = known.all_in_call && is_in_call;
    known.recorded[{{record.problem_set, record.problem_index, record.trial},
                    record.planner,
                    record.request.direction}] = Suffices(record);
    const bool was_asked = WasAsked(record);
    if (!was_asked && is_in_call) return;  // it is to be made
    (was_asked ? known.done : known.not_asked).insert(record.request_id);
    const RunStanding standing = StandingOf(record);
    const bool is_to_repeat = IsToRepeat(standing);
    if (is_to_repeat && is_in_call) repeats_[record.request_id] = standing.repeats;
    num_owed_repeats_ += is_to_repeat && !is_in_call;
    num_owed_unjudgeable_ += IsUnjudgeable(record);
    Keep(record);
  });
  std::erase_if(schedule_, [&](const ScheduledRun& run) {
    const bool is_needed = NeedOf(run) != Need::kDrop && !known.done.contains(run.request_id);
    return !is_needed && !repeats_.contains(run.request_id);
  });
  awaited_shards_ = AwaitedShards(known.last, known.plan);
  AddEarlier(earlier.sessions, &options_.conditions);
  for (const SessionMessage& session : earlier.sessions) {
    for (const NodeStatusMessage& node : session.nodes) {
      if (node.kind == NodeKind::kSceneServer) {
        std::ranges::move(ToldWarnings(kProblemWarning, node.settings),
                          std::back_inserter(problem_warnings_));
        std::ranges::move(ToldWarnings(kPlannerWarning, node.settings),
                          std::back_inserter(planner_warnings_));
      }
      if (node.kind != NodeKind::kPlanner) continue;
      const auto found = planners_.find(node.name);
      if (found != planners_.end() && found->second.host == node.host) continue;
      earlier_planners_.insert_or_assign({node.name, node.host}, node);
    }
  }
  left_out_ = known.last.left_out;
  for (const std::string& problem : ProblemsOf({call})) left_out_.erase(problem);
  return known;
}

bool Driver::IsToDo(const ScheduledRun& run, const Known& known) const {
  return !known.done.contains(run.request_id) &&
         !(run.unless_solved && suffices_.at(*run.unless_solved));
}

int Driver::CountOwedByNumber(const Known& known) const {
  std::set<std::string> planners, sets;  // of this call
  for (const ScheduledRun& run : known.call) {
    planners.insert(run.planner);
    sets.insert(run.problem_set);
  }
  const SessionConditions& had = known.last.conditions;
  std::set<std::string> had_planners;
  for (const Contestant& one : had.contestants) had_planners.insert(one.planner);
  const bool may_be_all =
      std::includes(planners.begin(), planners.end(), had_planners.begin(), had_planners.end()) &&
      std::all_of(had.problem_sets.begin(), had.problem_sets.end(),
                  [&](const auto& set) { return sets.contains(set.first); });
  // The number may include backward searches that have become needless.
  const auto may_be_of_it = [&](const ScheduledRun& run) {
    return had.problem_sets.contains(run.problem_set) && had_planners.contains(run.planner) &&
           !known.done.contains(run.request_id) && (may_be_all || IsToDo(run, known));
  };
  const auto num_left =
      static_cast<int>(known.done.size()) +
      static_cast<int>(std::count_if(known.call.begin(), known.call.end(), may_be_of_it));
  return std::max(static_cast<int>(known.not_asked.size()), known.last.num_runs - num_left);
}

void Driver::Owe(const Known& known) {
  if (known.plan) {
    std::map<PlannedRun, bool> made = known.recorded;
    for (const ScheduledRun& run : schedule_) {
      made.try_emplace(
          {{run.problem_set, run.problem_index, run.trial}, run.planner, run.direction}, false);
    }
    num_owed_ = CountOwed(*known.plan, made, left_out_) + static_cast<int>(known.not_asked.size());
  } else {
    num_owed_ = CountOwedByNumber(known);
  }
  const std::set<std::string> call = IdsOf(known.call), planned = IdsOf(known.planned);
  const bool is_all = known.all_in_call && num_owed_ == 0 &&
                      std::includes(call.begin(), call.end(), planned.begin(), planned.end());
  const bool is_part =
      std::all_of(known.call.begin(), known.call.end(), [&](const ScheduledRun& run) {
        return planned.contains(run.request_id) || !IsToDo(run, known);
      });
  flags_ = FlagsOfResumed(known.last.settings, std::move(flags_),
                          is_all    ? PlanScope::kAll
                          : is_part ? PlanScope::kPart
                                    : PlanScope::kOther);
  if (!known.plan && !awaited_shards_.empty()) {
    flags_[kShardFlag] = known.last.settings.at(kShardFlag);
  }
  if (flags_.empty()) return;
  flags_.erase(kPlanSetting);
  if (known.plan) flags_[kPlanSetting] = PlanText(*known.plan);
}

void Driver::CheckProblems(const std::map<ProblemKey, PlanRequest>& met,
                           const std::function<void()>& watch) {
  std::set<ProblemKey> problems;
  for (const ScheduledRun& run : schedule_) problems.emplace(run.problem_set, run.problem_index);
  std::set<ProblemKey> bad;
  std::vector<std::string> warnings;
  std::set<std::string> told;  // Sets and what is said of their problems, but for file and figures.
  const auto interrupted = [&] {
    watch();  // throws, if so
    return false;
  };
  for (const auto& [set, index] : problems) {
    const ProblemMessage answer = executor_->AskForProblem(set, index, interrupted).value();
    const auto before = met.find({set, index});
    if (answer.ok && before != met.end() && !before->second.scene_id.empty()) {
      const std::string_view part = ChangedPart(before->second, answer);
      if (!part.empty()) {
        throw InputError(fmt::format("--resume: the {} of {} is another than in the session's runs",
                                     part, LeftOutName(set, index)));
      }
    }
    if (!answer.ok && before != met.end()) {
      spdlog::error("{} {}: {}", set, index, answer.message);
    } else if (!answer.ok) {
      bad.emplace(set, index);
      left_out_[LeftOutName(set, index)] = answer.message;
    } else if (const std::string& warning = answer.message; !warning.empty()) {
      const std::size_t file_end = std::min(warning.find(": "), warning.size());
      const std::string said = WithoutFigures(warning.substr(file_end));
      if (told.insert(set + said).second) warnings.push_back(warning);
    }
  }
  constexpr std::size_t kMostWarnings = 5;
  for (std::size_t i = 0; i < std::min(kMostWarnings, warnings.size()); ++i) {
    spdlog::warn("{}", warnings[i]);
  }
  if (warnings.size() > kMostWarnings) {
    spdlog::warn("{} more warnings; see the scene server's log", warnings.size() - kMostWarnings);
  }
  std::ranges::move(warnings, std::back_inserter(problem_warnings_));
  for (const auto& [problem, reason] : left_out_) spdlog::error("{}: {}", problem, reason);
  if (!bad.empty() && !options_.skip_bad_problems) {
    throw InputError(
        fmt::format("{} of {} problems are bad; mend them, choose others (--problems-range), or "
                    "leave them out (--skip-bad-problems)",
                    bad.size(), problems.size()));
  }
  std::erase_if(schedule_, [&](const ScheduledRun& run) {
    return bad.contains({run.problem_set, run.problem_index});
  });
  const bool none_made = std::none_of(runs_.rows().begin(), runs_.rows().end(),
                                      [](const RunRow& run) { return run.asked; });
  if (schedule_.empty() && !bad.empty() && none_made) {
    throw InputError(fmt::format("all {} problems are bad: none is left to run", bad.size()));
  }
}

std::string Driver::referee_misfits() const {
  return scene_server_ ? Lookup(scene_server_->settings, kRefereeMisfits).value_or("") : "";
}

std::vector<PlannedPlanner> Driver::PlannedPlanners() const {
  std::vector<PlannedPlanner> planned;
  for (const LineUpEntry& entry : line_up_) {
    if (entry.finds_first_paths_only) continue;
    planned.push_back(PlanPlanner(entry.contestant, entry.directions.value_or(options_.directions),
                                  options_.trials, planners_));
  }
  return planned;
}

SessionMessage Driver::Session(bool finished) const {
  const NodeStatusMessage self = MakeNodeStatus("driver", NodeKind::kDriver);
  SessionMessage session;
  session.run_id = options_.conditions.request.run_id;
  session.start_utime = begun_utime_;
  session.finished = finished;
  // The time of day may be set meanwhile.
  session.total_time_s =
      earlier_time_s_ +
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  session.num_runs = num_runs_;
  session.version = self.version;
  session.commit = self.commit;
  session.host = self.host;
  session.cpu = DescribeMachine(options_.kernel).at("cpu");
  session.robot_name = served_.robot_name;
  session.conditions = options_.conditions;
  session.settings = flags_;
  session.left_out = left_out_;
  for (const NodeStatusMessage& node : registry_.Live()) {
    if (node.kind != NodeKind::kPlanner) session.nodes.push_back(node);
  }
  if (scene_server_ && registry_.Live(NodeKind::kSceneServer).empty()) {
    session.nodes.push_back(*scene_server_);  // it tells the warnings
  }
  for (const auto& [name, planner] : planners_) session.nodes.push_back(planner);
  std::vector<std::string> planner_warnings = planner_warnings_;
  if (asked_) {
    for (SessionPlanners::Move& move : asked_->moves()) {
      session.nodes.push_back(std::move(move.process));
      planner_warnings.push_back(std::move(move.warning));
    }
  }
  for (const auto& [place, planner] : earlier_planners_) session.nodes.push_back(planner);
  for (NodeStatusMessage& node : session.nodes) {
    if (node.kind != NodeKind::kSceneServer) continue;
    TellWarnings(kRobotWarning, options_.robot_warnings, &node.settings);
    TellWarnings(kProblemWarning, problem_warnings_, &node.settings);
    TellWarnings(kPlannerWarning, planner_warnings, &node.settings);
  }
  TellChecks(session.conditions, session.conditions.contestants, &session.nodes);
  TellChecks(session.conditions, first_planners_, &session.nodes);
  return session;
}

const RunRow& Driver::Keep(const RunRecordMessage& record) {
  const auto attempt = suffices_.find(record.request_id);
  bool needs_other =
      one_of_two_.contains(record.request_id) && record.status != PlanStatus::kSolved;
  if (attempt != suffices_.end()) {
    attempt->second = Suffices(record);
    needs_other = !attempt->second;
  }
  return runs_.Add(record, needs_other, repeats_.contains(record.request_id));
}

std::optional<RunRecordMessage> Driver::Make(const ScheduledRun& run,
                                             const std::function<bool()>& interrupted) {
  const auto asked = asked_->ReadyFor(run, interrupted);
  if (!asked) return std::nullopt;
  std::optional<RunRecordMessage> record = executor_->Execute(run, *asked, interrupted);
  if (!record) return std::nullopt;
  const NodeStatusMessage& planner = planners_.at(run.planner);
  record->algorithm = planner.algorithm;
  record->planner_class = planner.planner_class;
  record->settings = planner.settings;
  if (asked->size() > 1) {
    const std::string& first = asked->front()->planner();
    record->settings.merge(FirstPathSettings(first, planners_.at(first).settings));
  }
  return record;
}

bool Driver::IsToRepeat(const RunStanding& attempt) const {
  return options_.repeat_disturbed && OwesRepeat(attempt);
}

Driver::Need Driver::NeedOf(const ScheduledRun& run) const {
  if (!run.unless_solved || !suffices_.at(*run.unless_solved)) return Need::kMake;
  return repeats_.contains(*run.unless_solved) ? Need::kWait : Need::kDrop;
}

bool Driver::TakeIn(RunRecordMessage* record) {
  const std::scoped_lock lock(mutex_);
  const auto before = repeats_.find(record->request_id);
  const int repeats = before == repeats_.end() ? 0 : before->second + 1;
  if (repeats > 0) repeats_.erase(before);
  if (repeats > 0 && !WasAsked(*record)) {  // the attempt that was disturbed stands
    ++num_repeats_not_asked_;
    progress_->Drop();
    return false;
  }
  std::map<std::string, double>& counters = record->result.result.counters;
  const bool answered = !record->result.request_id.empty();
  if (answered) {
    counters["disturbed"] =
        IsDisturbed(counters, record->roundtrip_time_s, options_.max_disturbance) ? 1 : 0;
  }
  if (answered || repeats > 0) counters["repeats"] = repeats;
  if (IsToRepeat(StandingOf(*record))) repeats_[record->request_id] = repeats;
  return true;
}

void Driver::RunLane(const std::vector<ScheduledRun>& lane,
                     const std::function<bool()>& interrupted) {
  std::vector<ScheduledRun> left = lane;
  while (!left.empty()) {
    std::vector<ScheduledRun> again;
    for (const ScheduledRun& run : left) {
      {
        const std::scoped_lock lock(mutex_);
        const Need need = NeedOf(run);
        if (need == Need::kWait) again.push_back(run);
        if (need == Need::kDrop) {
          if (repeats_.erase(run.request_id) == 0) --num_runs_;  // else it has a record
          progress_->Drop();
        }
        if (need != Need::kMake) continue;
      }
      std::optional<RunRecordMessage> record = Make(run, interrupted);
      if (!record) return;
      if (!TakeIn(&*record)) continue;
      recorder_.Record(*record);
      const std::scoped_lock lock(mutex_);
      num_not_asked_ += WasAsked(*record) ? 0 : 1;
      num_unjudgeable_ += IsUnjudgeable(*record) ? 1 : 0;
      progress_->Add(Keep(*record));
      if (repeats_.contains(run.request_id)) again.push_back(run);
    }
    left = std::move(again);
  }
}

bool Driver::Run(const std::function<bool()>& interrupted, const std::function<void()>& watch) {
  progress_ = std::make_unique<ProgressBar>(
      static_cast<int>(runs_.size() + schedule_.size() - repeats_.size()), runs_);
  recorder_.Record(Session(false));

  std::vector<std::vector<ScheduledRun>> lanes;
  if (options_.conditions.parallel) {
    for (const LineUpEntry& entry : line_up_) {
      std::vector<ScheduledRun>& lane = lanes.emplace_back();
      for (const ScheduledRun& run : schedule_) {
        if (run.planner == entry.contestant.planner) lane.push_back(run);
      }
    }
  } else {
    lanes.push_back(schedule_);
  }

  std::atomic<bool> stop = false;
  std::atomic<int> num_working = static_cast<int>(lanes.size());
  std::exception_ptr failure;
  std::vector<std::thread> threads;
  for (const std::vector<ScheduledRun>& lane : lanes) {
    threads.emplace_back([&, &lane = lane] {
      try {
        RunLane(lane, [&] { return stop.load(); });
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        if (!failure) failure = std::current_exception();
        stop = true;
      }
      --num_working;
    });
  }
  while (num_working > 0) {
    try {
      watch();
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
    if (interrupted()) stop = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& thread : threads) thread.join();
  progress_.reset();
  const bool complete = recorder_.Complete() && !stop;
  recorder_.Record(Session(complete && num_owed_ + num_not_asked_ + num_to_repeat() == 0 &&
                           awaited_shards_.empty()));
  const bool recorded = complete && recorder_.Complete();
  if (failure) std::rethrow_exception(failure);
  return recorded;
}

}  // namespace planbench
