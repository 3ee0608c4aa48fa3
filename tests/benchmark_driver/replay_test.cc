#include "benchmark_driver/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "common/error.h"
#include "tests/benchmark_driver/fake_nodes.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Scene OneBox() {
  Scene scene;
  scene.name = "box";
  return scene;
}

RunRecordMessage Recorded(const std::string& request_id, const std::string& planner = "arm") {
  RunRecordMessage run;
  run.run_id = "then";
  run.request_id = request_id;
  run.planner = planner;
  run.request.run_id = "then";
  run.request.request_id = request_id + "@1";
  run.request.scene_id = SceneId(OneBox());
  run.request.group = "arm";
  run.request.seed = 9;
  run.request.time_limit_s = 7;
  run.status = PlanStatus::kSolved;
  run.result.request_id = run.request.request_id;
  run.result.joint_names = {"a", "b"};
  run.result.result = FakePlanner::SolvedResult();
  return run;
}

PlannerClient::Answer SameAnswer() {
  return {.outcome = PlannerClient::Outcome::kResult, .result = Recorded("x").result};
}

TEST(DifferenceTest, OfEqualAnswersThereIsNone) {
  PlannerClient::Answer answer = SameAnswer();
  EXPECT_EQ(Difference(Recorded("x"), answer), "");
  answer.result.result.planning_time_s = 3;
  answer.result.result.counters["iterations"] = 8;
  answer.result.result.message = "other words";
  EXPECT_EQ(Difference(Recorded("x"), answer), "");
  // The referee's verdict is not the planner's answer.
  RunRecordMessage rejected = Recorded("x");
  rejected.status = PlanStatus::kInvalidPath;
  EXPECT_EQ(Difference(rejected, answer), "");
}

TEST(DifferenceTest, NamesWhatDiffers) {
  PlannerClient::Answer answer = SameAnswer();
  answer.result.result.path[1][0] += 0.125;
  answer.result.result.cost = 4;
  EXPECT_EQ(Difference(Recorded("x"), answer), "path, waypoint 1: off by 0.125; cost 0, now 4");
  answer = SameAnswer();
  answer.result.result.path.push_back({2, 2});
  answer.result.result.simplified_path = FakePath();
  answer.result.joint_names = {"b", "a"};
  EXPECT_EQ(Difference(Recorded("x"), answer),
            "joints a b, now b a; path of 2 waypoints, now 3; simplified path of 0 waypoints, "
            "now 2");
}

TEST(DifferenceTest, AStatusThatDiffersSaysItAll) {
  PlannerClient::Answer answer;
  answer.outcome = PlannerClient::Outcome::kNoAnswer;
  answer.message = "the process died";
  EXPECT_EQ(Difference(Recorded("x"), answer), "SOLVED, now NO_ANSWER (the process died)");
  answer.outcome = PlannerClient::Outcome::kRefused;
  answer.message = "no";
  EXPECT_EQ(Difference(Recorded("x"), answer), "SOLVED, now INVALID_REQUEST (no)");
  RunRecordMessage refused = Recorded("x");
  refused.status = PlanStatus::kInvalidRequest;
  refused.result = {};
  EXPECT_EQ(Difference(refused, answer), "");
}

class ReplayTest : public testing::Test {
 protected:
  ReplayTest() { bus_.Start(); }
  Replay Make(std::vector<RunRecordMessage> runs) {
    return {&bus_, &registry_, "run", std::move(runs), {{SceneId(OneBox()), OneBox()}}, {"arm"}};
  }

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
  FakePlanner planner_{&bus_};
};

TEST_F(ReplayTest, AsksAgainWhatWasAskedAndTellsWhatDiffers) {
  RunRecordMessage moved = Recorded("then/b");
  moved.result.result.path[1][0] = 0.75;
  RunRecordMessage without_problem = Recorded("then/c");
  without_problem.request.scene_id = "";
  RunRecordMessage given_up = Recorded("then/e");
  given_up.status = PlanStatus::kNoAnswer;
  given_up.result = {};
  Replay replay =
      Make({Recorded("then/a"), moved, without_problem, given_up, Recorded("then/d", "another")});
  std::vector<std::string> lines;
  EXPECT_FALSE(
      replay.Run([] { return false; }, [&](const std::string& line) { lines.push_back(line); }));
  EXPECT_THAT(lines, ElementsAre("then/b: path, waypoint 1: off by 0.25"));
  EXPECT_THAT(replay.Table(), testing::ContainsRegex("arm +2 +1 +1 +0 +1 +1[.]00 "));

  const std::vector<PlanRequest> requests = planner_.requests().WaitFor(2);
  ASSERT_EQ(requests.size(), 2u);
  PlanRequest as_then = moved.request;
  as_then.run_id = "run";
  as_then.request_id = requests[1].request_id;
  EXPECT_EQ(requests[1], as_then);
  EXPECT_NE(requests[1].request_id, moved.request.request_id);
}

