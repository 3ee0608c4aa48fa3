#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "messaging/asked_runs.h"
#include "results/outcomes.h"
#include "tests/benchmark_driver/run_executor_fixture.h"

namespace planbench {
namespace {

/// "arm" improves what "first" finds.
class FirstPathTest : public RunExecutorTest {
 protected:
  FirstPathTest() {
    server_.OnPathCheck([](const PathCheckRequestMessage& request) {
      PathCheckReplyMessage reply = FakeSceneServer::Verdict(true);
      reply.verdict->measures["path_length"] = static_cast<double>(request.path.size());
      return reply;
    });
    FirstSearchesBy([](Contestant*) {});
  }
  static constexpr double kTick = 1 / 64.0;  ///< s

  /// By the conditions of "arm", changed.
  void FirstSearchesBy(const std::function<void(Contestant*)>& change,
                       double time_limit_s = 7 * kTick) {
    SessionConditions conditions = Conditions();
    conditions.contestants[0].first_path_of = "first";
    conditions.contestants[0].edge_check = EdgeCheck::kFixed;
    Contestant first = conditions.contestants[0];
    first.planner = first.name = "first";
    first.first_path_of = "";
    change(&first);
    conditions.contestants.push_back(first);
    conditions.request.simplify = conditions.request.anytime = true;
    conditions.request.time_limit_s = time_limit_s;
    executor_.emplace(&bus_, &registry_, conditions);
  }

  RunRecordMessage Execute(PlannerClient* improver) {
    return executor_->Execute(Scheduled(), {&first_client_, improver}, [] { return false; })
        .value();
  }
  RunRecordMessage Execute() { return Execute(&client_); }
  void FirstAnswers(const PlanResult& result) { AnswerWith(result, &first_); }
  static PlanResult Found(double planning_time_s) {
    PlanResult result = FakePlanner::SolvedResult();
    result.path = {{0, 0}, {0.5, 2}, {1, 0.5}};
    result.planning_time_s = result.total_time_s = planning_time_s;
    result.phases.search_s = planning_time_s;
    result.phases.simplification_s = kTick;
    result.simplified_path = FakePath();
    result.cost = 70;  // in a unit of its own
    result.epsilon = 2;
    result.counters = {{"edges_checked", 5}, {"samples", 7}};
    return result;
  }

  /// The answer to a run that "first" has found a path to.
  static void ExpectFirstPath(const RunRecordMessage& record) {
    EXPECT_EQ(record.status, PlanStatus::kSolved) << record.message;
    const PlanResult& result = record.result.result;
    const PlanResult found = Found(kTick);
    EXPECT_EQ(result.path, found.path);
    EXPECT_EQ(result.simplified_path, found.simplified_path);
    EXPECT_GT(result.phases.simplification_s, 0);
    EXPECT_EQ(record.result.joint_names, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(result.planning_time_s, 7 * kTick);
    EXPECT_EQ(result.cost, 3) << "its length";
    EXPECT_EQ(result.epsilon, 0);
    ASSERT_EQ(result.progress.size(), 1u);
    EXPECT_EQ(result.progress.front(), (PlanProgress{7 * kTick, 0, 3, 0}));
  }
  /// "arm" needs longer than the limit.
  void ImproverIsLate() {
    PlanResult late;
    late.status = PlanStatus::kTimedOut;
    late.message = "the path given was not checked in time";
    late.planning_time_s = late.total_time_s = late.phases.search_s = 2 * kTick;
    late.progress = {{2 * kTick, 0, 1, 1}};
    AnswerWith(late);
  }

  FakeSceneServer server_{&bus_};
  FakePlanner first_{&bus_, "first"};
  PlannerClient first_client_{&bus_, &registry_, "first"};
  std::optional<RunExecutor> executor_;
};

TEST_F(FirstPathTest, IsGivenToThePlannerThatImprovesItWithinTheTimeThatIsLeft) {
  FirstSearchesBy([](Contestant* first) { first->collision_model = CollisionModel::kSpheres; });
  PlanResult found = Found(2 * kTick);
  found.planning_time_s = 1.5 * kTick;  // it answers later
  FirstAnswers(found);
  PlanResult better = FakePlanner::SolvedResult();
  better.planning_time_s = 0.5 * kTick;
  better.total_time_s = kTick;
  better.phases.search_s = kTick;
  better.progress = {{0.5 * kTick, 0, 3, 1}};
  better.counters = {{"edges_checked", 10}};
  AnswerWith(better);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved) << record.message;
  EXPECT_EQ(record.result.result.path, FakePath());
  EXPECT_EQ(record.result.result.planning_time_s, 2.5 * kTick);
  EXPECT_EQ(record.result.result.total_time_s, 3 * kTick);
  EXPECT_EQ(record.result.result.phases.search_s, 3 * kTick);
  EXPECT_EQ(record.result.result.phases.simplification_s, 0) << "of a path that is not the answer";
  EXPECT_EQ(record.result.result.progress.at(0).elapsed_s, 2.5 * kTick);
  const auto& counters = record.result.result.counters;
  EXPECT_EQ(counters.at("edges_checked"), 15);
  EXPECT_EQ(counters.at("samples"), 7);
  EXPECT_EQ(counters.at(kFirstPathTime), 2 * kTick);

