#include "results/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/numbers.h"

namespace planbench {
namespace {

using Kind = Outcome::Kind;

Outcome Solved(double time_s, double solving_time_s) {
  return {.kind = Kind::kForward,
          .claimed = true,
          .time_s = time_s,
          .solving_time_s = solving_time_s,
          .time_limit_s = 10};
}
Outcome Solved(double time_s) { return Solved(time_s, time_s); }
Outcome Failed(Kind kind = Kind::kFailure) {
  return {.kind = kind,
          .claimed = kind == Kind::kRejected,
          .time_s = kInfinity,
          .solving_time_s = kInfinity,
          .time_limit_s = 10};
}

Outcomes Of(std::vector<std::vector<Outcome>> problems) {
  Outcomes outcomes;
  outcomes.time_limit_s = 10;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    outcomes.by_problem[static_cast<int>(i)] = problems[i];
  }
  return outcomes;
}

TEST(SummarizeSuccessTest, CountsRunsAndTakesTheShareOverProblems) {
  const SuccessSummary s = SummarizeSuccess(Of({{Solved(1), Solved(2)},
                                                {Solved(1), Failed(Kind::kRejected)},
                                                {Failed(), Failed()},
                                                {Failed(Kind::kUnsolvable)}}));
  EXPECT_EQ(s.num_problems, 4);
  EXPECT_EQ(s.num_runs, 7);
  EXPECT_EQ(s.claimed, 4);
  EXPECT_EQ(s.confirmed, 3);
  EXPECT_EQ(s.kinds.at(Kind::kForward), 3);
  EXPECT_EQ(s.kinds.at(Kind::kRejected), 1);
  EXPECT_EQ(s.kinds.at(Kind::kFailure), 2);
  EXPECT_EQ(s.kinds.at(Kind::kUnsolvable), 1);
  EXPECT_DOUBLE_EQ(s.share, (1 + 0.5 + 0 + 0) / 4);
  EXPECT_DOUBLE_EQ(s.claimed_share, (1 + 1 + 0 + 0) / 4.0) << "beside it in a figure, and so alike";
  // Wilson's interval solves |share - p| = z sqrt(p (1 - p) / n).
  for (const double p : {s.interval.lower, s.interval.upper}) {
    EXPECT_NEAR(std::abs(s.share - p), 1.959963984540054 * std::sqrt(p * (1 - p) / 4), 1e-12);
  }
}

TEST(SummarizeTimesTest, EveryProblemCountsOnceByTheMedianOfWhatSolvedIt) {
  const TimeSummary s = SummarizeTimes(Of({{Solved(1), Solved(5), Solved(3)},  // 3
                                           {Failed(), Solved(7)},              // 7
                                           {Failed(), Failed()},               // none
                                           {Solved(60.5, 0.5)}}));             // 60.5
  EXPECT_EQ(s.solved_s.count, 3);
  EXPECT_EQ(s.solved_s.median, 7);
  EXPECT_NEAR(s.solved_s.mean, (3 + 7 + 60.5) / 3, 1e-12);
  EXPECT_EQ(s.solving_s.median, 3);   // of 3, 7 and 0.5
  EXPECT_FALSE(s.median_interval_s);  // three values cannot give one
  // Over runs: five solved, three failed as 10 times 10 s.
  EXPECT_NEAR(s.penalised_mean_s, (1 + 5 + 3 + 7 + 60.5 + 3 * 100) / 8, 1e-12);
}

TEST(SummarizeTimesTest, TheMediansIntervalIsOfProblems) {
  std::vector<std::vector<Outcome>> problems;
  for (int i = 1; i <= 6; ++i) problems.push_back({Solved(i), Solved(i), Solved(i)});
  const TimeSummary s = SummarizeTimes(Of(problems));
  ASSERT_TRUE(s.median_interval_s);
  EXPECT_EQ(s.median_interval_s->lower, 1);
  EXPECT_EQ(s.median_interval_s->upper, 6);
}

TEST(CompareTest, PairsProblemsThatBothTried) {
  // 2 against 1 and 8 against 2 lost, alone in solving won, both unsolved a tie, the fifth not
  // tried by the second.
  const Outcomes first = Of({{Solved(2)}, {Solved(8)}, {Solved(1)}, {Failed()}, {Solved(1)}});
  const Outcomes second = Of({{Solved(1)}, {Solved(2)}, {Failed()}, {Failed()}});
  const PairedComparison pair = Compare(first, second);
  EXPECT_EQ(pair.num_problems, 4);
  EXPECT_EQ(pair.wins.won, 1);
  EXPECT_EQ(pair.wins.lost, 2);
  EXPECT_EQ(pair.wins.tied, 1);
  ASSERT_TRUE(pair.ratio);
  EXPECT_NEAR(pair.ratio->mean, std::sqrt(2.0 * 4.0), 1e-12);
  EXPECT_EQ(pair.test.num_differences, 3);
  EXPECT_EQ(pair.test.positive, 1 + 2);  // ranks of log 2 and log 4; the infinite one is the third
  EXPECT_EQ(pair.test.negative, 3);
}

TEST(CompareTest, AProblemIsUnsolvedIfMostOfItsTrialsAre) {
  const Outcomes mostly = Of({{Solved(1), Failed(), Failed()}, {Solved(1), Solved(3), Failed()}});
  const Outcomes always = Of({{Solved(9)}, {Solved(9)}});
  const PairedComparison pair = Compare(mostly, always);
  EXPECT_EQ(pair.wins.won, 1);
  EXPECT_EQ(pair.wins.lost, 1);
  EXPECT_NEAR(pair.ratio->mean, 3.0 / 9, 1e-12);
}

TEST(CompareTest, TellsHowManyProblemsTheRatioIsOf) {
  // Solved by some trial, all four; by more than half of them, half being too few, two.
  const Outcomes first = Of({{Solved(1), Failed()},
                             {Solved(2), Failed(), Solved(4)},
                             {Failed(), Solved(1), Failed()},
                             {Solved(9)}});
  const Outcomes second = Of({{Solved(1)}, {Solved(1)}, {Solved(1)}, {Solved(1)}});
  EXPECT_EQ(SummarizeTimes(first).solved_s.count, 4);
  const PairedComparison pair = Compare(first, second);
  EXPECT_EQ(pair.num_problems, 4);
  EXPECT_EQ(pair.num_in_ratio(), 2);
  EXPECT_NEAR(pair.ratio->mean, std::sqrt(4.0 * 9.0), 1e-12);
  EXPECT_EQ(Compare(Of({{Failed()}}), Of({{Solved(1)}})).num_in_ratio(), 0);
}

TEST(CompareTest, TimesOfNothingAreInNoRatio) {
  const Outcomes first = Of({{Solved(0)}, {Solved(2)}, {Solved(0)}, {Solved(0)}});
  const Outcomes second = Of({{Solved(1)}, {Solved(1)}, {Solved(0)}, {Failed()}});
  const PairedComparison pair = Compare(first, second);
  EXPECT_EQ(pair.num_zero, 2);
  ASSERT_TRUE(pair.ratio);
  EXPECT_EQ(pair.ratio->num_pairs, 1);
  EXPECT_DOUBLE_EQ(pair.ratio->mean, 2);
  // They are the shortest all the same.
  EXPECT_EQ(pair.num_problems, 4);
  EXPECT_EQ(pair.wins.won, 2);
  EXPECT_EQ(pair.wins.tied, 1);
  EXPECT_EQ(pair.test.negative, 2 + 3);
  EXPECT_EQ(ZeroTimesNote({pair, pair}),
            " Left out of the ratios of 2 rows, since a time is 0: 4 problems that both solved in "
            "the median.");
  EXPECT_EQ(ZeroTimesNote({Compare(Of({{Solved(1)}}), Of({{Solved(2)}}))}), "");
}

TEST(TrialSpreadTest, IsTheMedianOfWhatLiesBetweenTrialsThatAllSucceeded) {
  // 3; 2; one failed; one trial.
  EXPECT_EQ(TrialSpread(Of({{Solved(2), Solved(6), Solved(3)},
                            {Solved(4), Solved(2)},
                            {Solved(1), Failed()},
                            {Solved(5)}})),
            2.5);
  EXPECT_FALSE(TrialSpread(Of({{Solved(1)}})));
  EXPECT_FALSE(TrialSpread({}));
}

}  // namespace
}  // namespace planbench
