#include "results/outcomes.h"

#include <gtest/gtest.h>

#include "common/numbers.h"

namespace planbench {
namespace {

using Kind = Outcome::Kind;

Attempt Of(PlanStatus status, double time_s, Direction direction = Direction::kForward) {
  const bool claimed = status == PlanStatus::kSolved || status == PlanStatus::kInvalidPath;
  return {"box", 1, "A", 1, direction, status, claimed, time_s, 60};
}

Attempt Backward(PlanStatus status, double time_s) {
  return Of(status, time_s, Direction::kBackward);
}

TEST(FoldAttemptsTest, ForwardSuccessCountsFirst) {
  const Attempt forward = Of(PlanStatus::kSolved, 0.5);
  const Attempt backward = Backward(PlanStatus::kSolved, 0.25);
  const Outcome outcome = FoldAttempts(&forward, &backward);
  EXPECT_EQ(outcome.kind, Kind::kForward);
  EXPECT_TRUE(outcome.claimed);
  EXPECT_TRUE(outcome.confirmed());
  EXPECT_EQ(outcome.time_s, 0.5);
  EXPECT_EQ(outcome.solving_time_s, 0.5);
}

TEST(FoldAttemptsTest, BackwardSuccessBearsTheTimeOfTheFailedForwardAttempt) {
  const Attempt forward = Of(PlanStatus::kTimedOut, 60);
  const Attempt backward = Backward(PlanStatus::kSolved, 0.25);
  const Outcome outcome = FoldAttempts(&forward, &backward);
  EXPECT_EQ(outcome.kind, Kind::kBackward);
  EXPECT_EQ(outcome.time_s, 60.25);
  EXPECT_EQ(outcome.solving_time_s, 0.25);
}

TEST(FoldAttemptsTest, OneDirectionMayBeMissing) {
  const Attempt forward = Of(PlanStatus::kSolved, 0.5);
  EXPECT_EQ(FoldAttempts(&forward, nullptr).kind, Kind::kForward);
  const Attempt backward = Backward(PlanStatus::kSolved, 0.25);
  EXPECT_EQ(FoldAttempts(nullptr, &backward).kind, Kind::kBackward);
  EXPECT_EQ(FoldAttempts(nullptr, &backward).time_s, 0.25);
}

TEST(FoldAttemptsTest, ARejectedPathIsClaimedAndNotConfirmed) {
  const Attempt rejected = Of(PlanStatus::kInvalidPath, 0.5);
  const Outcome outcome = FoldAttempts(&rejected, nullptr);
  EXPECT_EQ(outcome.kind, Kind::kRejected);
  EXPECT_TRUE(outcome.claimed);
  EXPECT_FALSE(outcome.confirmed());
  EXPECT_EQ(outcome.time_s, kInfinity);
}

TEST(FoldAttemptsTest, FailuresAreToldApart) {
  struct Case {
    PlanStatus forward;
    PlanStatus backward;
    Kind kind;
  };
  using enum PlanStatus;
  for (const Case& c : std::vector<Case>{{kTimedOut, kTimedOut, Kind::kFailure},
                                         {kExhausted, kTimedOut, Kind::kFailure},
                                         {kTimedOut, kMemoryLimit, Kind::kFailure},
                                         {kStartInvalid, kStartInvalid, Kind::kUnsolvable},
                                         {kGoalInvalid, kTimedOut, Kind::kUnsolvable},
                                         {kNoAnswer, kGoalInvalid, Kind::kUnsolvable},
                                         {kGoalInvalid, kSolved, Kind::kBackward},
                                         {kTimedOut, kInvalidPath, Kind::kRejected},
                                         {kInvalidPath, kSolved, Kind::kBackward},
                                         {kNoAnswer, kTimedOut, Kind::kNoAnswer},
                                         {kCancelled, kExhausted, Kind::kRefused},
                                         {kInvalidRequest, kInvalidRequest, Kind::kRefused},
                                         {kInvalidRequest, kNoAnswer, Kind::kNoAnswer}}) {
    const Attempt forward = Of(c.forward, 1);
    const Attempt backward = Backward(c.backward, 1);
    EXPECT_EQ(FoldAttempts(&forward, &backward).kind, c.kind)
        << EnumName(c.forward) << " " << EnumName(c.backward);
  }
}

TEST(GroupOutcomesTest, BySetContestantProblemAndTrialInAnyOrder) {
  std::vector<Attempt> attempts;
  for (const char* set : {"box", "cage"}) {
    for (const char* contestant : {"A", "B"}) {
      for (int trial = 1; trial <= 3; ++trial) {
        Attempt attempt = Of(trial == 2 ? PlanStatus::kTimedOut : PlanStatus::kSolved, trial);
        attempt.problem_set = set;
        attempt.contestant = contestant;
        attempt.trial = trial;
        attempts.insert(attempts.begin(), attempt);
      }
    }
  }
  const OutcomesBySet sets = GroupOutcomes(attempts);
  ASSERT_EQ(sets.size(), 2u);
  ASSERT_EQ(sets.at("cage").size(), 2u);
  const Outcomes& outcomes = sets.at("cage").at("B");
  EXPECT_EQ(outcomes.num_runs(), 3);
  EXPECT_EQ(outcomes.time_limit_s, 60);
  ASSERT_EQ(outcomes.by_problem.at(1).size(), 3u);
  EXPECT_EQ(outcomes.by_problem.at(1)[0].time_s, 1);
  EXPECT_EQ(outcomes.by_problem.at(1)[1].time_s, kInfinity);
  EXPECT_EQ(outcomes.by_problem.at(1)[2].time_s, 3);
}

}  // namespace
}  // namespace planbench
