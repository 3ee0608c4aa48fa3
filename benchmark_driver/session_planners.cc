#include "benchmark_driver/session_planners.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/lookup.h"

namespace planbench {
namespace {

// What a planner does only once takes well below that.
constexpr double kWarmUpLimit = 1;  // s

}  // namespace

SessionPlanners::SessionPlanners(Bus* bus, NodeRegistry* registry, RunExecutor* executor,
                                 std::map<std::string, NodeStatusMessage> found,
                                 std::chrono::milliseconds patience,
                                 std::optional<int> problems_per_process,
                                 SupervisedPlanners supervised)
    : bus_(bus),
      registry_(registry),
      executor_(executor),
      found_(std::move(found)),
      patience_(patience),
      supervised_(std::move(supervised)),
      renewal_(problems_per_process, supervised_.start_anew) {}

std::optional<std::vector<PlannerClient*>> SessionPlanners::ReadyFor(
    const ScheduledRun& run, const std::function<bool()>& interrupted) {
  std::vector<PlannerClient*> ready;
  for (const ScheduledRun& request : executor_->RequestsOf(run)) {
    PlannerClient* const planner = ready.emplace_back(ClientOf(request.planner));
    renewal_.Renew(request.problem_set, request.problem_index, planner);
    planner->AwaitPlanner(interrupted);
    if (planner->IsCold() && !executor_->WarmUp(request, kWarmUpLimit, planner, interrupted)) {
      return std::nullopt;
    }
    NoteHost(request, *planner);
  }
  return ready;
}

void SessionPlanners::NoteHost(const ScheduledRun& run, const PlannerClient& planner) {
  const std::optional<NodeStatusMessage> process = planner.ToBeAsked();
  const std::string& first_host = found_.at(planner.planner()).host;
  if (!process || process->host == first_host) return;
  const std::scoped_lock lock(mutex_);
  const bool is_known = std::ranges::any_of(moves_, [&](const Move& move) {
    return move.process.name == process->name && move.process.host == process->host;
  });
  if (is_known) return;
  moves_.push_back(
      {*process, fmt::format("the planner '{}' was on {} and is on {} from {} on: its "
                             "times are not of one machine",
                             process->name, first_host, process->host, run.request_id)});
  spdlog::warn("{}", moves_.back().warning);
}

std::vector<SessionPlanners::Move> SessionPlanners::moves() const {
  const std::scoped_lock lock(mutex_);
  return moves_;
}

PlannerClient* SessionPlanners::ClientOf(const std::string& planner) {
  const std::scoped_lock lock(mutex_);
  std::unique_ptr<PlannerClient>& client = clients_[planner];
  if (!client) {
    client = std::make_unique<PlannerClient>(bus_, registry_, planner, TermsOf(planner));
  }
  return client.get();
}

void SessionPlanners::GiveUp(const std::string& planner, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  if (!given_up_.emplace(planner, reason).second) return;
  spdlog::error("the planner '{}' is given up, the others go on: {}", planner, reason);
}

std::map<std::string, std::string> SessionPlanners::given_up() const {
  const std::scoped_lock lock(mutex_);
  return given_up_;
}

std::string SessionPlanners::WhyGivenUp(const std::string& planner) const {
  const std::scoped_lock lock(mutex_);
  const std::optional<std::string> reason = Lookup(given_up_, planner);
  return reason ? "given up: " + *reason : "";
}

PlannerClient::Terms SessionPlanners::TermsOf(const std::string& planner) {
  PlannerClient::Terms terms;
  terms.expected = found_.at(planner);
  terms.given_up = [this, planner] { return WhyGivenUp(planner); };
  terms.patience = patience_;
  terms.on_absence = [this, planner](const std::string& why) { GiveUp(planner, why); };
  if (supervised_.how_ended) {
    terms.how_ended = [this, planner](auto since) { return supervised_.how_ended(planner, since); };
  }
  return terms;
}

}  // namespace planbench
