#include "benchmark_driver/run_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <thread>
#include <utility>

#include "common/error.h"
#include "common/utime.h"
#include "messaging/asked_runs.h"
#include "results/outcomes.h"
#include "tests/benchmark_driver/run_executor_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;

TEST_F(RunExecutorTest, FetchesTheProblemHasItSolvedAndJudged) {
  FakeSceneServer server(&bus_);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved) << record.message;
  EXPECT_EQ(record.run_id, "run");
  EXPECT_EQ(record.request_id, "run/cans/2/arm/backward/3");
  EXPECT_EQ(record.planner, "arm");
  EXPECT_EQ(record.contestant, "Arm (fast)");
  EXPECT_EQ(record.problem_set, "cans");
  EXPECT_EQ(record.problem_index, 2);
  EXPECT_EQ(record.trial, 3);
  EXPECT_GT(record.start_utime, 0);
  EXPECT_GT(record.roundtrip_time_s, 0);
  EXPECT_EQ(record.result.result.path, FakePath());
  EXPECT_TRUE(record.path_check.verdict && record.path_check.verdict->valid);
  EXPECT_FALSE(record.simplified_check.verdict);

  const auto requests = planner_.requests().messages();
  ASSERT_FALSE(requests.empty());
  PlanRequest expected = Conditions().request;
  EXPECT_THAT(requests[0].request_id, testing::StartsWith("run/cans/2/arm/backward/3@"));
  expected.request_id = requests[0].request_id;
  expected.scene_id = "scene-2";
  expected.group = "arm";
  expected.start = {{"a", "b"}, {0, 0}};
  expected.goal = {{"a", 1, 0, 0}, {"b", 0.5, 0, 0}};
  expected.direction = Direction::kBackward;
  expected.seed = 9;
  expected.collision_model = CollisionModel::kVoxels;  // the contestant's
  expected.edge_resolution_m = 0.03;
  // The time limit is the driver's, not the problem's.
  EXPECT_EQ(requests[0], expected);
  EXPECT_EQ(record.request, expected);

  const auto checks = server.path_checks().messages();
  ASSERT_FALSE(checks.empty());
  EXPECT_EQ(checks[0].scene_id, "scene-2");
  EXPECT_EQ(checks[0].group, "arm");
  EXPECT_EQ(checks[0].joint_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(checks[0].path, FakePath());
  EXPECT_EQ(checks[0].collision_model, CollisionModel::kVoxels);
  EXPECT_EQ(checks[0].step_m, 0.004);
  EXPECT_TRUE(checks[0].with_clearance);
}

TEST_F(RunExecutorTest, AProblemThatIsAnotherThanBeforeIsNone) {
  FakeSceneServer server(&bus_);
  ASSERT_TRUE(executor_.AskForProblem("cans", 2, [] { return false; }).value().ok);
  server.AlterProblems([](ProblemMessage* problem) { problem->goal[0].position += 1; });
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kInvalidRequest);
  EXPECT_THAT(record.message, HasSubstr("no problem: its goal is another than before"));
}

TEST_F(RunExecutorTest, AsksForAProblemOnce) {
  FakeSceneServer server(&bus_);
  Execute();
  const std::size_t num_requests = server.problem_requests().messages().size();
  ScheduledRun other = Scheduled();
  other.request_id += "/again";
  const RunRecordMessage record = Execute(other);
  EXPECT_EQ(record.request.scene_id, "scene-2");
  EXPECT_EQ(server.problem_requests().messages().size(), num_requests);
  Execute(Scheduled(3));
  EXPECT_TRUE(server.problem_requests().WaitForOne(
      [](const ProblemRequestMessage& request) { return request.problem_index == 3; }));
}

TEST_F(RunExecutorTest, PathThatTheRefereeRejectsIsNoSuccess) {
  FakeSceneServer server(&bus_);
  server.OnPathCheck([](const PathCheckRequestMessage&) {
    return FakeSceneServer::Verdict(false, "in collision");
  });
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kInvalidPath);
  EXPECT_EQ(record.message, "in collision");
  EXPECT_EQ(record.result.result.status, PlanStatus::kSolved);
}

