#include "benchmark_driver/request_exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace planbench {
namespace {

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

RequestExchange::RequestExchange(std::string request_id, double time_limit_s, TimePoint now)
    : request_id_(std::move(request_id)),
      time_limit_(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double>(time_limit_s))),
      begun_(now),
      sent_(now),
      next_send_(now),
      last_ack_(now) {}

RequestExchange::Step RequestExchange::Take(TimePoint now, const Event& event) {
  Step step;
  step.answer = Hear(now, event);
  if (!step.answer) step.answer = LosePatience(now);
  if (step.answer || now < next_send_) return step;
  next_send_ = now + kRepeatPeriod;
  step.send_cancel = Cancelling();
  step.send_request = !Cancelling();
  if (step.send_request && std::exchange(was_busy_, false)) sent_ = now;
  return step;
}

RequestExchange::Answer RequestExchange::End(Outcome outcome, std::string message,
                                             TimePoint now) const {
  if (interrupted_) return {.outcome = Outcome::kInterrupted};
  return {.outcome = outcome,
          .message = std::move(message),
          .roundtrip_time_s = Seconds(std::max(now, sent_) - sent_)};
}

std::optional<RequestExchange::Answer> RequestExchange::Hear(TimePoint now, const Event& event) {
  if (const auto* ack = std::get_if<PlanAckMessage>(&event); ack && Ours(ack->request_id)) {
    last_ack_ = now;
    switch (ack->verdict) {
      case PlanAckVerdict::kWorking:
        if (!working_) working_ = now;
        break;
      case PlanAckVerdict::kBusy:
        was_busy_ = true;
        break;
      case PlanAckVerdict::kRefused:
        return End(Outcome::kRefused, ack->message, now);
    }
  } else if (const auto* result = std::get_if<ArrivedResult>(&event);
             result && Ours(result->message.request_id)) {
    Answer answer = End(Outcome::kResult, "", result->arrival);
    if (!interrupted_) answer.result = result->message;
    answer.overdue = cancelled_.has_value();
    return answer;
  } else if (const auto* unusable = std::get_if<UnusableResult>(&event)) {
    if (Ours(unusable->request_id)) {
      return End(Outcome::kNoAnswer, "the result cannot be used: " + unusable->why, now);
    }
    if (unusable->request_id.empty()) unusable_result_ = unusable->why;
  } else if (std::holds_alternative<Interruption>(event)) {
    if (!interrupted_) {
      interrupted_ = now;
      next_send_ = now;
    }
  } else if (const auto* lost = std::get_if<PlannerLost>(&event)) {
    return End(Outcome::kNoAnswer, lost->why, now);
  }
  return std::nullopt;
}

std::optional<RequestExchange::Answer> RequestExchange::LosePatience(TimePoint now) {
  const auto give_up = [&](const std::string& why) {
    return End(Outcome::kNoAnswer,
               unusable_result_.empty() ? why : why + "; what came: " + unusable_result_, now);
  };
  if (interrupted_) {
    if (now - *interrupted_ > kCancelPatience) return give_up("");
  } else if (!working_) {
    if (now - last_ack_ > kAckPatience) {
      return give_up(fmt::format("no acknowledgement within {} s", kAckPatience.count()));
    }
    if (now - begun_ > time_limit_ + kBusyPatience) {
      return give_up(fmt::format("busy with other requests for {:.0f} s", Seconds(now - begun_)));
    }
  } else if (!cancelled_) {
    if (now - *working_ > time_limit_ + kResultPatience) {
      cancelled_ = now;
      next_send_ = now;
    }
  } else if (now - *cancelled_ > kResultPatience) {
    return give_up(fmt::format("no result, though live, {} s after the time limit",
                               2 * kResultPatience.count()));
  }
  return std::nullopt;
}

}  // namespace planbench