TEST_F(ReplayTest, WhatAPlannerThatHasGoneIsNotAskedDoesNotDiffer) {
  planner_.OnRequest([this](const PlanRequest&) { planner_.FallSilent(); });
  std::vector<RunRecordMessage> runs = {Recorded("then/a"), Recorded("then/b"), Recorded("then/c")};
  for (RunRecordMessage& run : runs) run.request.time_limit_s = 0.1;
  Replay replay(&bus_, &registry_, "run", runs, {{SceneId(OneBox()), OneBox()}}, {"arm"},
                std::chrono::milliseconds(200));
  std::vector<std::string> lines;
  const auto tell = [&](const std::string& line) { lines.push_back(line); };
  EXPECT_FALSE(replay.Run([] { return false; }, tell));
  EXPECT_THAT(lines,
              ElementsAre("then/a: SOLVED, now NO_ANSWER (the process died or fell silent)"));
  EXPECT_THAT(replay.Table(), testing::ContainsRegex("arm +3 +0 +1 +2 "));
  // Nor is it asked, or does it differ, if all that it was asked then is left.
  lines.clear();
  EXPECT_FALSE(Replay(&bus_, &registry_, "run", {runs[0]}, {{SceneId(OneBox()), OneBox()}}, {"arm"},
                      std::chrono::milliseconds(200))
                   .Run([] { return false; }, tell));
  EXPECT_THAT(lines, testing::IsEmpty());
}

TEST_F(ReplayTest, StartsPlannersAnewAfterSoManyProblems) {
  std::vector<RunRecordMessage> runs = {Recorded("then/a"), Recorded("then/b"), Recorded("then/c")};
  runs[2].problem_index = 2;
  std::vector<std::string> started;
  Replay replay(&bus_, &registry_, "run", runs, {{SceneId(OneBox()), OneBox()}}, {"arm"},
                PlannerClient::Terms().patience, 1, [&](const std::string& planner) {
                  started.push_back(planner);
                  planner_.Restart();
                });
  EXPECT_TRUE(
      replay.Run([] { return false; }, [](const std::string& line) { ADD_FAILURE() << line; }));
  EXPECT_THAT(started, ElementsAre("arm"));
}

TEST_F(ReplayTest, HandsOutTheScenes) {
  const Replay replay = Make({Recorded("then/a")});
  MessageCollector<SceneMessage> scenes(&bus_, channel::kScene);
  bus_.Publish(channel::kSceneRequest, SceneRequestMessage{"1", "unknown"});
  bus_.Publish(channel::kSceneRequest, SceneRequestMessage{"2", SceneId(OneBox())});
  const std::vector<SceneMessage> answers = scenes.WaitFor(1);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].request_id, "2");
  EXPECT_EQ(SceneId(answers[0].scene), SceneId(OneBox()));
}

TEST_F(ReplayTest, Interrupted) {
  Replay replay = Make({Recorded("then/a")});
  EXPECT_FALSE(replay.Run([] { return true; }, [](const std::string& line) { FAIL() << line; }));
}

TEST_F(ReplayTest, NeedsRequestsAndTheirScenes) {
  ExpectInputError([&] { Make({Recorded("then/a", "another")}); }, {"'arm'"});
  RunRecordMessage elsewhere = Recorded("then/a");
  elsewhere.request.scene_id = "other";
  ExpectInputError([&] { Make({elsewhere}); }, {"scene other", "then/a"});
}

TEST(MissingRunsTest, AreThoseThatTheSessionHasAndTheLogLacks) {
  RecordedSession recorded;
  recorded.runs.resize(2);
  for (RecordedRun& run : recorded.runs) run.run_id = "then";
  SessionMessage session;
  session.run_id = "then";
  session.num_runs = 5;
  recorded.sessions = {session};
  EXPECT_THAT(MissingRuns("half.lcmlog", recorded),
              ElementsAre(AllOf(HasSubstr("half.lcmlog holds 2 of the 5 runs"),
                                HasSubstr("session then"))));
  session.num_runs = 2;  // two were needless, one was never made: the last word counts
  recorded.sessions.push_back(session);
  EXPECT_THAT(MissingRuns("whole.lcmlog", recorded), testing::IsEmpty());
}

TEST(PlannersAskedTest, InOrder) {
  RunRecordMessage without_problem = Recorded("c", "c");
  without_problem.request.scene_id = "";
  EXPECT_THAT(
      PlannersAsked({Recorded("1", "b"), without_problem, Recorded("2", "a"), Recorded("3", "b")}),
      ElementsAre("b", "a"));
}

}  // namespace
}  // namespace planbench
