#include "benchmark_driver/scene_server_client.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <stdexcept>

#include "common/random_id.h"
#include "messaging/channels.h"
#include "results/session_plan.h"

namespace planbench {
namespace {

// Short, for a scene server that has just been started again; a repeated request is not worked on
// twice.
constexpr std::chrono::milliseconds kServerRetry{250};
constexpr std::chrono::milliseconds kTurnPoll{50};
/// How often a problem is asked for that the server had before the first run and now denies.
constexpr int kProblemAttempts = 3;

/// Of how many failures of the scene server a problem is the cause; one may be another's doing.
constexpr int kServerFailures = 2;

/// At how many problems in succession the scene server fails if the cause is in itself.
constexpr std::size_t kProblemsFailedAt = 3;

/// Of a scene server that was started by hand and has answered nothing yet.
constexpr char kMayNotHear[] =
    "; it has answered nothing yet: if it is not at work, it does not hear this process, though "
    "this one hears it: ttl=0 in one --lcm-url, or a firewall, may be why, and bus_doctor on both "
    "machines tells more";

std::function<bool(const PacketSender&)> ServersOnly(NodeRegistry* registry,
                                                     const std::string& channel) {
  return [=](const PacketSender& sender) {
    return registry->Believes(sender, NodeKind::kSceneServer, "", channel);
  };
}

}  // namespace

SceneServerClient::SceneServerClient(Bus* bus, NodeRegistry* registry,
                                     const SessionConditions* conditions,
                                     std::optional<SupervisedServer> server,
                                     ServerPatience patience)
    : registry_(registry),
      conditions_(conditions),
      server_(std::move(server)),
      patience_(patience),
      problems_{{bus, channel::kProblemRequest, channel::kProblem,
                 ServersOnly(registry, channel::kProblem)},
                {}},
      path_checks_{{bus, channel::kPathCheckRequest, channel::kPathCheckReply,
                    ServersOnly(registry, channel::kPathCheckReply)},
                   {}} {}

std::optional<SceneServerClient::Turn> SceneServerClient::TakeTurn(
    const ProblemKey& problem, const std::function<bool()>& interrupted) {
  Turn turn;
  turn.lock = std::unique_lock(turn_, std::defer_lock);
  while (!turn.lock.try_lock_for(kTurnPoll)) {
    if (interrupted()) return std::nullopt;
  }
  turn.problem = problem;
  turn.failures_before = FailuresIn(&turn);
  return turn;
}

int SceneServerClient::FailuresIn(Turn* turn) const {
  if (server_) return server_->failures() - turn->failures_before;
  for (const NodeStatusMessage& server : registry_->Live(NodeKind::kSceneServer)) {
    const std::string before = std::exchange(turn->server, server.instance);
    turn->num_new_servers += !before.empty() && before != server.instance;
  }
  return turn->num_new_servers;
}

template <typename Request, typename Reply>
std::optional<Reply> SceneServerClient::AskServer(Service<Request, Reply>* service,
                                                  const Request& request, Turn* turn,
                                                  const std::string& what,
                                                  const std::string& advice,
                                                  const std::function<bool()>& interrupted) {
  const int failures_before = FailuresIn(turn);
  const auto fails = [&] { return FailuresIn(turn) >= kServerFailures; };
  std::chrono::milliseconds waited{0}, without_server{0};
  const std::string reach = server_ || has_answered_ ? "" : kMayNotHear;
  while (!interrupted()) {
    std::string why = WhyPassedOver(turn->problem);
    if (why.empty() && fails()) {
      why = "twice the scene server died or fell silent when it was asked for " + what;
      PassOver(*turn, why, &service->failed_at);
    } else if (why.empty() && waited >= patience_.until_passed_over) {
      why = fmt::format("the scene server did not answer within {:g} s when it was asked for {}",
                        std::chrono::duration<double>(waited).count(), what);
      if (!server_) {
        throw std::runtime_error(
            why +
            ", and whatever else it is asked for waits behind that: start it again, and if "
            "it comes to that once more, leave the problem out (--problems-range)" +
            reach);
      }
      server_->start_again();
      PassOver(*turn, why, &service->failed_at);
    }
    if (!why.empty()) {
      Reply none;
      none.ok = false;
      none.message = why;
      return none;
    }
    if (auto reply = service->client.Call(request, kServerRetry, patience_.until_told,
                                          [&] { return interrupted() || fails(); })) {
      has_answered_ = true;
      // One that came in the place of another may know nothing of the scene: no answer to this.
      const bool is_answer = reply->ok || FailuresIn(turn) == failures_before;
      if (is_answer) service->failed_at.clear();
      if (is_answer || !fails()) return reply;
    }
    if (interrupted() || fails()) continue;
    const bool is_live = !registry_->Live(NodeKind::kSceneServer).empty();
    // Not by the clock, which goes on while this process is stopped.
    waited += patience_.until_told;
    without_server = is_live ? std::chrono::milliseconds(0) : without_server + patience_.until_told;
    if (without_server >= patience_.until_given_up) {
      throw std::runtime_error(
          fmt::format("no scene server has been live for {:g} s, though {} is waited for",
                      std::chrono::duration<double>(without_server).count(), what));
    }
    spdlog::warn("waiting for {} from the scene server ({})", what,
                 is_live ? "it is live, but silent" + advice + reach : "no scene server is live");
  }
  return std::nullopt;
}

void SceneServerClient::PassOver(const Turn& turn, const std::string& why,
                                 std::set<std::string>* failed_at) {
  {
    const std::scoped_lock lock(mutex_);
    passed_over_[turn.problem] = why;
  }
  failed_at->insert(LeftOutName(turn.problem.first, turn.problem.second));
  if (failed_at->size() < kProblemsFailedAt) return;
  throw std::runtime_error(
      fmt::format("the scene server fails whatever it is asked for: at {}, and it answered nothing "
                  "between; {}; mend what it fails at, or, if it is these, choose others "
                  "(--problems-range)",
                  fmt::join(*failed_at, ", "), why));
}

std::string SceneServerClient::WhyPassedOver(const ProblemKey& problem) {
  const std::scoped_lock lock(mutex_);
  const auto found = passed_over_.find(problem);
  return found == passed_over_.end() ? "" : found->second;
}

std::optional<ProblemMessage> SceneServerClient::AskForProblem(
    const std::string& set, int index, const std::function<bool()>& interrupted) {
  std::optional<Turn> turn = TakeTurn({set, index}, interrupted);
  return turn ? AskForProblem(&*turn, interrupted) : std::nullopt;
}

std::optional<ProblemMessage> SceneServerClient::AskForProblem(
    Turn* turn, const std::function<bool()>& interrupted) {
  const auto& [set, index] = turn->problem;
  ProblemRequestMessage request;
  request.request_id = UniqueId(fmt::format("{}/{}/{}", conditions_->request.run_id, set, index));
  request.problem_set = set;
  request.problem_index = index;
  std::optional<ProblemMessage> problem = AskServer(
      &problems_, request, turn, "the problem " + LeftOutName(set, index), "", interrupted);
  if (problem && problem->ok && (problem->problem_set != set || problem->problem_index != index)) {
    problem->ok = false;
    problem->message = fmt::format("the scene server gave problem {} {} where {} {} was asked for",
                                   problem->problem_set, problem->problem_index, set, index);
  }
  if (!problem || !problem->ok) return problem;
  const std::scoped_lock lock(mutex_);
  const ProblemMessage& first = problems_first_.emplace(turn->problem, *problem).first->second;
  if (const std::string_view part = ChangedPart(first, *problem); !part.empty()) {
    problem->ok = false;
    problem->message = fmt::format(
        "its {} is another than before: the scene server was started again on other files", part);
  }
  return problem;
}

std::optional<ProblemMessage> SceneServerClient::FetchProblem(
    const std::string& set, int index, const std::function<bool()>& interrupted) {
  const ProblemKey key(set, index);
  {
    const std::scoped_lock lock(mutex_);
    const auto known = problems_known_.find(key);
    if (known != problems_known_.end() && !passed_over_.contains(key)) return known->second;
  }
  std::optional<ProblemMessage> problem;
  for (int attempt = 0; attempt < kProblemAttempts; ++attempt) {
    problem = AskForProblem(set, index, interrupted);
    if (!problem || problem->ok) break;
  }
  if (!problem || !problem->ok) return problem;
  const std::scoped_lock lock(mutex_);
  problems_known_[key] = *problem;
  return problem;
}

std::optional<PathCheckReplyMessage> SceneServerClient::Judge(
    const std::string& check_id, const Path& path, const RunRecordMessage& record,
    const std::function<bool()>& interrupted) {
  PathCheckRequestMessage request;
  request.scene_id = record.request.scene_id;
  request.group = record.request.group;
  request.start = record.request.start;
  request.goal = record.request.goal;
  request.joint_names = record.result.joint_names;
  request.path = path;
  request.collision_model = record.request.collision_model;
  request.step_m = conditions_->referee_step_m.value();
  request.with_clearance = conditions_->with_clearance;
  const std::string advice =
      fmt::format("; verdicts take less time with a larger --referee-step than {}{}",
                  request.step_m, request.with_clearance ? ", or with --no-clearance" : "");
  std::optional<Turn> turn = TakeTurn({record.problem_set, record.problem_index}, interrupted);
  if (!turn) return std::nullopt;
  for (bool has_scene = false;; has_scene = true) {
    const int failures_before = FailuresIn(&*turn);
    request.request_id = UniqueId(check_id);
    std::optional<PathCheckReplyMessage> reply = AskServer(
        &path_checks_, request, &*turn, "the verdict on " + check_id, advice, interrupted);
    const bool failed = FailuresIn(&*turn) > failures_before;
    if (!reply || reply->ok || (has_scene && !failed)) return reply;
    // A scene server that was restarted meanwhile does not know the scene: asking for the problem
    // loads it again.
    if (!AskForProblem(&*turn, interrupted)) return std::nullopt;
  }
}

}  // namespace planbench
