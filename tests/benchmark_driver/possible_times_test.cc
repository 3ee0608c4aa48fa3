#include "benchmark_driver/possible_times.h"

#include <gtest/gtest.h>

#include <vector>

#include "results/outcomes.h"

namespace planbench {
namespace {

constexpr double kLimit = 2;  ///< s

PlanResult EndedAs(PlanStatus status, double total_time_s) {
  PlanResult result;
  result.status = status;
  result.planning_time_s = result.total_time_s = total_time_s;
  if (status == PlanStatus::kSolved) result.path = {{0}, {1}};
  return result;
}

PlanResult KeptPossible(PlanResult result, double roundtrip_time_s, bool is_overdue = false,
                        bool anytime = true) {
  PlanRequest request;
  request.time_limit_s = kLimit;
  request.anytime = anytime;
  KeepTimesPossible(roundtrip_time_s, request, is_overdue, &result);
  return result;
}

TEST(PossibleTimesTest, AFailureThatTellsNoTimeTakesTheRoundTrip) {
  for (const PlanStatus status : {PlanStatus::kTimedOut, PlanStatus::kExhausted}) {
    const PlanResult kept = KeptPossible(EndedAs(status, 0), 1.9);
    EXPECT_EQ(kept.planning_time_s, 1.9);
    EXPECT_EQ(kept.total_time_s, 1.9);
    EXPECT_EQ(kept.counters.at(kUntoldFailure), 1.9);
  }
  const PlanResult refused = KeptPossible(EndedAs(PlanStatus::kInvalidRequest, 0), 1.9);
  EXPECT_EQ(refused.planning_time_s, 0) << "no attempt: it may have waited for a scene";
}

TEST(PossibleTimesTest, TimedOutTellsThatTheLimitCame) {
  const PlanResult kept = KeptPossible(EndedAs(PlanStatus::kTimedOut, 0.001), 1.9);
  EXPECT_EQ(kept.planning_time_s, 1.9);
  EXPECT_DOUBLE_EQ(kept.counters.at(kUntoldFailure), 1.899);
  // What comes beyond it may be loading.
  const PlanResult late = KeptPossible(EndedAs(PlanStatus::kTimedOut, 0), 9);
  EXPECT_EQ(late.planning_time_s, kLimit);
  EXPECT_EQ(late.counters.at(kUntoldTime), 9 - kLimit);
  const PlanResult overdue = KeptPossible(EndedAs(PlanStatus::kSolved, 0.001), 17.5, true);
  EXPECT_EQ(overdue.planning_time_s, kLimit) << "though a path, it is none";
}

TEST(PossibleTimesTest, AnHonestFailureTakesWhatItTells) {
  const auto expect_told = [](PlanStatus status, double told_s, double roundtrip_time_s) {
    SCOPED_TRACE(told_s);
    const PlanResult kept = KeptPossible(EndedAs(status, told_s), roundtrip_time_s);
    EXPECT_EQ(kept.planning_time_s, told_s);
    EXPECT_FALSE(kept.counters.contains(kUntoldFailure));
  };
  expect_told(PlanStatus::kTimedOut, 2.1, 3.5);     // its memory had to be freed
  expect_told(PlanStatus::kTimedOut, 0.001, 0.05);  // it gave up at once, on a slow bus
  expect_told(PlanStatus::kTimedOut, 0.9, 1.7);     // early, on a busy machine
  expect_told(PlanStatus::kExhausted, 0.001, 1.9);  // meshes had to be loaded
  expect_told(PlanStatus::kExhausted, 0, 0.05);     // a clock that read the same twice
  expect_told(PlanStatus::kMemoryLimit, 0.5, 1.9);
}

TEST(PossibleTimesTest, AFailureCountsToTheEndOfItsSearch) {
  PlanResult failed = EndedAs(PlanStatus::kTimedOut, 2);
  failed.planning_time_s = 0;
  EXPECT_EQ(KeptPossible(failed, 2).planning_time_s, 2);
  PlanResult solved = EndedAs(PlanStatus::kSolved, 2);
  solved.planning_time_s = 0.1;
  EXPECT_EQ(KeptPossible(solved, 2).planning_time_s, 0.1);
  solved.planning_time_s = 2.01;
  solved.total_time_s = 9;
  EXPECT_EQ(KeptPossible(solved, 9).planning_time_s, 9) << "late by its own word, it is a failure";
}

TEST(PossibleTimesTest, APathIsNotThereBeforeItsFirstImprovement) {
  PlanResult solved = EndedAs(PlanStatus::kSolved, 0.5);
  solved.planning_time_s = 0.001;
  solved.progress = {{0.4, 0, 2, 1}, {0.45, 0, 1, 2}};
  const PlanResult kept = KeptPossible(solved, 0.5);
  EXPECT_EQ(kept.planning_time_s, 0.4);
  EXPECT_EQ(kept.counters.at(kContradictoryTime), 0.4 - 0.001);
  solved.total_time_s = 0.001;
  const PlanResult told_short = KeptPossible(solved, 0.5);
  EXPECT_EQ(told_short.planning_time_s, 0.4);
  EXPECT_EQ(told_short.total_time_s, 0.4);
  EXPECT_EQ(told_short.counters.at(kContradictoryTime), 0.45 - 0.001);
  solved.total_time_s = 0.5;
  solved.planning_time_s = 0.399;
  EXPECT_TRUE(KeptPossible(solved, 0.5).counters.empty()) << "two looks at the clock";
  // A path in hand when the limit came is told of when the search ends.
  solved.planning_time_s = kLimit;
  solved.total_time_s = 2.2;
  solved.progress = {{2.2, 0, 2, 1}};
  const PlanResult in_hand = KeptPossible(solved, 2.2);
  EXPECT_EQ(in_hand.planning_time_s, kLimit);
  EXPECT_TRUE(in_hand.counters.empty());
}

TEST(PossibleTimesTest, WhoIsNotAskedForBetterPathsPlansUntilTheSearchEnds) {
  const auto planning_time_s = [](double told_s, double total_time_s, double contradiction_s,
                                  bool anytime = false) {
    PlanResult solved = EndedAs(PlanStatus::kSolved, total_time_s);
    solved.planning_time_s = told_s;
    PlanResult kept = KeptPossible(solved, total_time_s, false, anytime);
    EXPECT_EQ(kept.counters[kContradictoryTime], contradiction_s);
    return kept.planning_time_s;
  };
  EXPECT_EQ(planning_time_s(0.001, 0.5, 0.5 - 0.001), 0.5);
  EXPECT_EQ(planning_time_s(0.001, 2.5, kLimit - 0.001), kLimit) << "in hand when the limit came";
  EXPECT_EQ(planning_time_s(kLimit, 2.5, 0), kLimit) << "it wanted a better bound";
  EXPECT_EQ(planning_time_s(0.4995, 0.5, 0), 0.5) << "two looks at the clock";
  EXPECT_EQ(planning_time_s(0.001, 0.5, 0, /*anytime=*/true), 0.001);
}

TEST(PossibleTimesTest, NoImprovementIsCheaperThanThePath) {
  PlanResult solved = EndedAs(PlanStatus::kSolved, 0.5);
  solved.planning_time_s = 0.1;
  solved.progress = {{0.1, 0, 4, 1}, {0.2, 0, 2, 2}, {0.3, 0, 1, 3}};
  for (const double cost : {1 + 1e-9, 1.0, 0.5, 0.0}) {  // the last: none is told
    solved.cost = cost;
    const PlanResult kept = KeptPossible(solved, 0.5);
    EXPECT_TRUE(kept.counters.empty()) << cost;
    EXPECT_EQ(kept.progress, solved.progress) << cost;
  }
  solved.cost = 3;
  const PlanResult kept = KeptPossible(solved, 0.5);
  EXPECT_EQ(kept.counters.at(kContradictoryCost), 2);
  EXPECT_EQ(kept.progress,
            (std::vector<PlanProgress>{{0.1, 0, 4, 1}, {0.2, 0, 3, 2}, {0.3, 0, 3, 3}}));
}

TEST(PossibleTimesTest, ASearchThatGoesOnAfterTheLimitIsNoted) {
  const auto overrun_of = [](double planning_time_s, double total_time_s, PlanStatus status) {
    PlanResult result = EndedAs(status, total_time_s);
    result.planning_time_s = planning_time_s;
    return KeptPossible(result, total_time_s).counters[kOverrunTime];
  };
  EXPECT_EQ(overrun_of(0.001, 5, PlanStatus::kSolved), 5 - kLimit);
  EXPECT_EQ(overrun_of(0.001, 2.6, PlanStatus::kSolved), 0) << "it looked seldom at the clock";
  EXPECT_EQ(overrun_of(5, 5, PlanStatus::kSolved), 0) << "its path comes too late";
  EXPECT_EQ(overrun_of(5, 5, PlanStatus::kTimedOut), 0) << "which its time tells";
}

}  // namespace
}  // namespace planbench
