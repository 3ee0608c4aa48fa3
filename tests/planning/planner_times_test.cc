#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "common/stopwatch.h"
#include "planning/planner.h"
#include "tests/planning/scripted_planner_test.h"

namespace planbench {
namespace {

// What a planner's clocks measure, and what the time limit ends.

using PlannerTimesTest = ScriptedPlannerTest;

TEST_F(PlannerTimesTest, PhasesAddUpToTheTotalTime) {
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        SearchResult found = StraightLine(query);
        EXPECT_TRUE(query.edges().IsValidEdge(query.start(), query.goal().nominal));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        const std::uint64_t begin = Ticks::Now();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        found.guidance_ticks = Ticks::Since(begin);
        found.counters["expansions"] = 12;
        found.cost = 12;
        found.lower_bound = 4;
        return found;
      },
      Request());
  const PhaseTimes& phases = result.phases;
  EXPECT_GT(phases.setup_s, 0);
  EXPECT_GT(phases.collision_s, 0);
  EXPECT_GE(phases.guidance_s, 0.0099);
  EXPECT_GE(phases.search_s, 0.0199);
  EXPECT_NEAR(phases.setup_s + phases.collision_s + phases.guidance_s + phases.search_s,
              result.total_time_s, 1e-12);
  EXPECT_EQ(result.planning_time_s, result.total_time_s);
  EXPECT_EQ(result.counters.at("expansions"), 12);
  EXPECT_EQ(result.counters.at("edges_checked"), 1);
  EXPECT_GT(result.counters.at("configurations_checked"), 2);
  EXPECT_EQ(result.epsilon, 3);
  EXPECT_EQ(result.cost, 12);
  EXPECT_GT(result.peak_memory_mb, 1);
}

TEST_F(PlannerTimesTest, AStartThatIsInTheGoalCostsNothing) {
  PlanRequest request = MakeRequest(robot_, start_, start_, 0.1);
  for (const bool anytime : {false, true}) {
    request.anytime = anytime;
    const PlanResult result = Plan(StraightLine, request);
    EXPECT_EQ(num_searches_, 0);
    EXPECT_EQ(result.status, PlanStatus::kSolved);
    EXPECT_EQ(result.path, Path{start_});
    EXPECT_EQ(result.cost, 0);
    EXPECT_EQ(result.epsilon, 1);
    ASSERT_EQ(result.progress.size(), anytime ? 1u : 0u);
    if (!anytime) continue;
    const double elapsed_s = result.progress[0].elapsed_s;
    EXPECT_EQ(result.progress[0], (PlanProgress{elapsed_s, 1, 0, 0}));
    EXPECT_EQ(result.planning_time_s, elapsed_s);
  }
  PlannerDescription without_costs = ScriptedPlanner::Able();
  without_costs.anytime = false;
  ScriptedPlanner planner(robot_, StraightLine, without_costs);
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.path, Path{start_});
  EXPECT_EQ(result.epsilon, 0);
  EXPECT_TRUE(result.progress.empty());
}

TEST_F(PlannerTimesTest, TheFirstReportedSolutionStopsThePlanningClock) {
  PlanRequest request = Request();
  request.anytime = true;
  PlanControl control;
  std::vector<PlanProgress> seen;
  control.on_progress = [&seen](const PlanProgress& progress) { seen.push_back(progress); };
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        EXPECT_TRUE(query.anytime());
        query.ReportSolution(50, 500, 7);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        query.ReportSolution(400, 400, 70);
        query.ReportSolution(400, 400, 80);  // no news
        query.ReportSolution(300, 390, 90);  // less proof
        query.ReportSolution(0, 380, 100);   // none
        return StraightLine(query);
      },
      request, EmptyPlanarScene(), &control);
  ASSERT_EQ(result.progress.size(), 2u);
  EXPECT_EQ(seen.size(), 2u);
  EXPECT_EQ(result.planning_time_s, result.progress[0].elapsed_s);
  EXPECT_GE(result.total_time_s, result.planning_time_s + 0.02);
  EXPECT_EQ(result.progress[1].epsilon, 1);
  EXPECT_EQ(result.progress[1].cost, 400);
  EXPECT_EQ(result.progress[1].expansions, 70);
}

TEST_F(PlannerTimesTest, WithoutAnytimeTheEndOfTheSearchStopsThePlanningClock) {
  PlanControl control;
  bool told = false;
  control.on_progress = [&told](const PlanProgress&) { told = true; };
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        query.ReportSolution(50, 500, 7);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return StraightLine(query);
      },
      Request(), EmptyPlanarScene(), &control);
  EXPECT_GE(result.planning_time_s, 0.02);
  EXPECT_EQ(result.planning_time_s, result.total_time_s);
  EXPECT_TRUE(result.progress.empty());
  EXPECT_FALSE(told);
}

TEST_F(PlannerTimesTest, FreeingWhatTheSearchWasMadeOfCountsForNobody) {
  static constexpr double kFreeingS = 0.3;
  const Stopwatch clock;
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        SearchResult found = StraightLine(query);
        const auto free = [](void*) {
          std::this_thread::sleep_for(std::chrono::duration<double>(kFreeingS));
        };
        found.remains = std::shared_ptr<void>(nullptr, free);
        return found;
      },
      Request());
  EXPECT_GE(clock.seconds(), kFreeingS);
  EXPECT_LT(result.total_time_s, kFreeingS);
  EXPECT_LT(result.phases.simplification_s, kFreeingS);
}

TEST_F(PlannerTimesTest, DeadlineAndCancellation) {
  PlanRequest request = Request();
  request.time_limit_s = 0.05;
  const auto until_stopped = [](SearchQuery& query) {
    while (!query.ShouldStop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return Ended(query.Cancelled() ? PlanStatus::kCancelled : PlanStatus::kTimedOut);
  };
  const PlanResult late = Plan(until_stopped, request);
  EXPECT_EQ(late.status, PlanStatus::kTimedOut);
  EXPECT_EQ(late.message, "because");
  EXPECT_GE(late.planning_time_s, 0.05);
  EXPECT_TRUE(late.path.empty());

  request.time_limit_s = 1000;
  PlanControl control;
  control.cancelled = true;
  EXPECT_EQ(Plan(until_stopped, request, EmptyPlanarScene(), &control).status,
            PlanStatus::kCancelled);
  const PlanResult remaining = Plan(
      [](SearchQuery& query) {
        EXPECT_LE(query.RemainingSeconds(), 1000);
        EXPECT_GT(query.RemainingSeconds(), 900);
        EXPECT_FALSE(query.ShouldStop());
        return StraightLine(query);
      },
      request);
  EXPECT_EQ(remaining.status, PlanStatus::kSolved);
}

TEST_F(PlannerTimesTest, ASolutionAfterTheLimitIsNone) {
  PlanRequest request = Request();
  request.time_limit_s = 0.01;
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return StraightLine(query);
      },
      request);
  EXPECT_EQ(result.status, PlanStatus::kTimedOut);
  EXPECT_TRUE(result.path.empty());
  EXPECT_THAT(result.message, testing::HasSubstr("0.01"));
}

TEST_F(PlannerTimesTest, APathHeldWhenTheLimitComesIsASolution) {
  PlanRequest request = Request();
  request.time_limit_s = 0.01;
  const PlanResult result = Plan(
      [](SearchQuery& query) {
        query.HoldPath();
        while (!query.ShouldStop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return StraightLine(query);
      },
      request);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_FALSE(result.path.empty());
  EXPECT_EQ(result.planning_time_s, request.time_limit_s);
}

}  // namespace
}  // namespace planbench