  const PlanRequest asked_first = first_.requests().messages().at(0);
  EXPECT_THAT(asked_first.request_id, testing::StartsWith("run/cans/2/arm/backward/3/first-path@"));
  EXPECT_EQ(asked_first.collision_model, CollisionModel::kSpheres);
  EXPECT_EQ(asked_first.seed, 9u);
  EXPECT_EQ(asked_first.time_limit_s, 7 * kTick);
  EXPECT_TRUE(asked_first.simplify) << "the path may come to be the answer";
  EXPECT_FALSE(asked_first.anytime);
  EXPECT_TRUE(asked_first.initial_path.empty());
  const PlanRequest asked = planner_.requests().messages().at(0);
  EXPECT_EQ(asked.initial_path, Found(2 * kTick).path);
  EXPECT_EQ(asked.initial_joint_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(asked.collision_model, CollisionModel::kVoxels);
  EXPECT_EQ(asked.time_limit_s, 5 * kTick);
  EXPECT_TRUE(asked.simplify && asked.anytime);
  PlanRequest recorded = asked;
  recorded.time_limit_s = 7 * kTick;
  EXPECT_EQ(record.request, recorded);
}

TEST_F(FirstPathTest, CountersThatAreNoCountsAreNotAddedUp) {
  for (FakePlanner* planner : {&first_, &planner_}) {
    planner->OnRequest([planner](const PlanRequest& request) {
      PlanResult result = Found(kTick);
      result.phases.simplification_s = planner->status.name == "first" ? 500 : 300;
      result.counters[kFirstPathTime] = 7;  // nobody's but the driver's
      std::this_thread::sleep_for(std::chrono::duration<double>(kTick));
      planner->SendResult(request.request_id, result);
    });
  }
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kSolved) << record.message;
  const auto& counters = record.result.result.counters;
  EXPECT_EQ(counters.at("samples"), 14);
  EXPECT_EQ(counters.at(kToldTime), 500 + kTick) << "the longest";
  EXPECT_EQ(counters.at(kFirstPathTime), kTick);
}

TEST_F(FirstPathTest, WithoutOneThereIsNothingToImprove) {
  PlanResult failed;
  failed.status = PlanStatus::kTimedOut;
  failed.message = "too hard";
  FirstAnswers(failed);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kTimedOut);
  EXPECT_EQ(record.message, "first: too hard");
  EXPECT_TRUE(record.request.initial_path.empty());
  EXPECT_TRUE(planner_.requests().messages().empty());
}

TEST_F(FirstPathTest, WithoutAnybodyToImproveItTheRunWasNotAsked) {
  FirstAnswers(Found(kTick));
  PlannerClient given_up(&bus_, &registry_, "nobody", {.given_up = [] { return "given up: it"; }});
  const RunRecordMessage record = Execute(&given_up);
  EXPECT_EQ(record.message, "given up: it");
  EXPECT_FALSE(WasAsked(record));
}

TEST_F(FirstPathTest, IsTheAnswerIfThereIsNoOtherWhenTheLimitComes) {
  FirstAnswers(Found(6 * kTick));
  ImproverIsLate();
  const RunRecordMessage record = Execute();
  ExpectFirstPath(record);
  EXPECT_EQ(record.message, "the path of 'first': 'arm' had 0.0156 s left, and no path by then");
  EXPECT_EQ(record.result.result.total_time_s, 8 * kTick);
}

TEST_F(FirstPathTest, IsNoAnswerIfWhoImprovesItGivesUpBeforeTheLimit) {
  FirstSearchesBy([](Contestant*) {}, 100);
  FirstAnswers(Found(kTick));
  PlanResult early;
  early.status = PlanStatus::kTimedOut;
  early.message = "no wish to";
  AnswerWith(early);
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kTimedOut);
  EXPECT_EQ(record.message, "'arm' ended with 100 of 100 s unused: no wish to");
  EXPECT_TRUE(record.result.result.path.empty());
}

