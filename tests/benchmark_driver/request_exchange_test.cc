#include "benchmark_driver/request_exchange.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace planbench {
namespace {

using Exchange = RequestExchange;
using Event = Exchange::Event;

constexpr double kTimeLimit = 10;

/// Seconds after the beginning.
Exchange::TimePoint At(double seconds) {
  return Exchange::TimePoint() + std::chrono::duration_cast<Exchange::TimePoint::duration>(
                                     std::chrono::duration<double>(1000 + seconds));
}

Event Ack(PlanAckVerdict verdict, const std::string& id = "r", const std::string& working_on = "") {
  return Exchange::Acknowledgement{{"arm", id, verdict, "why"}, working_on};
}
Event Working() { return Ack(PlanAckVerdict::kWorking); }
Event Busy() { return Ack(PlanAckVerdict::kBusy, "r", "another"); }
Event Result(double arrival, const std::string& id = "r", PlanStatus status = PlanStatus::kSolved) {
  PlanResultMessage message;
  message.request_id = id;
  message.result.status = status;
  return Exchange::ArrivedResult{message, At(arrival)};
}
Event Unusable(const std::string& id) { return Exchange::UnusableResult{id, "cost: nan"}; }
constexpr Exchange::Tick kTick;
constexpr Exchange::Interruption kInterruption;
const Exchange::PlannerLost kLost{"the process died"};

/// What is to be done: "request", "cancel", "" for nothing, or how it ended.
std::string TextOf(const Exchange::Step& step) {
  if (!step.answer) {
    EXPECT_FALSE(step.send_request && step.send_cancel);
    return step.send_request ? "request" : step.send_cancel ? "cancel" : "";
  }
  EXPECT_FALSE(step.send_request || step.send_cancel);
  switch (step.answer->outcome) {
    case Exchange::Outcome::kResult:
      EXPECT_EQ(step.answer->result.request_id, "r");
      return fmt::format("{}result after {:.2f}", step.answer->overdue ? "overdue " : "",
                         step.answer->roundtrip_time_s);
    case Exchange::Outcome::kRefused:
      return "refused: " + step.answer->message;
    case Exchange::Outcome::kNoAnswer:
      return fmt::format("no answer after {:.2f}: {}", step.answer->roundtrip_time_s,
                         step.answer->message);
    case Exchange::Outcome::kInterrupted:
      return "interrupted";
  }
  return "no outcome";
}

/// When, what, and what is then to be done.
struct Line {
  double at;
  Event event;
  std::string expected;
};

void Play(const std::vector<Line>& lines) {
  Exchange exchange("r", kTimeLimit, At(0));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(TextOf(exchange.Take(At(lines[i].at), lines[i].event)), lines[i].expected)
        << "line " << i << ", at " << lines[i].at << " s";
  }
}