TEST_F(RunExecutorTest, SimplifiedPathIsJudgedApart) {
  PlanResult result = FakePlanner::SolvedResult();
  result.simplified_path = {{0, 0}, {0.1, 0}, {1, 0.5}};
  AnswerWith(result);
  FakeSceneServer server(&bus_);
  server.OnPathCheck([](const PathCheckRequestMessage& request) {
    return FakeSceneServer::Verdict(request.path.size() == 2);
  });
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved);
  ASSERT_TRUE(record.path_check.verdict && record.simplified_check.verdict);
  EXPECT_TRUE(record.path_check.verdict->valid);
  EXPECT_FALSE(record.simplified_check.verdict->valid);
}

TEST_F(RunExecutorTest, FailureIsNotJudged) {
  PlanResult result;
  result.status = PlanStatus::kTimedOut;
  result.message = "too hard";
  AnswerWith(result);
  FakeSceneServer server(&bus_);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kTimedOut);
  EXPECT_EQ(record.message, "too hard");
  EXPECT_TRUE(server.path_checks().messages().empty());
}

TEST_F(RunExecutorTest, APathThatTookLongerThanTheLimitIsNoSuccess) {
  SessionConditions conditions = Conditions();
  conditions.request.time_limit_s = 0.01;
  PlanResult result = FakePlanner::SolvedResult();
  result.planning_time_s = result.total_time_s = 0.02;
  AnswerWith(result);
  FakeSceneServer server(&bus_);
  RunExecutor executor(&bus_, &registry_, conditions);
  const RunRecordMessage record = Execute(&executor);
  EXPECT_EQ(record.status, PlanStatus::kTimedOut);
  EXPECT_EQ(record.result.result.planning_time_s, 0.02);
  EXPECT_THAT(record.message, HasSubstr("took 0.02 s, the limit being 0.01 s"));
  EXPECT_TRUE(server.path_checks().messages().empty());
}

TEST_F(RunExecutorTest, NoTimeIsLongerThanTheRoundTrip) {
  PlanResult result = FakePlanner::SolvedResult();
  result.planning_time_s = 300;  // milliseconds, perhaps
  result.total_time_s = 400;
  result.phases.setup_s = 1e-6;
  result.phases.search_s = 399;
  result.progress = {{300, 0, 3, 1}, {390, 0, 2, 2}};
  result.counters[kToldTime] = 7;
  planner_.OnRequest([this, result](const PlanRequest& request) {
    planner_.SendResult(request.request_id, result);
  });
  const FakeSceneServer server(&bus_);
  RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved) << "it came within the limit";
  const double roundtrip_s = record.roundtrip_time_s;
  EXPECT_LT(roundtrip_s, 7);
  const PlanResult& recorded = record.result.result;
  EXPECT_EQ(recorded.planning_time_s, roundtrip_s);
  EXPECT_EQ(recorded.total_time_s, roundtrip_s);
  EXPECT_LT(recorded.phases.setup_s, 1e-6) << "a share of the total, as it was";
  EXPECT_NEAR(recorded.phases.search_s, roundtrip_s, 1e-6);
  EXPECT_EQ(recorded.progress.back().elapsed_s, roundtrip_s);
  EXPECT_EQ(recorded.counters.at(kToldTime), 400);

  result = FakePlanner::SolvedResult();
  result.counters[kToldTime] = 7;  // nobody's but the driver's
  AnswerWith(result);
  record = Execute(Scheduled(3));
  EXPECT_EQ(record.result.result.planning_time_s, result.planning_time_s);
  EXPECT_FALSE(record.result.result.counters.contains(kToldTime));
}

TEST_F(RunExecutorTest, NoPartIsLongerThanTheTotalTime) {
  const FakeSceneServer server(&bus_);
  PlanResult parts = FakePlanner::SolvedResult();
  parts.total_time_s = parts.planning_time_s = 0.01;
  parts.phases.setup_s = parts.phases.search_s = 5;
  PlanResult planning = FakePlanner::SolvedResult();
  planning.total_time_s = 0.01;
  planning.planning_time_s = 0.02;
  PlanResult progress = FakePlanner::SolvedResult();
  progress.total_time_s = progress.planning_time_s = 0.02;
  progress.progress = {{0.02, 0, 3, 1}, {100, 0, 2, 2}};
  const double excess_s[] = {10 - 0.01, 0.02 - 0.01, 100 - 0.02};
  int index = 0;
  for (PlanResult result : {parts, planning, progress}) {
    planner_.OnRequest([this, result](const PlanRequest& request) {
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
      planner_.SendResult(request.request_id, result);
    });
    const RunRecordMessage record = Execute(Scheduled(++index));
    EXPECT_EQ(record.status, PlanStatus::kSolved);
    const PlanResult& recorded = record.result.result;
    EXPECT_NEAR(recorded.counters.at(kContradictoryTime), excess_s[index - 1], 1e-9);
    EXPECT_FALSE(recorded.counters.contains(kToldTime));
    EXPECT_EQ(recorded.total_time_s, std::max(result.total_time_s, result.planning_time_s));
    EXPECT_EQ(recorded.planning_time_s, result.planning_time_s);
    EXPECT_LE(recorded.phases.setup_s + recorded.phases.search_s, recorded.total_time_s + 1e-9);
    for (const PlanProgress& one : recorded.progress) {
      EXPECT_LE(one.elapsed_s, recorded.total_time_s);
    }
  }
}