TEST_F(FirstPathTest, IsTheAnswerIfItTookTheWholeTime) {
  FirstAnswers(Found(7 * kTick));
  const RunRecordMessage record = Execute();
  ExpectFirstPath(record);
  EXPECT_EQ(record.message, "the path of 'first': 'arm' had 0 s left, and no path by then");
  EXPECT_TRUE(planner_.requests().messages().empty());
}

TEST_F(FirstPathTest, IsNoAnswerIfItTookLonger) {
  FirstAnswers(Found(8 * kTick));
  const RunRecordMessage record = Execute();
  EXPECT_EQ(record.status, PlanStatus::kTimedOut);
  EXPECT_THAT(record.message, testing::HasSubstr("the planner says that its path is late"));
}

TEST_F(FirstPathTest, IsNoAnswerIfItWasCheckedOtherwise) {
  ImproverIsLate();
  const auto expect_none = [this](double planning_time_s) {
    SCOPED_TRACE(planning_time_s);
    FirstAnswers(Found(planning_time_s));
    const RunRecordMessage record = Execute();
    EXPECT_EQ(record.status, PlanStatus::kTimedOut);
    EXPECT_THAT(record.message,
                testing::HasSubstr(" s left, and no path by then; that of 'first' was found with "
                                   "another collision model or edge check"));
    EXPECT_EQ(record.result.result.status, PlanStatus::kTimedOut);
    EXPECT_TRUE(record.result.result.path.empty());
    EXPECT_TRUE(record.result.result.simplified_path.empty());
    EXPECT_EQ(record.result.result.phases.simplification_s, 0);
    EXPECT_EQ(record.result.result.cost, 0);
  };
  const std::vector<std::function<void(Contestant*)>> changes = {
      [](Contestant* first) { first->collision_model = CollisionModel::kSpheres; },
      [](Contestant* first) { first->edge_check = EdgeCheck::kCertified; },
      [](Contestant* first) { first->edge_resolution_m = 0.05; }};
  for (const auto& change : changes) {
    FirstSearchesBy(change);
    expect_none(6 * kTick);
    expect_none(7 * kTick);
  }
  FirstSearchesBy([](Contestant*) {});
  first_.status.settings["longest_valid_segment_fraction"] = "0.01";
  Reannounce(&registry_, &first_);
  expect_none(7 * kTick);
  EXPECT_TRUE(server_.path_checks().messages().empty());
}

}  // namespace
}  // namespace planbench