/// Every quarter of a second from `begin` on until `end`: `event`, and then `expected`.
std::vector<Line> Repeated(double begin, double end, const Event& event,
                           const std::string& expected) {
  std::vector<Line> lines;
  for (double at = begin; at < end; at += 0.25) lines.push_back({at, event, expected});
  return lines;
}
std::vector<Line> operator+(std::vector<Line> a, const std::vector<Line>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(RequestExchange, ResultEndsIt) {
  Play({{0, kTick, "request"}, {0.02, Working(), ""}, {0.1, Result(0.08), "result after 0.08"}});
  Play({{0, kTick, "request"}, {0.1, Result(0.1), "result after 0.10"}});  // before any ack
}

TEST(RequestExchange, RequestIsRepeatedUntilTheResultComes) {
  Play({{0, kTick, "request"},
        {0.2, kTick, ""},
        {0.25, kTick, "request"},  // as if the first one had been lost
        {0.26, Working(), ""},
        {0.49, kTick, ""},
        {0.5, kTick, "request"},
        {0.51, Working(), ""},
        {0.75, Working(), "request"},  // as if the result had been lost
        {0.76, Result(0.76), "result after 0.76"}});
}

TEST(RequestExchange, SaysWhenItWantsToSend) {
  Exchange exchange("r", kTimeLimit, At(0));
  EXPECT_EQ(exchange.NextSend(), At(0));
  exchange.Take(At(0.1), kTick);
  EXPECT_EQ(exchange.NextSend(), At(0.1) + Exchange::kRepeatPeriod);
  exchange.Take(At(0.2), kInterruption);
  EXPECT_EQ(exchange.NextSend(), At(0.2) + Exchange::kRepeatPeriod);
}

TEST(RequestExchange, WhatWasRefusedIsToldIfNoAnswerComes) {
  const Event refused = Exchange::RefusedMessage{"a stranger's"};
  const Event refused_later = Exchange::RefusedMessage{"another's"};
  Play({{0, kTick, "request"}, {0.1, refused, ""}, {0.2, Result(0.2), "result after 0.20"}});
  Play({{0, kTick, "request"},
        {0.1, refused, ""},
        {0.1, refused_later, ""},
        {0.2, kLost, ""},
        {1.25, kLost, "no answer after 0.20: the process died; refused: a stranger's"}});
  Play(std::vector<Line>{{0, kTick, "request"}, {0.1, refused, ""}} +
       Repeated(0.25, 10.25, kTick, "request") +
       std::vector<Line>{{10.25, kTick,
                          "no answer after 10.25: no acknowledgement within 10 s; refused: a "
                          "stranger's"}});
}

TEST(RequestExchange, OtherRequestsAreNoConcern) {
  Play({{0, kTick, "request"},
        {0.1, Ack(PlanAckVerdict::kRefused, "former"), ""},
        {0.1, Result(0.1, "former"), ""},
        {0.1, Unusable("former"), ""},
        {0.2, Result(0.2), "result after 0.20"}});
}

TEST(RequestExchange, TimeForOthersIsNotInTheRoundTrip) {
  Play({{0, kTick, "request"},
        {0.01, Busy(), ""},
        {0.25, kTick, "request"},
        {0.26, Busy(), ""},
        {0.5, kTick, "request"},
        {0.51, Working(), ""},
        {0.75, kTick, "request"},
        {0.9, Result(0.9), "result after 0.40"}});
}

TEST(RequestExchange, RefusalEndsIt) {
  Play({{0, kTick, "request"}, {0.1, Ack(PlanAckVerdict::kRefused), "refused: why"}});
}

TEST(RequestExchange, UnusableResultEndsIt) {
  Play({{0, kTick, "request"},
        {0.1, Unusable("r"), "no answer after 0.10: the result cannot be used: cost: nan"}});
}

TEST(RequestExchange, PlannerThatIsLostGivesNoAnswer) {
  Play({{0, kTick, "request"},
        {0.1, Working(), ""},
        {0.2, kLost, ""},
        {0.3, Event(Exchange::PlannerLost{"another has come"}), ""},
        {0.5, Working(), ""},  // it is not asked again, nor its successor
        {0.6, Result(0.6, "r", PlanStatus::kCancelled), ""},
        {1.25, kTick, "no answer after 0.20: the process died"}});
}

TEST(RequestExchange, WhatIsKnownALittleLaterOfALossIsToldWithIt) {
  Play({{0, kTick, "request"},
        {0.2, kLost, ""},
        {0.25, Event(Exchange::PlannerLost{"the process died of hunger"}), ""},
        {1.25, kTick, "no answer after 0.20: the process died of hunger"}});
}

TEST(RequestExchange, WhatALostPlannerSentBeforeCounts) {
  Play({{0, kTick, "request"}, {0.2, kLost, ""}, {0.3, Result(0.19), "result after 0.19"}});
}

TEST(RequestExchange, CancelledThoughNobodyDidIsAPlannerThatIsLost) {
  Play({{0, kTick, "request"},
        {0.2, Result(0.2, "r", PlanStatus::kCancelled), ""},
        {0.3, kLost, ""},
        {0.4, Result(0.4), ""},  // the first answer counts
        {1.25, kTick,
         "no answer after 0.20: it answered CANCELLED, though its request was not cancelled"}});
}

TEST(RequestExchange, APlannerThatIsLostToAnInterruptionIsNotToBlame) {
  for (const Event& end : {Event(kLost), Result(0.2, "r", PlanStatus::kCancelled)}) {
    Play({{0, kTick, "request"},
          {0.2, end, ""},
          {0.45, kTick, ""},
          {1.1, kInterruption, "interrupted"}});
  }
}

TEST(RequestExchange, PlannerThatHearsNothingIsGivenUp) {
  Play(Repeated(0, 10.1, kTick, "request") +
       std::vector<Line>{{10.1, kTick, "no answer after 10.10: no acknowledgement within 10 s"}});
  // Also after it was busy.
  Play(std::vector<Line>{{0, kTick, "request"}, {0.1, Busy(), ""}} +
       Repeated(0.25, 10.1, kTick, "request") +
       std::vector<Line>{{10.2, kTick, "no answer after 9.95: no acknowledgement within 10 s"}});
}

TEST(RequestExchange, PlannerThatIsAlwaysBusyIsGivenUp) {
  Play(Repeated(0, 70.1, Busy(), "request") +
       std::vector<Line>{{70.25, Busy(),
                          "no answer after 0.25: busy with other requests for 70 s, the last being "
                          "'another'"}});
}

TEST(RequestExchange, OverdueRequestIsCancelledUntilItsResultComes) {
  const std::vector<Line> overdue =
      std::vector<Line>{{0, kTick, "request"}, {0, Working(), ""}} +
      Repeated(0.25, 25.1, Working(), "request") +
      std::vector<Line>{{25.1, kTick, "cancel"}, {25.2, Working(), ""}, {25.35, kTick, "cancel"}};
  Play(overdue + std::vector<Line>{{25.4, Result(25.4), "overdue result after 25.40"}});
  Play(overdue + Repeated(25.6, 40.1, Working(), "cancel") +
       std::vector<Line>{
           {40.2, kTick,
            "no answer after 40.20: no result, though live, 30 s after the time limit"}});
  // One that could not even be read is the likely reason.
  Play(overdue + std::vector<Line>{{25.5, Unusable(""), ""},
                                   {40.2, kTick,
                                    "no answer after 40.20: no result, though live, 30 s after "
                                    "the time limit; what came: cost: nan"}});
}

TEST(RequestExchange, CancelledForBeingOverdueIsTimedOut) {
  const auto outcome = [](const Event& last) {
    Exchange exchange("r", kTimeLimit, At(0));
    for (double at = 0; at < 25.1; at += 0.25) exchange.Take(At(at), Working());
    EXPECT_TRUE(exchange.Take(At(25.1), kTick).send_cancel);
    const auto answer = exchange.Take(At(25.4), last).answer;
    return answer ? answer->result.result : PlanResult();
  };
  const PlanResult cancelled = outcome(Result(25.4, "r", PlanStatus::kCancelled));
  EXPECT_EQ(cancelled.status, PlanStatus::kTimedOut);
  EXPECT_EQ(cancelled.message,
            "no path had come 25.1 s after it was asked for, the limit being 10 s");
  EXPECT_EQ(outcome(Result(25.4, "r", PlanStatus::kExhausted)).status, PlanStatus::kExhausted);
}

TEST(RequestExchange, PlannerThatForgotTheRequestIsAskedOn) {
  Play({{0, kTick, "request"},
        {0.1, Working(), ""},
        {0.25, Busy(), "request"},
        {0.5, Working(), "request"},
        {0.6, Result(0.6), "result after 0.60"}});
}

TEST(RequestExchange, BusyIsNoExcuseUnlessThePlannerAnnouncesAnotherRequest) {
  for (const std::string working_on : {"", "r"}) {
    const Event busy = Ack(PlanAckVerdict::kBusy, "r", working_on);
    Play(Repeated(0, 25.1, busy, "request") + std::vector<Line>{{25.1, busy, "cancel"}} +
         std::vector<Line>{{25.2, Result(25.2), "overdue result after 25.20"}});
    Play(Repeated(0, 3.9, busy, "request") +
         std::vector<Line>{{4, Result(4), "result after 4.00"}});
    Play(Repeated(0, 25.1, busy, "request") + Repeated(25.1, 40.2, busy, "cancel") +
         std::vector<Line>{
             {40.3, kTick,
              "no answer after 40.30: no result, though live, 30 s after the time limit; it "
              "answered BUSY, though its status named no other request"}});
  }
}

TEST(RequestExchange, BusyIsNotBlamedOnceThePlannerHasTheRequest) {
  const Event busy = Ack(PlanAckVerdict::kBusy, "r", "");
  Play(Repeated(0, 1.1, busy, "request") + Repeated(1.25, 25.1, Working(), "request") +
       Repeated(25.1, 40.2, Working(), "cancel") +
       std::vector<Line>{
           {40.3, kTick,
            "no answer after 40.30: no result, though live, 30 s after the time limit"}});
}

TEST(RequestExchange, BusyDoesNotMoveTheClockOnceThePlannerHasTheRequest) {
  Play(std::vector<Line>{{0, kTick, "request"}, {0.1, Working(), ""}} +
       Repeated(0.25, 25.1, Busy(), "request") +
       std::vector<Line>{{25.1, Busy(), "cancel"},
                         {25.2, Result(25.2), "overdue result after 25.20"}});
}

TEST(RequestExchange, WhatCameInPlaceOfTheResultIsTold) {
  Play(std::vector<Line>{{0, kTick, "request"}, {0.1, Result(0.1, "an other"), ""}} +
       Repeated(0.25, 10.1, kTick, "request") +
       std::vector<Line>{{10.2, kTick,
                          "no answer after 10.20: no acknowledgement within 10 s; what came: a "
                          "result for 'an other'"}});
}

TEST(RequestExchange, InterruptionCancelsUntilTheResultComes) {
  const std::vector<Line> interrupted = {{0, kTick, "request"},
                                         {0.1, Working(), ""},
                                         {0.2, kInterruption, "cancel"},
                                         {0.3, kInterruption, ""},
                                         {0.45, kInterruption, "cancel"}};
  for (const Event& end :
       {Result(0.5), Unusable("r"), Event(kLost), Ack(PlanAckVerdict::kRefused)}) {
    Play(interrupted + std::vector<Line>{{0.5, end, "interrupted"}});
  }
}

TEST(RequestExchange, InterruptionDoesNotWaitLong) {
  Play({{0, kTick, "request"},
        {0.2, kInterruption, "cancel"},
        {0.45, kInterruption, "cancel"},
        {1.1, kTick, "cancel"},
        {1.25, kTick, "interrupted"}});
}

}  // namespace
}  // namespace planbench