TEST_F(RunExecutorTest, SimplificationIsWithinTheRoundTripToo) {
  const FakeSceneServer server(&bus_);
  PlanResult result = FakePlanner::SolvedResult();
  result.phases.simplification_s = 3;
  planner_.OnRequest([this, result](const PlanRequest& request) {
    planner_.SendResult(request.request_id, result);
  });
  const RunRecordMessage record = Execute();
  const PlanResult& recorded = record.result.result;
  EXPECT_LE(recorded.total_time_s + recorded.phases.simplification_s,
            record.roundtrip_time_s + 1e-9);
  EXPECT_EQ(recorded.counters.at(kToldTime), 3 + result.total_time_s);
}

TEST_F(RunExecutorTest, WhatALateAnswerDoesNotTellOfIsNoted) {
  const FakeSceneServer server(&bus_);
  SessionConditions conditions = Conditions();
  conditions.request.time_limit_s = 0.01;
  RunExecutor executor(&bus_, &registry_, conditions);
  bool is_asked = false;  // that is sent again meanwhile
  planner_.OnRequest([&](const PlanRequest& request) {
    if (std::exchange(is_asked, true)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    planner_.Solve(request);
  });
  const RunRecordMessage record = Execute(&executor);
  EXPECT_EQ(record.status, PlanStatus::kSolved);
  EXPECT_GT(record.result.result.counters.at(kUntoldTime), 1);
}

TEST_F(RunExecutorTest, ARunBeginsWhenItsPlannerIsThere) {
  const FakeSceneServer server(&bus_);
  planner_.FallSilent();
  NodeRegistry registry(&bus_);
  PlannerClient client(&bus_, &registry, "arm");
  RunExecutor executor(&bus_, &registry_, Conditions());
  std::atomic<std::int64_t> back_utime = 0;
  std::thread comes_back([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    back_utime = NowUtime();
    planner_.Restart();
  });
  const RunRecordMessage record =
      executor.Execute(Scheduled(), {&client}, [] { return false; }).value();
  comes_back.join();
  EXPECT_EQ(record.status, PlanStatus::kSolved) << record.message;
  EXPECT_GE(record.start_utime, back_utime);
}

TEST_F(RunExecutorTest, AWarmUpWithoutAResultIsTold) {
  const FakeSceneServer server(&bus_);
  planner_.OnRequest([&](const PlanRequest& request) {
    planner_.Acknowledge(request, PlanAckVerdict::kRefused, "too cold");
  });
  testing::internal::CaptureStdout();
  EXPECT_TRUE(executor_.WarmUp(Scheduled(), 0.5, &client_, [] { return false; }));
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::ContainsRegex("arm: no result to the warm-up request "
                                     "run/cans/2/arm/backward/3.*: too cold"));
}

TEST_F(RunExecutorTest, RefusalIsAnInvalidRequest) {
  planner_.OnRequest([&](const PlanRequest& request) {
    planner_.Acknowledge(request, PlanAckVerdict::kRefused, "another robot");
  });
  const FakeSceneServer server(&bus_);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kInvalidRequest);
  EXPECT_EQ(record.message, "refused: another robot");
  EXPECT_TRUE(WasAsked(record));
}

TEST_F(RunExecutorTest, PlannerThatIsRestartedGivesNoAnswer) {
  planner_.OnRequest([](const PlanRequest&) {});
  const FakeSceneServer server(&bus_);
  std::thread restarter([&] {
    planner_.requests().WaitFor(1);
    planner_.Restart();
  });
  const RunRecordMessage record = Execute();
  restarter.join();
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_THAT(record.message, HasSubstr("restarted"));
  EXPECT_TRUE(WasAsked(record));
}

