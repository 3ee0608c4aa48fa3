#include "benchmark_driver/planner_client.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kResendPeriod{500};
constexpr std::chrono::milliseconds kCancelPeriod{200};
constexpr std::chrono::milliseconds kPoll{50};

}  // namespace

PlannerClient::PlannerClient(Bus* bus, NodeRegistry* registry, const std::string& planner)
    : bus_(bus),
      registry_(registry),
      planner_(planner),
      channels_(planner),
      acks_(bus->Subscribe<PlanAckMessage>(channels_.ack,
                                           [this](const PlanAckMessage& ack) {
                                             const std::scoped_lock lock(mutex_);
                                             if (ack.request_id != request_id_) return;
                                             ack_ = ack;
                                             changed_.notify_all();
                                           })),
      results_(bus->SubscribeTimed<PlanResultMessage>(
          channels_.result,
          [this](const PlanResultMessage& result, Clock::time_point arrival) {
            // Also results of former requests (whose acknowledgement was lost) are to be silenced.
            bus_->Publish(channels_.result_ack, AckMessage{result.request_id, "driver", true, ""});
            const std::scoped_lock lock(mutex_);
            if (result.request_id != request_id_ || result_) return;
            result_ = result;
            result_arrival_ = arrival;
            changed_.notify_all();
          },
          [this](const MessageError& error) {
            if (error.request_id().empty()) throw error;
            bus_->Publish(channels_.result_ack,
                          AckMessage{error.request_id(), "driver", false, error.what()});
            const std::scoped_lock lock(mutex_);
            if (error.request_id() != request_id_) return;
            unusable_result_ = error.what();
            changed_.notify_all();
          })) {}

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
  Answer answer;
  const std::optional<NodeStatusMessage> incarnation = WaitUntilLive(interrupted);
  if (!incarnation) {
    answer.outcome = Outcome::kInterrupted;
    return answer;
  }
  std::unique_lock lock(mutex_);
  request_id_ = request.request_id;
  ack_.reset();
  result_.reset();
  unusable_result_.clear();
  Clock::time_point sent = Clock::now();  // first transmission since the planner was last busy
  bool was_busy = true;
  Clock::time_point next_send = sent;
  Clock::time_point last_sign = sent;  // of the planner's having heard us
  std::optional<Clock::time_point> accepted;
  std::optional<Clock::time_point> cancelled;          // because it was overdue
  std::optional<Clock::time_point> interrupted_since;  // and cancelled for that
  Clock::time_point next_cancel = sent;
  const auto limit = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(request.time_limit_s));
  while (true) {
    if (interrupted_since && (result_ || Clock::now() - *interrupted_since > kCancelPatience)) {
      answer.outcome = Outcome::kInterrupted;
      break;
    }
    // A request that was cancelled when this session was interrupted before is solved when it comes
    // again; the result that its planner may still repeat is of the former time.
    if (result_ && !accepted && !ack_ && result_->result.status == PlanStatus::kCancelled) {
      result_.reset();
    }
    if (result_) {
      answer.outcome = Outcome::kResult;
      answer.result = *std::move(result_);
      answer.roundtrip_time_s =
          std::chrono::duration<double>(std::max(result_arrival_, sent) - sent).count();
      break;
    }
    if (!unusable_result_.empty()) {
      answer.message = "the result cannot be used: " + unusable_result_;
      break;
    }
    if (ack_) {
      using Verdict = PlanAckVerdict;
      if (ack_->verdict == Verdict::kRefused) {
        answer.outcome = Outcome::kRefused;
        answer.message = ack_->message;
        break;
      }
      last_sign = Clock::now();
      if (ack_->verdict == Verdict::kAccepted && !accepted) accepted = last_sign;
      if (ack_->verdict == Verdict::kBusy) was_busy = true;
      ack_.reset();
    }
    const Clock::time_point now = Clock::now();
    if (!accepted && now - last_sign > kAckTimeout) {
      answer.message = "no acknowledgement within " + std::to_string(kAckTimeout.count()) + " s";
      break;
    }
    if (accepted && !cancelled && now - *accepted > limit + kResultGrace) {
      spdlog::warn("{} is overdue; cancelling it", request.request_id);
      cancelled = now;
    }
    if (cancelled && now - *cancelled > kResultGrace) {
      answer.message = "no result, though live, " + std::to_string(2 * kResultGrace.count()) +
                       " s after the time limit";
      break;
    }
    // Until the result comes: a cancellation may be lost, too.
    if ((cancelled || interrupted_since) && now >= next_cancel) {
      bus_->Publish(channels_.cancel, PlanCancelMessage{request.request_id});
      next_cancel = now + kCancelPeriod;
    }
    if (!accepted && !interrupted_since && now >= next_send) {
      lock.unlock();
      next_send = Clock::now() + kResendPeriod;
      if (std::exchange(was_busy, false)) sent = Clock::now();
      bus_->Publish(channels_.request, request);
      lock.lock();
    }
    if (!result_ && !ack_) changed_.wait_for(lock, kPoll);
    if (result_) continue;
    lock.unlock();
    const bool stop = interrupted();
    const auto status = registry_->Find(planner_, NodeKind::kPlanner);
    lock.lock();
    if (result_) continue;
    if (stop && !interrupted_since) interrupted_since = Clock::now();
    if (!status || status->start_utime != incarnation->start_utime) {
      if (interrupted_since) {
        answer.outcome = Outcome::kInterrupted;
        break;
      }
      answer.message = !status ? "the process died or fell silent" : "the process was restarted";
      break;
    }
  }
  if (answer.outcome == Outcome::kNoAnswer) {
    answer.roundtrip_time_s = std::chrono::duration<double>(Clock::now() - sent).count();
  }
  request_id_.clear();
  return answer;
}

}  // namespace planbench
