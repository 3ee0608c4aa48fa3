#include "benchmark_driver/planner_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "tests/benchmark_driver/fake_nodes.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using Outcome = PlannerClient::Outcome;
using Verdict = PlanAckVerdict;

class PlannerClientTest : public testing::Test {
 protected:
  PlannerClientTest() { bus_.Start(); }

  static PlanRequest Request(const std::string& id) {
    PlanRequest request;
    request.run_id = "run";
    request.request_id = id;
    request.scene_id = "scene";
    request.time_limit_s = 3600;
    return request;
  }
  PlannerClient::Answer Solve(const std::string& id) {
    return client_.Solve(Request(id), [this] { return interrupted_.load(); });
  }
  std::future<PlannerClient::Answer> BeginToSolve(const std::string& id) {
    return std::async(std::launch::async, [this, id] { return Solve(id); });
  }
  static bool AcknowledgedAs(FakePlanner* planner, const std::string& id) {
    return planner->result_acks().WaitForOne([&](const AckMessage& ack) { return ack.id == id; });
  }

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
  PlannerClient client_{&bus_, &registry_, "arm"};
  std::atomic<bool> interrupted_ = false;
};

TEST_F(PlannerClientTest, ReturnsTheResultAndAcknowledgesIt) {
  FakePlanner planner(&bus_);
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kResult);
  EXPECT_EQ(answer.result.request_id, "a");
  EXPECT_EQ(answer.result.result.path, FakePath());
  EXPECT_GT(answer.roundtrip_time_s, 0);
  EXPECT_TRUE(AcknowledgedAs(&planner, "a"));
  EXPECT_EQ(Solve("b").result.request_id, "b");
}

TEST_F(PlannerClientTest, WaitsForThePlannerToCome) {
  auto answer = BeginToSolve("a");
  const FakePlanner planner(&bus_);
  EXPECT_EQ(answer.get().outcome, Outcome::kResult);
}

TEST_F(PlannerClientTest, WaitingForThePlannerCanBeInterrupted) {
  auto answer = BeginToSolve("a");
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, Outcome::kInterrupted);
}

TEST_F(PlannerClientTest, AsksAgainUntilItIsHeard) {
  FakePlanner planner(&bus_);
  std::atomic<int> num_requests = 0;
  planner.OnRequest([&](const PlanRequest& request) {
    if (++num_requests == 3) planner.Solve(request);  // the first two were lost
  });
  EXPECT_EQ(Solve("a").outcome, Outcome::kResult);
}

TEST_F(PlannerClientTest, AsksAgainWhileThePlannerIsBusy) {
  FakePlanner planner(&bus_);
  std::atomic<int> num_requests = 0;
  std::chrono::steady_clock::time_point first;
  std::chrono::steady_clock::time_point last;
  planner.OnRequest([&](const PlanRequest& request) {
    last = std::chrono::steady_clock::now();
    if (num_requests == 0) first = last;
    if (++num_requests < 3) return planner.Acknowledge(request, Verdict::kBusy);
    planner.Solve(request);
  });
  const auto begin = std::chrono::steady_clock::now();
  const PlannerClient::Answer answer = Solve("a");
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(answer.outcome, Outcome::kResult);
  // The time spent on others' requests is not part of the round trip.
  EXPECT_LE(answer.roundtrip_time_s,
            (all - std::chrono::duration<double>(last - first)).count() + 1e-9);
}

TEST_F(PlannerClientTest, DoesNotRepeatWhatWasAccepted) {
  FakePlanner planner(&bus_);
  MessageCollector<PlanAckMessage> acks(&bus_, PlannerChannels("arm").ack);
  planner.OnRequest(
      [&](const PlanRequest& request) { planner.Acknowledge(request, Verdict::kAccepted); });
  std::size_t num_requests = 0;
  int num_asked = 0;
  // Asked every 50 ms: from the acknowledgement on long enough for two more requests.
  const PlannerClient::Answer answer = client_.Solve(Request("a"), [&] {
    if (acks.messages().empty()) return false;
    ++num_asked;
    if (num_asked == 2) num_requests = planner.requests().messages().size();
    if (num_asked == 25) planner.SendResult("a", FakePlanner::SolvedResult());
    return false;
  });
  EXPECT_EQ(answer.outcome, Outcome::kResult);
  EXPECT_EQ(planner.requests().messages().size(), num_requests);
}

