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
  if (outcome == Outcome::kNoAnswer && !refused_.empty()) message += "; refused: " + refused_;
  return {.outcome = outcome,
          .message = std::move(message),
          .roundtrip_time_s = Seconds(std::max(now, sent_) - sent_)};
}

std::optional<RequestExchange::Answer> RequestExchange::Hear(TimePoint now, const Event& event) {
  if (std::holds_alternative<Interruption>(event)) {
    if (!interrupted_) {
      interrupted_ = now;
      next_send_ = now;
    }
    if (lost_) return End(Outcome::kInterrupted, "", now);
  } else if (lost_ && (has_cancelled_ || !std::holds_alternative<ArrivedResult>(event))) {
    const auto* lost = std::get_if<PlannerLost>(&event);
    // More is known of the same.
    if (lost != nullptr && lost->why.starts_with(why_lost_)) why_lost_ = lost->why;
    return std::nullopt;
  } else if (const auto* ack = std::get_if<Acknowledgement>(&event)) {
    if (Ours(ack->message.request_id)) return HearAck(now, *ack);
  } else if (const auto* result = std::get_if<ArrivedResult>(&event)) {
    if (!Ours(result->message.request_id)) {
      what_came_ = "a result for '" + result->message.request_id + "'";
      return std::nullopt;
    }
    const PlanResult& told = result->message.result;
    if (told.status == PlanStatus::kCancelled && !Cancelling()) {
      if (lost_) return std::nullopt;
      has_cancelled_ = true;
      return Lose(fmt::format("it answered CANCELLED, though its request was not cancelled{}{}",
                              told.message.empty() ? "" : ": ", told.message),
                  result->arrival);
    }
    Answer answer = End(Outcome::kResult, "", result->arrival);
    if (!interrupted_) answer.result = result->message;
    answer.overdue = cancelled_.has_value();
    // Stopped for nothing but its time.
    if (PlanResult& result = answer.result.result;
        answer.overdue && result.status == PlanStatus::kCancelled) {
      result.status = PlanStatus::kTimedOut;
      result.message =
          fmt::format("no path had come {:.1f} s after it was asked for, the limit being {} s",
                      Seconds(*cancelled_ - sent_), Seconds(time_limit_));
    }
    return answer;
  } else if (const auto* unusable = std::get_if<UnusableResult>(&event)) {
    if (Ours(unusable->request_id)) {
      return End(Outcome::kNoAnswer, "the result cannot be used: " + unusable->why, now);
    }
    if (unusable->request_id.empty()) what_came_ = unusable->why;
  } else if (const auto* refused = std::get_if<RefusedMessage>(&event)) {
    if (refused_.empty()) refused_ = refused->what;
  } else if (const auto* lost = std::get_if<PlannerLost>(&event)) {
    return Lose(lost->why, now);
  }
  return std::nullopt;
}

std::optional<RequestExchange::Answer> RequestExchange::Lose(std::string why, TimePoint when) {
  if (interrupted_) return End(Outcome::kInterrupted, "", when);
  lost_ = when;
  why_lost_ = std::move(why);
  next_send_ = TimePoint::max();  // its successor is not to be asked
  return std::nullopt;
}

std::optional<RequestExchange::Answer> RequestExchange::HearAck(TimePoint now,
                                                                const Acknowledgement& ack) {
  last_ack_ = now;
  switch (ack.message.verdict) {
    case PlanAckVerdict::kWorking:
      working_ = true;
      denied_ = false;
      break;
    case PlanAckVerdict::kBusy:
      denied_ = ack.working_on.empty() || Ours(ack.working_on);
      if (!denied_) other_request_ = ack.working_on;
      was_busy_ = was_busy_ || (!denied_ && !working_);
      break;
    case PlanAckVerdict::kRefused:
      return End(Outcome::kRefused, ack.message.message, now);
  }
  return std::nullopt;
}

std::optional<RequestExchange::Answer> RequestExchange::LosePatience(TimePoint now) {
  const auto give_up = [&](std::string why) {
    if (denied_) why += "; it answered BUSY, though its status named no other request";
    if (!what_came_.empty()) why += "; what came: " + what_came_;
    return End(Outcome::kNoAnswer, why, now);
  };
  if (lost_) {
    if (now - *lost_ >= kInterruptionDelay) return End(Outcome::kNoAnswer, why_lost_, *lost_);
  } else if (interrupted_) {
    if (now - *interrupted_ > kCancelPatience) return give_up("");
  } else if (cancelled_) {
    if (now - *cancelled_ > kResultPatience) {
      return give_up(fmt::format("no result, though live, {} s after the time limit",
                                 2 * kResultPatience.count()));
    }
  } else if (!working_ && now - last_ack_ > kAckPatience) {
    return give_up(fmt::format("no acknowledgement within {} s", kAckPatience.count()));
  } else if (!working_ && now - begun_ > time_limit_ + kBusyPatience) {
    return give_up(fmt::format("busy with other requests for {:.0f} s, the last being '{}'",
                               Seconds(now - begun_), other_request_));
  } else if (now - sent_ > time_limit_ + kResultPatience) {
    cancelled_ = now;
    next_send_ = now;
  }
  return std::nullopt;
}

}  // namespace planbench
