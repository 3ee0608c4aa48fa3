#include "benchmark_driver/planner_client.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "benchmark_driver/local_process.h"
#include "messaging/session_conditions.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll{50};
constexpr std::chrono::milliseconds kAbsencePoll{100};
/// How long one that was told to end may be away before it is said what is waited for.
constexpr std::chrono::milliseconds kShortAbsence{5000};

}  // namespace

PlannerClient::PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner)
    : PlannerClient(bus, registry, planner, Terms()) {}

PlannerClient::PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner,
                             Terms terms)
    : bus_(bus),
      registry_(registry),
      planner_(planner),
      channels_(planner),
      terms_(std::move(terms)),
      acks_(bus->SubscribeFrom<PlanAckMessage>(
          channels_.ack,
          [this](const PlanAckMessage& ack, const Origin& origin) { OnAck(ack, origin); })),
      results_(bus->SubscribeFrom<PlanResultMessage>(
          channels_.result,
          [this](const PlanResultMessage& result, const Origin& origin) {
            OnResult(result, origin);
          },
          [this](const MessageError& error, const Origin& origin) {
            OnBadResult(error, origin);
          })) {}

void PlannerClient::OnAck(const PlanAckMessage& ack, const Origin& origin) {
  const auto process = registry_->Find(planner_, NodeKind::kPlanner);
  Add(RequestExchange::Acknowledgement{ack, process ? process->request_id : ""}, origin.sender,
      channels_.ack);
}

std::string PlannerClient::WhyUnusable(const PlanResultMessage& result) const {
  if (result.planner != planner_ || result.run_id != run_id_) {
    return fmt::format("it is of planner '{}' in session '{}'", result.planner, result.run_id);
  }
  const bool solved = result.result.status == PlanStatus::kSolved;
  if (solved == result.result.path.empty()) {
    return fmt::format("its status is {}, but it has {} path", EnumName(result.result.status),
                       solved ? "no" : "a");
  }
  const std::string fault = WhyTooLong(result.result.path);
  return fault.empty() ? WhyTooLong(result.result.simplified_path) : fault;
}

void PlannerClient::OnResult(const PlanResultMessage& result, const Origin& origin) {
  RequestExchange::Event event = RequestExchange::ArrivedResult{result, origin.arrival};
  {
    const std::scoped_lock lock(mutex_);
    if (first_result_ && first_result_->request_id == result.request_id) {
      if (*first_result_ == result) return;
      bus_->contradictions().Note(origin.sender, channels_.result,
                                  "another result of " + result.request_id + " than before");
      return;
    }
    if (std::string why = WhyUnusable(result); !why.empty()) {
      event = RequestExchange::UnusableResult{result.request_id, std::move(why)};
    }
  }
  Add(std::move(event), origin.sender, channels_.result, &result);
}

void PlannerClient::OnBadResult(const MessageError& error, const Origin& origin) {
  Add(RequestExchange::UnusableResult{error.request_id(), error.what()}, origin.sender,
      channels_.result);
  throw error;  // for the bus to log
}

void PlannerClient::Add(RequestExchange::Event event, const PacketSender& sender,
                        const std::string& channel, const PlanResultMessage* result) {
  const bool is_believed = registry_->Believes(sender, NodeKind::kPlanner, planner_, channel);
  const std::scoped_lock lock(mutex_);
  if (!asked_) return;
  if (!is_believed || *asked_ != sender) {
    // Once: however much a stranger sends, the planner is listened to.
    if (std::exchange(has_refused_, true)) return;
    event = RequestExchange::RefusedMessage{
        fmt::format("what came on {} from {}, as '{}', which was asked, sends from {}", channel,
                    sender.Text(), planner_, asked_->Text())};
  } else if (result != nullptr && result->request_id == request_id_) {
    first_result_ = *result;
  }
  messages_.push_back(std::move(event));
  changed_.notify_all();
}

std::optional<RequestExchange::Event> PlannerClient::NextMessage(TimePoint until) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, until, [this] { return !messages_.empty(); });
  if (messages_.empty()) return std::nullopt;
  RequestExchange::Event message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

bool PlannerClient::HasEnded(const NodeStatusMessage& process) const {
  return process.instance == seen_here_.instance && !IsRunning(process.pid);
}

bool PlannerClient::IsOver(const NodeStatusMessage& process) const {
  return process.instance == told_to_end_ || HasEnded(process);
}

bool PlannerClient::IsCold() const {
  const auto process = ToBeAsked();
  return process && process->instance != warm_;
}

std::optional<NodeStatusMessage> PlannerClient::ToBeAsked() const {
  if (!WhyGivenUp().empty()) return std::nullopt;
  auto node = Live();
  if (!node || !ReasonNotToAsk(node->status).empty()) return std::nullopt;
  return std::move(node->status);
}

bool PlannerClient::ExpectAnother() {
  if (!WhyGivenUp().empty()) return false;
  const auto node = Live();
  // It may be silent only, and would then go on where it was.
  if (!node && IsOver(seen_here_)) return false;
  told_to_end_ = node ? node->status.instance : seen_here_.instance;
  unanswered_limit_ = std::chrono::milliseconds(0);
  return true;
}

