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

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
  PlannerClient client_{&bus_, &registry_, "arm"};
  std::atomic<bool> interrupted_ = false;
};

TEST_F(PlannerClientTest, ReturnsTheResult) {
  const FakePlanner planner(&bus_);
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kResult);
  EXPECT_EQ(answer.result.request_id, "a");
  EXPECT_EQ(answer.result.result.path, FakePath());
  EXPECT_GT(answer.roundtrip_time_s, 0);
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

TEST_F(PlannerClientTest, AsksAgainUntilTheResultComes) {
  FakePlanner planner(&bus_);
  std::atomic<int> num_requests = 0;
  planner.OnRequest([&](const PlanRequest& request) {
    ++num_requests;  // the first was lost, the second is worked on, the third one's result is lost
    if (num_requests == 2) planner.Acknowledge(request, Verdict::kWorking);
    if (num_requests == 4) planner.Solve(request);
  });
  EXPECT_EQ(Solve("a").outcome, Outcome::kResult);
}

TEST_F(PlannerClientTest, ResultsOfOtherRequestsAreNoConcern) {
  FakePlanner planner(&bus_);
  planner.SendResult("before", FakePlanner::SolvedResult());
  planner.OnRequest([&](const PlanRequest& request) {
    planner.SendResult("former", FakePlanner::SolvedResult());
    planner.Solve(request);
    planner.Solve(request);  // as if the request had been repeated
  });
  EXPECT_EQ(Solve("a").result.request_id, "a");
  EXPECT_EQ(Solve("b").result.request_id, "b");
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

TEST_F(PlannerClientTest, ResultThatCannotBeReadEndsTheRequest) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    PlanResult result = FakePlanner::SolvedResult();
    result.planning_time_s = -1;
    planner.SendResult(request.request_id, result);
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("planning_time_s"));
}

TEST_F(PlannerClientTest, PlannerThatDiesGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest&) { planner.FallSilent(); });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("died"));
}

TEST_F(PlannerClientTest, PlannerThatWasRestartedGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([](const PlanRequest&) {});
  auto answer = BeginToSolve("a");
  ASSERT_FALSE(planner.requests().WaitFor(1).empty());
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
  planner.OnRequest([](const PlanRequest&) {});
  std::atomic<int> num_cancels = 0;
  const Subscription cancels = bus_.Subscribe<PlanCancelMessage>(
      PlannerChannels("arm").cancel, [&](const PlanCancelMessage& cancel) {
        EXPECT_EQ(cancel.request_id, "a");
        if (++num_cancels == 2) planner.SendResult("a", {});  // the first was lost
      });
  auto answer = BeginToSolve("a");
  ASSERT_FALSE(planner.requests().WaitFor(1).empty());
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, Outcome::kInterrupted);
  EXPECT_EQ(num_cancels, 2);
}

}  // namespace
}  // namespace planbench
