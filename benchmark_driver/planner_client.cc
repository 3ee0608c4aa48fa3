#include "benchmark_driver/planner_client.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll{50};

}  // namespace

PlannerClient::PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner)
    : bus_(bus),
      registry_(registry),
      planner_(planner),
      channels_(planner),
      acks_(bus->Subscribe<PlanAckMessage>(channels_.ack,
                                           [this](const PlanAckMessage& ack) { Add(ack); })),
      results_(bus->SubscribeTimed<PlanResultMessage>(
          channels_.result,
          [this](const PlanResultMessage& result, TimePoint arrival) {
            Add(RequestExchange::ArrivedResult{result, arrival});
          },
          [this](const MessageError& error) {
            Add(RequestExchange::UnusableResult{error.request_id(), error.what()});
            throw error;  // for the bus to log
          })) {}

void PlannerClient::Add(RequestExchange::Event event) {
  const std::scoped_lock lock(mutex_);
  if (!asking_) return;
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

std::optional<NodeStatusMessage> PlannerClient::WaitUntilLive(
    const std::function<bool()>& interrupted) {
  bool told = false;
  while (!interrupted()) {
    if (auto status = registry_->Find(planner_, NodeKind::kPlanner)) return status;
    if (!told) spdlog::warn("waiting for the planner '{}' to come (back) to the bus", planner_);
    told = true;
    registry_->WaitUntil(
        [&] { return interrupted() || registry_->Find(planner_, NodeKind::kPlanner).has_value(); },
        std::chrono::seconds(1));
  }
  return std::nullopt;
}

PlannerClient::Answer PlannerClient::Solve(const PlanRequest& request,
                                           const std::function<bool()>& interrupted) {
  const std::optional<NodeStatusMessage> incarnation = WaitUntilLive(interrupted);
  if (!incarnation) return {.outcome = Outcome::kInterrupted};
  const auto listen = [this](bool asking) {
    const std::scoped_lock lock(mutex_);
    asking_ = asking;
    messages_.clear();
  };
  const auto look_around = [&]() -> RequestExchange::Event {
    if (interrupted()) return RequestExchange::Interruption{};
    const auto status = registry_->Find(planner_, NodeKind::kPlanner);
    if (!status) return RequestExchange::PlannerLost{"the process died or fell silent"};
    if (status->start_utime != incarnation->start_utime) {
      return RequestExchange::PlannerLost{"the process was restarted"};
    }
    return RequestExchange::Tick{};
  };
  listen(true);
  RequestExchange exchange(request.request_id, request.time_limit_s, Clock::now());
  RequestExchange::Event event = RequestExchange::Tick{};
  while (true) {
    RequestExchange::Step step = exchange.Take(Clock::now(), event);
    if (step.answer) {
      listen(false);
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