TEST_F(RunExecutorTest, AProblemThatTheServerNoLongerHasIsAnInvalidRequest) {
  FakeSceneServer server(&bus_);
  const RunRecordMessage record = Execute(Scheduled(4));
  EXPECT_EQ(record.status, PlanStatus::kInvalidRequest);
  EXPECT_THAT(record.message, HasSubstr("no such problem"));
  EXPECT_FALSE(WasAsked(record));
  std::set<std::string> ids;
  for (const auto& request : server.problem_requests().messages()) ids.insert(request.request_id);
  EXPECT_EQ(ids.size(), 3u);  // it was asked anew
}

TEST_F(RunExecutorTest, RefereeThatHasForgottenTheSceneIsToldAgain) {
  std::atomic<int> num_checks = 0;
  FakeSceneServer server(&bus_);
  server.OnPathCheck([&](const PathCheckRequestMessage&) {
    if (++num_checks == 1) throw InputError("unknown scene");
    return FakeSceneServer::Verdict(true);
  });
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved);
  EXPECT_GE(server.problem_requests().messages().size(), 2u);
}

TEST_F(RunExecutorTest, ARunWithoutAVerdictIsToBeMadeAgain) {
  FakeSceneServer server(&bus_);
  server.OnPathCheck([](const PathCheckRequestMessage&) -> PathCheckReplyMessage {
    throw InputError("too many samples");
  });
  RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_EQ(record.message, "no verdict on its path: too many samples");
  EXPECT_FALSE(WasAsked(record)) << "it counts for nothing, and not against the planner";
  EXPECT_TRUE(IsUnjudgeable(record));
  EXPECT_TRUE(record.result.result.path.empty());

  server.OnPathCheck([](const PathCheckRequestMessage&) {
    PathCheckReplyMessage reply;
    reply.ok = true;
    return reply;
  });
  record = Execute(Scheduled(1));
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_EQ(record.message, "no verdict on its path: the scene server gave none");
  EXPECT_FALSE(WasAsked(record));
  EXPECT_FALSE(IsUnjudgeable(record)) << "it may give one the next time";
}

TEST_F(RunExecutorTest, ASimplifiedPathThatIsNotJudgedLeavesTheRawOne) {
  PlanResult result = FakePlanner::SolvedResult();
  result.simplified_path = {{0, 0}, {0.1, 0}, {1, 0.5}};
  AnswerWith(result);
  FakeSceneServer server(&bus_);
  server.OnPathCheck([](const PathCheckRequestMessage& request) {
    if (request.path.size() == 2) return FakeSceneServer::Verdict(true);
    throw InputError("too many samples");
  });
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved);
  EXPECT_EQ(record.simplified_check.message, "too many samples");
}

TEST_F(RunExecutorTest, InterruptionLeavesNoRecord) {
  const auto execute = [&] {
    return executor_.Execute(Scheduled(), {&client_}, [&] { return interrupted_.load(); });
  };
  interrupted_ = true;
  EXPECT_FALSE(execute());  // no scene server either

  FakeSceneServer server(&bus_);
  for (const bool answers : {false, true}) {
    interrupted_ = false;
    planner_.OnRequest([&, answers](const PlanRequest& request) {
      interrupted_ = true;
      if (answers) planner_.SendResult(request.request_id, {});
    });
    EXPECT_FALSE(execute());
  }
  EXPECT_FALSE(planner_.cancels().WaitFor(1).empty());
}

TEST_F(RunExecutorTest, WarmsUpWithARequestThatIsNotJudged) {
  FakeSceneServer server(&bus_);
  EXPECT_TRUE(executor_.WarmUp(Scheduled(), 0.5, &client_, [] { return false; }));
  ASSERT_EQ(planner_.requests().messages().size(), 1u);
  const PlanRequest request = planner_.requests().messages()[0];
  EXPECT_EQ(request.time_limit_s, 0.5);
  EXPECT_THAT(request.request_id, testing::EndsWith("/warm-up"));
  EXPECT_EQ(request.collision_model, CollisionModel::kVoxels);
  EXPECT_NE(request.seed, Scheduled().seed) << "lest caches know the very search of the run";
  EXPECT_TRUE(server.path_checks().messages().empty());
  Execute();
  EXPECT_NE(planner_.requests().messages().back().request_id, request.request_id);
}

}  // namespace
}  // namespace planbench