std::optional<NodeRegistry::Node> PlannerClient::Live() const {
  for (NodeRegistry::Node& node : registry_->LiveNodes(NodeKind::kPlanner)) {
    if (node.status.name == planner_ && !IsOver(node.status)) return std::move(node);
  }
  return std::nullopt;
}

std::optional<NodeRegistry::Node> PlannerClient::WaitUntilLive(
    const std::function<bool()>& interrupted) {
  const std::chrono::milliseconds patience = terms_.patience + unanswered_limit_;
  const double patience_s = std::chrono::duration<double>(patience).count();
  // Not by the clock, which goes on while this process is stopped.
  std::chrono::milliseconds waited{0};
  while (!interrupted() && WhyGivenUp().empty()) {
    if (auto node = Live()) {
      told_to_end_.reset();
      return node;
    }
    const auto heard = registry_->Find(planner_, NodeKind::kPlanner);
    if (heard && HasEnded(*heard)) registry_->Forget(*heard);
    if (waited >= patience) {
      const std::string why =
          heard && heard->instance == told_to_end_
              ? fmt::format(
                    "its process (pid {}) was told to end, to be started anew, and is on "
                    "the bus {:g} s later",
                    heard->pid, patience_s)
              : fmt::format("it was not on the bus for {:g} s", patience_s);
      given_up_ = "given up: " + why;
      terms_.on_absence(why);
      break;
    }
    if (waited == (told_to_end_ ? kShortAbsence : waited.zero())) {
      spdlog::warn("waiting for the planner '{}' to come (back) to the bus, {:g} s at most",
                   planner_, patience_s);
    }
    registry_->WaitUntil(
        [&] { return interrupted() || !WhyGivenUp().empty() || Live().has_value(); }, kAbsencePoll);
    waited += kAbsencePoll;
  }
  return std::nullopt;
}

std::string PlannerClient::ReasonNotToAsk(const NodeStatusMessage& process) const {
  if (!terms_.expected) return "";
  const auto difference = FindConditionDifference(*terms_.expected, process);
  if (!difference) return "";
  return fmt::format(
      "not asked, since '{}' has come back as another than the session began with: {} is {}, was "
      "{}",
      planner_, difference->field, difference->second, difference->first);
}

PlannerClient::Answer PlannerClient::Solve(const PlanRequest& request,
                                           const std::function<bool()>& interrupted) {
  const std::optional<NodeRegistry::Node> process = WaitUntilLive(interrupted);
  const std::string reason = process ? ReasonNotToAsk(process->status) : WhyGivenUp();
  if (interrupted() || (!process && reason.empty())) return {.outcome = Outcome::kInterrupted};
  if (!reason.empty()) return {.outcome = Outcome::kNoAnswer, .message = reason};
  seen_here_ = IsSeenHere(*process) ? process->status : NodeStatusMessage();
  const auto look_around = [&]() -> RequestExchange::Event {
    if (interrupted()) return RequestExchange::Interruption{};
    // Before it is asked again: what it died of would reach its successor.
    if (HasEnded(process->status)) {
      // That of a shell in which it ran is known a little later.
      const std::string how = terms_.how_ended(process->since);
      return RequestExchange::PlannerLost{how.empty() ? "the process ended"
                                                      : fmt::format("the process ended {}", how)};
    }
    const auto now = Live();
    if (!now) return RequestExchange::PlannerLost{"the process died or fell silent"};
    if (now->status.instance != process->status.instance) {
      return RequestExchange::PlannerLost{"the process was restarted"};
    }
    return RequestExchange::Tick{};
  };
  {
    const std::scoped_lock lock(mutex_);
    asked_ = process->sender;
    run_id_ = request.run_id;
    request_id_ = request.request_id;
    messages_.clear();
    has_refused_ = false;
  }
  RequestExchange exchange(request.request_id, request.time_limit_s, Clock::now());
  RequestExchange::Event event = RequestExchange::Tick{};
  while (true) {
    RequestExchange::Step step = exchange.Take(Clock::now(), event);
    if (step.answer) {
      const Outcome outcome = step.answer->outcome;
      unanswered_limit_ = std::chrono::milliseconds(0);
      if (outcome == Outcome::kResult || outcome == Outcome::kNoAnswer) {
        warm_ = process->status.instance;
      }
      if (outcome == Outcome::kNoAnswer) {
        if (!HasEnded(process->status)) {
          unanswered_limit_ = std::chrono::ceil<std::chrono::milliseconds>(
              std::chrono::duration<double>(request.time_limit_s));
        }
        // Whoever may still come to it, one that was started again perhaps, need not.
        bus_->Publish(channels_.cancel, PlanCancelMessage{request.request_id});
      }
      const std::scoped_lock lock(mutex_);
      asked_.reset();
      return *std::move(step.answer);
    }
    if (step.send_request) bus_->Publish(channels_.request, request);
    if (step.send_cancel) bus_->Publish(channels_.cancel, PlanCancelMessage{request.request_id});
    const TimePoint until = std::min(exchange.NextSend(), Clock::now() + kPoll);
    std::optional<RequestExchange::Event> message = NextMessage(until);
    event = message ? *std::move(message) : look_around();
  }
}

}  // namespace planbench
