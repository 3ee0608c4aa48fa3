#include "benchmark_driver/run_executor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "benchmark_driver/local_process.h"
#include "benchmark_driver/possible_times.h"
#include "common/random_id.h"
#include "common/utime.h"
#include "planning/path_measures.h"
#include "planning/told_edges.h"
#include "results/outcomes.h"

namespace planbench {
namespace {

/// The planner's answer, its times being possible, without what the driver alone may tell.
PlannerClient::Answer AnswerOf(PlannerClient* planner, const PlanRequest& request,
                               const std::function<bool()>& interrupted) {
  PlannerClient::Answer answer = planner->Solve(request, interrupted);
  if (answer.outcome != PlannerClient::Outcome::kResult) return answer;
  answer.result.result.counters.erase(kFirstPathTime);
  KeepTimesPossible(answer.roundtrip_time_s, request, answer.overdue, &answer.result.result);
  return answer;
}

/// How long whoever improves a path waited for it: it is handed over when the first planner has
/// answered, which may be after the path was found.
double HandedOverAfter(const PlanResult& first) {
  return std::max(first.planning_time_s, first.total_time_s);
}

/// What it took to find the path that a result began with.
void AddBefore(const PlanResult& first, PlanResult* result) {
  const double before_s = HandedOverAfter(first);
  result->planning_time_s += before_s;
  result->total_time_s += before_s;
  for (PlanProgress& progress : result->progress) progress.elapsed_s += before_s;
  for (double PhaseTimes::*const part : kPartsOfTotal) result->phases.*part += first.phases.*part;
  for (const auto& [name, count] : first.counters) {
    double& whole = result->counters[name];
    whole = name == kToldTime ? std::max(whole, count) : whole + count;
  }
  result->peak_memory_mb = std::max(result->peak_memory_mb, first.peak_memory_mb);
}

/// How much of its time, s, whoever was to improve a path left unused, as by its own clock or the
/// driver's; 0 if that may be what clocks and a careful planner make of the limit.
double LeftUnused(const PlannerClient::Answer& answer, double time_limit_s) {
  constexpr double kShare = 0.1, kLeast_s = 0.05;
  const double used_s = std::max(answer.result.result.planning_time_s, answer.roundtrip_time_s);
  const double unused_s = time_limit_s - used_s;
  return unused_s > kShare * time_limit_s + kLeast_s ? unused_s : 0;
}

/// In the place of a path that was not improved before the limit came: as in hand by then. What it
/// costs whoever was to improve it is left open, and with it what is proven.
void TakePath(const PlanResultMessage& first, double time_limit_s, PlanResultMessage* answer) {
  const PlanResult& found = first.result;
  PlanResult& result = answer->result;
  result.status = PlanStatus::kSolved;
  // One that took too long stays so.
  result.planning_time_s =
      std::max(found.planning_time_s, std::min(result.planning_time_s, time_limit_s));
  answer->joint_names = first.joint_names;
  result.path = found.path;
  result.simplified_path = found.simplified_path;
  result.phases.simplification_s = found.phases.simplification_s;
  result.cost = result.epsilon = 0;
  result.progress.clear();
}

/// The record of a run of whose paths one has no verdict: as of one that was not asked for, to be
/// made again. `refusal`: the scene server's own word, unless it failed.
RunRecordMessage Unjudged(RunRecordMessage record, const std::string& why,
                          PathCheckReplyMessage refusal = {}) {
  record.status = PlanStatus::kNoAnswer;
  record.message = "no verdict on its path: " + why;
  record.roundtrip_time_s = 0;
  record.result = {};
  record.path_check = std::move(refusal);
  spdlog::error("{}: {}", record.request_id, record.message);
  return record;
}

/// Tells of such a path what it costs by its length, once the referee has told that.
void TellLength(const PathVerdict& verdict, bool anytime, PlanResult* result) {
  result->cost = FindMeasure(verdict.measures, "path_length").value_or(0);
  if (!anytime) return;
  PlanProgress& only = result->progress.emplace_back();
  only.elapsed_s = result->planning_time_s;
  only.cost = result->cost;
}

}  // namespace

RunExecutor::RunExecutor(Bus* bus, NodeRegistry* registry, SessionConditions conditions,
                         KernelFolders kernel, std::vector<Contestant> first_planners,
                         std::optional<SupervisedServer> server, ServerPatience patience)
    : registry_(registry),
      conditions_(std::move(conditions)),
      first_planners_(std::move(first_planners)),
      kernel_(std::move(kernel)),
      scene_server_(bus, registry, &conditions_, std::move(server), patience) {}

std::vector<pid_t> RunExecutor::PidsOf(const std::vector<PlannerClient*>& planners) const {
  std::vector<pid_t> pids;
  for (const PlannerClient* planner : planners) {
    const auto node = registry_->FindNode(planner->planner(), NodeKind::kPlanner);
    if (!node || !IsSeenHere(*node)) return {};
    pids.push_back(static_cast<pid_t>(node->status.pid));
  }
  return pids;
}

std::vector<ScheduledRun> RunExecutor::RequestsOf(const ScheduledRun& run) const {
  std::vector<ScheduledRun> requests = {run};
  if (const std::string& first = ContestantOf(run).first_path_of; !first.empty()) {
    requests.insert(requests.begin(), run);
    requests.front().planner = first;
    requests.front().request_id += "/first-path";
  }
  return requests;
}

bool RunExecutor::AreCheckedAlike(const PlanRequest& first, const std::string& first_planner,
                                  const PlanRequest& second,
                                  const std::string& second_planner) const {
  const auto edges_of = [this](const PlanRequest& request, const std::string& planner) {
    const auto node = registry_->Find(planner, NodeKind::kPlanner);
    return DescribeEdges(request.edge_check, request.edge_resolution_m,
                         node ? node->settings : std::map<std::string, std::string>());
  };
  return first.collision_model == second.collision_model &&
         edges_of(first, first_planner) == edges_of(second, second_planner);
}

RunExecutor::Asked RunExecutor::Ask(const ScheduledRun& run, const ProblemMessage& problem,
                                    const std::vector<PlannerClient*>& planners,
                                    PlanRequest* request,
                                    const std::function<bool()>& interrupted) const {
  if (planners.size() == 1) return {AnswerOf(planners[0], *request, interrupted), false};
  const std::string &finder = planners[0]->planner(), &improver = planners[1]->planner();
  PlanRequest first_request = RequestOf(RequestsOf(run).front(), problem);
  // Simplified, if paths are, since it may come to be the answer.
  first_request.anytime = false;
  PlannerClient::Answer first = AnswerOf(planners[0], first_request, interrupted);
  PlanResult& found = first.result.result;
  if (first.outcome != PlannerClient::Outcome::kResult || !found.Solves()) {
    for (std::string* message : {&first.message, &found.message}) {
      if (!message->empty()) *message = finder + ": " + *message;
    }
    return {first, false};
  }
  // Until it is the answer nothing of its simplification counts.
  const double simplification_s = found.phases.simplification_s;
  first.roundtrip_time_s = std::max(found.total_time_s, first.roundtrip_time_s - simplification_s);
  found.counters[kFirstPathTime] = HandedOverAfter(found);
  PlanRequest rest = *request;
  rest.time_limit_s -= HandedOverAfter(found);
  PlannerClient::Answer answer = first;
  PlanResult& result = answer.result.result;
  if (rest.time_limit_s > 0) {
    request->initial_joint_names = rest.initial_joint_names = first.result.joint_names;
    request->initial_path = rest.initial_path = found.path;
    answer = AnswerOf(planners[1], rest, interrupted);
    // A planner that could not be asked for its part was not asked for the run (asked_runs.h).
    if (answer.roundtrip_time_s == 0) return {answer, false};
    const double unused_s = LeftUnused(answer, rest.time_limit_s);
    answer.roundtrip_time_s += first.roundtrip_time_s;
    if (answer.outcome != PlannerClient::Outcome::kResult) return {answer, false};
    AddBefore(found, &result);
    if (result.status != PlanStatus::kTimedOut) return {answer, false};
    if (unused_s > 0) {
      result.message =
          fmt::format("'{}' ended with {:.3g} of {:.3g} s unused{}{}", improver, unused_s,
                      rest.time_limit_s, result.message.empty() ? "" : ": ", result.message);
      return {answer, false};
    }
  } else {
    result.status = PlanStatus::kTimedOut;
    result.planning_time_s = HandedOverAfter(found);
    result.path = result.simplified_path = {};
    result.phases.simplification_s = result.cost = result.epsilon = 0;
  }
  const std::string too_late = fmt::format("'{}' had {:.3g} s left, and no path by then", improver,
                                           std::max(rest.time_limit_s, 0.0));
  if (!AreCheckedAlike(first_request, finder, *request, improver)) {
    // Nobody has claimed that the path is free by what the referee judges it by.
    result.message = fmt::format(
        "{}; that of '{}' was found with another collision model or edge check", too_late, finder);
    return {answer, false};
  }
  result.message = fmt::format("the path of '{}': {}", finder, too_late);
  TakePath(first.result, request->time_limit_s, &answer.result);
  answer.roundtrip_time_s += simplification_s;
  return {answer, true};
}

const Contestant& RunExecutor::ContestantOf(const ScheduledRun& run) const {
  for (const std::vector<Contestant>* planners : {&conditions_.contestants, &first_planners_}) {
    const auto found = std::find_if(planners->begin(), planners->end(), [&](const Contestant& one) {
      return one.planner == run.planner;
    });
    if (found != planners->end()) return *found;
  }
  throw std::logic_error("no contestant '" + run.planner + "'");
}

PlanRequest RunExecutor::RequestOf(const ScheduledRun& run, const ProblemMessage& problem) const {
  const Contestant& contestant = ContestantOf(run);
  PlanRequest request = conditions_.request;
  request.request_id = UniqueId(run.request_id);
  request.scene_id = problem.scene_id;
  request.group = problem.group;
  request.start = problem.start;
  request.goal = problem.goal;
  request.direction = run.direction;
  request.seed = run.seed;
  request.collision_model = contestant.collision_model.value();
  request.edge_resolution_m = contestant.edge_resolution_m;
  request.edge_check = contestant.edge_check;
  return request;
}

bool RunExecutor::WarmUp(const ScheduledRun& run, double time_limit_s, PlannerClient* planner,
                         const std::function<bool()>& interrupted) {
  const std::optional<ProblemMessage> problem =
      scene_server_.FetchProblem(run.problem_set, run.problem_index, interrupted);
  if (!problem) return false;
  if (!problem->ok) return true;  // the run will say so
  for (int process = 0; process < 2; ++process) {
    PlanRequest request = RequestOf(run, *problem);
    request.request_id += "/warm-up";
    request.seed = RunSeed(run.seed, run.problem_set, run.problem_index, run.direction, run.trial);
    request.anytime = false;  // of which who finds first paths need not be capable
    request.time_limit_s = std::min(request.time_limit_s, time_limit_s);
    const PlannerClient::Answer answer = planner->Solve(request, interrupted);
    if (answer.outcome == PlannerClient::Outcome::kInterrupted) return false;
    if (answer.outcome == PlannerClient::Outcome::kResult) break;
    spdlog::warn("{}: no result to the warm-up request {}, which goes before its first run: {}",
                 run.planner, request.request_id, answer.message);
    if (answer.outcome == PlannerClient::Outcome::kRefused) break;
    planner->AwaitPlanner(interrupted);
    if (!planner->IsCold()) break;
  }
  return true;
}

std::optional<RunRecordMessage> RunExecutor::Execute(const ScheduledRun& run,
                                                     const std::vector<PlannerClient*>& planners,
                                                     const std::function<bool()>& interrupted) {
  // The server's answer also hands out the scene. Once is enough: a planner that has come up since
  // asks for it, and sending it again before each request would be in the request's way. That it
  // was asked when the session began does not spare it: planners keep the last few scenes only, and
  // a server that was started again since reads this problem, not all of them for one scene.
  const std::optional<ProblemMessage> problem =
      scene_server_.FetchProblem(run.problem_set, run.problem_index, interrupted);
  if (!problem) return std::nullopt;

  RunRecordMessage record;
  record.run_id = conditions_.request.run_id;
  record.request_id = run.request_id;
  record.planner = run.planner;
  record.problem_set = run.problem_set;
  record.problem_index = run.problem_index;
  record.trial = run.trial;
  record.contestant = ContestantOf(run).name;
  record.request = RequestOf(run, *problem);
  // The run begins when its planners are there to be asked.
  if (problem->ok) {
    for (PlannerClient* planner : planners) planner->AwaitPlanner(interrupted);
    if (interrupted()) return std::nullopt;
  }
  record.start_utime = NowUtime();
  if (!problem->ok) {
    record.status = PlanStatus::kInvalidRequest;
    record.message = "no problem: " + problem->message;
    spdlog::error("{}: {}", run.request_id, record.message);
    return record;
  }

  const DisturbanceMeter meter(PidsOf(planners), kernel_);
  const auto [answer, is_first_path] = Ask(run, *problem, planners, &record.request, interrupted);
  // Whatever the answer: its planner may have been told to end before this process was.
  if (interrupted()) return std::nullopt;
  switch (answer.outcome) {
    case PlannerClient::Outcome::kInterrupted:
      return std::nullopt;
    case PlannerClient::Outcome::kRefused:
      record.status = PlanStatus::kInvalidRequest;
      record.roundtrip_time_s = answer.roundtrip_time_s;
      record.message = "refused: " + answer.message;
      return record;
    case PlannerClient::Outcome::kNoAnswer:
      record.status = PlanStatus::kNoAnswer;
      record.roundtrip_time_s = answer.roundtrip_time_s;
      record.message = answer.message;
      if (answer.roundtrip_time_s > 0) {
        spdlog::error("{}: no answer: {}", run.request_id, answer.message);
      } else {
        unasked_.Add(run.request_id, run.planner, answer.message);
      }
      return record;
    case PlannerClient::Outcome::kResult:
      break;
  }
  record.roundtrip_time_s = answer.roundtrip_time_s;
  record.result = answer.result;
  meter.Read(record.roundtrip_time_s, &record.result.result.counters);
  record.status = answer.result.result.status;
  record.message = answer.result.result.message;
  if (record.status != PlanStatus::kSolved) return record;
  if (answer.overdue) {  // whatever it says of its time
    record.status = PlanStatus::kTimedOut;
    record.message =
        fmt::format("a path came {:.1f} s after it was asked for, the limit being {} s",
                    answer.roundtrip_time_s, record.request.time_limit_s);
    spdlog::warn("{}: {}", run.request_id, record.message);
    return record;
  }
  if (const double time_s = record.result.result.planning_time_s;
      IsLate(time_s, record.request.time_limit_s)) {
    record.status = PlanStatus::kTimedOut;
    record.message = fmt::format(
        "the planner says that its path is late: the search took {:.6g} s, the limit being {} s",
        time_s, record.request.time_limit_s);
    spdlog::warn("{}: {}", run.request_id, record.message);
    return record;
  }

  const auto check =
      scene_server_.Judge(run.request_id + "/raw", record.result.result.path, record, interrupted);
  if (!check) return std::nullopt;
  // No fault of the planner's: what is, the referee calls an invalid path.
  if (!check->ok) {
    const bool is_failure =
        !scene_server_.WhyPassedOver({run.problem_set, run.problem_index}).empty();
    return Unjudged(std::move(record), check->message,
                    is_failure ? PathCheckReplyMessage() : *check);
  }
  if (!check->verdict) return Unjudged(std::move(record), "the scene server gave none");
  record.path_check = *check;
  if (is_first_path) TellLength(*check->verdict, record.request.anytime, &record.result.result);
  if (!check->verdict->valid) {
    record.status = PlanStatus::kInvalidPath;
    record.message = check->verdict->reason;
    spdlog::warn("{}: invalid path: {}", run.request_id, record.message);
  }
  if (!record.result.result.simplified_path.empty()) {
    const auto simplified_check = scene_server_.Judge(
        run.request_id + "/simplified", record.result.result.simplified_path, record, interrupted);
    if (!simplified_check) return std::nullopt;
    // One that is only refused leaves the run what its raw path made it.
    const std::string why = simplified_check->ok
                                ? ""
                                : scene_server_.WhyPassedOver({run.problem_set, run.problem_index});
    if (!why.empty()) return Unjudged(std::move(record), why);
    record.simplified_check = *simplified_check;
  }
  return record;
}

}  // namespace planbench