TEST_F(PlannerClientTest, RefusalSaysWhy) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kRefused, "another robot");
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kRefused);
  EXPECT_EQ(answer.message, "another robot");
}

TEST_F(PlannerClientTest, PlannerThatDiesGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kAccepted);
    planner.FallSilent();
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("died"));
  EXPECT_GT(answer.roundtrip_time_s, 0);
}

TEST_F(PlannerClientTest, PlannerThatWasRestartedGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest(
      [&](const PlanRequest& request) { planner.Acknowledge(request, Verdict::kAccepted); });
  auto answer = BeginToSolve("a");
  ASSERT_EQ(planner.requests().WaitFor(1).size(), 1u);
  planner.Restart();
  const PlannerClient::Answer given = answer.get();
  EXPECT_EQ(given.outcome, Outcome::kNoAnswer);
  EXPECT_THAT(given.message, HasSubstr("restarted"));
  // The next request is the new process's.
  planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
  EXPECT_EQ(Solve("b").outcome, Outcome::kResult);
}

TEST_F(PlannerClientTest, InterruptionCancelsTheRequestUntilItsResultComes) {
  FakePlanner planner(&bus_);
  planner.OnRequest(
      [&](const PlanRequest& request) { planner.Acknowledge(request, Verdict::kAccepted); });
  std::atomic<int> num_cancels = 0;
  const Subscription cancels = bus_.Subscribe<PlanCancelMessage>(
      PlannerChannels("arm").cancel, [&](const PlanCancelMessage& cancel) {
        if (++num_cancels < 3) return;  // the first two were lost
        PlanResult cancelled;
        cancelled.status = PlanStatus::kCancelled;
        planner.SendResult(cancel.request_id, cancelled);
      });
  auto answer = BeginToSolve("a");
  ASSERT_EQ(planner.requests().WaitFor(1).size(), 1u);
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, Outcome::kInterrupted);
  EXPECT_TRUE(AcknowledgedAs(&planner, "a"));
  for (const PlanCancelMessage& cancel : planner.cancels().messages()) {
    EXPECT_EQ(cancel.request_id, "a");
  }
}

TEST_F(PlannerClientTest, InterruptionDoesNotWaitLongForThePlanner) {
  FakePlanner planner(&bus_);
  planner.OnRequest(
      [&](const PlanRequest& request) { planner.Acknowledge(request, Verdict::kAccepted); });
  auto answer = BeginToSolve("a");
  ASSERT_EQ(planner.requests().WaitFor(1).size(), 1u);
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, Outcome::kInterrupted);
  EXPECT_FALSE(planner.cancels().messages().empty());
}

TEST_F(PlannerClientTest, LateResultOfAFormerRequestIsOnlyAcknowledged) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kAccepted);
    planner.SendResult("former", FakePlanner::SolvedResult());
    planner.SendResult(request.request_id, FakePlanner::SolvedResult());
  });
  EXPECT_EQ(Solve("a").result.request_id, "a");
  EXPECT_TRUE(AcknowledgedAs(&planner, "former"));
  planner.SendResult("between requests", FakePlanner::SolvedResult());
  EXPECT_TRUE(AcknowledgedAs(&planner, "between requests"));
}

TEST_F(PlannerClientTest, ResultThatCannotBeReadEndsTheRequest) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kAccepted);
    PlanResult result = FakePlanner::SolvedResult();
    result.planning_time_s = -1;
    planner.SendResult(request.request_id, result);
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("planning_time_s"));
  EXPECT_TRUE(AcknowledgedAs(&planner, "a"));
}

TEST_F(PlannerClientTest, CancellationOfAFormerTimeIsNoResult) {
  PlanResult cancelled;
  cancelled.status = PlanStatus::kCancelled;
  FakePlanner planner(&bus_);
  std::atomic<int> num_requests = 0;
  planner.OnRequest([&](const PlanRequest& request) {
    // The result of before the interruption is still being repeated when the request comes again.
    if (++num_requests == 1) return planner.SendResult(request.request_id, cancelled);
    planner.Solve(request);
  });
  EXPECT_EQ(Solve("a").result.result.status, PlanStatus::kSolved);
  EXPECT_TRUE(AcknowledgedAs(&planner, "a"));

  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kAccepted);
    planner.SendResult(request.request_id, cancelled);
  });
  EXPECT_EQ(Solve("b").result.result.status, PlanStatus::kCancelled);
}

}  // namespace
}  // namespace planbench
