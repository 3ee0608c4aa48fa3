#include "results/curves.h"

#include <gtest/gtest.h>

#include <random>

#include "common/numbers.h"
#include "common/random.h"
#include "results/comparison.h"

namespace planbench {
namespace {

/// Times of the trials of each problem, infinite where it failed.
Outcomes OutcomesOf(const std::vector<std::vector<double>>& times) {
  Outcomes outcomes;
  outcomes.time_limit_s = 10;
  for (std::size_t problem = 0; problem < times.size(); ++problem) {
    for (const double time : times[problem]) {
      const bool solved = time < kInfinity;
      outcomes.by_problem[static_cast<int>(problem)].push_back(
          {solved ? Outcome::Kind::kForward : Outcome::Kind::kFailure, solved, time, time});
    }
  }
  return outcomes;
}

Outcomes Drawn(std::mt19937_64* random, int num_problems, int num_trials) {
  std::vector<std::vector<double>> times(static_cast<std::size_t>(num_problems));
  for (auto& trials : times) {
    for (int t = 0; t < num_trials; ++t) {
      const double u = UniformFraction(random);
      // Some fail, some times come more than once.
      trials.push_back(u < 0.2 ? kInfinity : std::ceil(20 * u) / 2);
    }
  }
  return OutcomesOf(times);
}

TEST(SolvedOverTimeTest, IsTheShareOfTrialsSolvedByThenProblemByProblem) {
  std::mt19937_64 random(5);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Outcomes outcomes = Drawn(&random, 7, 3);
    const std::vector<SolvedBy> steps = SolvedOverTime(outcomes);
    ASSERT_FALSE(steps.empty());
    // Nothing is solved in no time, and how sure that is is known from the beginning.
    EXPECT_EQ(steps.front().time_s, 0);
    EXPECT_EQ(steps.front().share, 0);
    EXPECT_EQ(steps.front().interval.upper, WilsonInterval(0, 7).upper);
    double before = -1;
    for (const SolvedBy& step : steps) {
      double sum = 0;
      for (const auto& [problem, trials] : outcomes.by_problem) {
        double solved = 0;
        for (const Outcome& trial : trials) solved += trial.time_s <= step.time_s;
        sum += solved / 3;
      }
      EXPECT_NEAR(step.share, sum / 7, 1e-12);
      EXPECT_GT(step.share, before);
      EXPECT_LE(step.interval.lower, step.share);
      EXPECT_GE(step.interval.upper, step.share);
      before = step.share;
    }
    const SuccessSummary success = SummarizeSuccess(outcomes);
    EXPECT_NEAR(steps.back().share, success.share, 1e-12);
    EXPECT_NEAR(steps.back().interval.lower, success.interval.lower, 1e-9);
  }
}

TEST(SolvedOverTimeTest, NothingSolvedHasTheFirstStepAlone) {
  const std::vector<SolvedBy> steps = SolvedOverTime(OutcomesOf({{kInfinity}, {kInfinity}}));
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].share, 0);
  EXPECT_EQ(steps[0].interval.lower, 0);
  EXPECT_EQ(steps[0].interval.upper, WilsonInterval(0, 2).upper);
  EXPECT_TRUE(SolvedOverTime({}).empty());
}

TEST(PerformanceProfilesTest, CountsProblemsWithinTheRatioOfTheFastest) {
  std::mt19937_64 random(6);
  std::map<std::string, Outcomes> all;
  for (const char* name : {"A", "B", "C"}) all[name] = Drawn(&random, 12, 1);
  all["C"].by_problem.erase(4);
  const PerformanceProfiles profiles = ProfileTimes(all);
  EXPECT_EQ(profiles.num_problems, 11);
  for (const auto& [name, steps] : profiles.by_contestant) {
    ASSERT_FALSE(steps.empty());
    for (const ProfileStep& step : steps) {
      int within = 0;
      for (int problem = 0; problem < 12; ++problem) {
        if (problem == 4) continue;
        double best = kInfinity;
        for (const auto& [other, outcomes] : all) {
          best = std::min(best, outcomes.by_problem.at(problem)[0].time_s);
        }
        const double time = all.at(name).by_problem.at(problem)[0].time_s;
        within += time < kInfinity && time <= step.ratio * best * (1 + 1e-12);
      }
      EXPECT_NEAR(step.share, within / 11.0, 1e-12) << name << " at " << step.ratio;
    }
  }
}

TEST(PerformanceProfilesTest, WhatNobodySolvedCountsAgainstAll) {
  const PerformanceProfiles profiles =
      ProfileTimes({{"A", OutcomesOf({{1}, {kInfinity}})}, {"B", OutcomesOf({{4}, {kInfinity}})}});
  ASSERT_EQ(profiles.by_contestant.at("A").size(), 1u);
  EXPECT_EQ(profiles.by_contestant.at("A")[0].ratio, 1);
  EXPECT_EQ(profiles.by_contestant.at("A")[0].share, 0.5);
  ASSERT_EQ(profiles.by_contestant.at("B").size(), 1u);
  EXPECT_EQ(profiles.by_contestant.at("B")[0].ratio, 4);
  EXPECT_EQ(profiles.num_problems, 2);
  EXPECT_TRUE(ProfileTimes({}).by_contestant.empty());
}

TEST(PerformanceProfilesTest, NothingIsDividedByATimeOfNothing) {
  const PerformanceProfiles profiles = ProfileTimes(
      {{"A", OutcomesOf({{0, 0, 1}, {1}, {1}})}, {"B", OutcomesOf({{2}, {2}, {kInfinity}})}});
  EXPECT_EQ(profiles.num_problems, 2);
  ASSERT_EQ(profiles.by_contestant.at("A").size(), 1u);
  EXPECT_EQ(profiles.by_contestant.at("A")[0].share, 1);
  ASSERT_EQ(profiles.by_contestant.at("B").size(), 1u);
  EXPECT_EQ(profiles.by_contestant.at("B")[0].ratio, 2);
  EXPECT_EQ(profiles.by_contestant.at("B")[0].share, 0.5);
}

StoredRun AnytimeRun(int problem, std::vector<PlanProgress> progress, int trial = 1) {
  StoredRun run;
  run.problem_index = problem;
  run.trial = trial;
  run.status = PlanStatus::kSolved;
  run.progress = std::move(progress);
  return run;
}

std::vector<const StoredRun*> PointersTo(const std::vector<StoredRun>& runs) {
  std::vector<const StoredRun*> pointers;
  for (const StoredRun& run : runs) pointers.push_back(&run);
  return pointers;
}

AnytimeCurves CurvesOf(const std::vector<StoredRun>& runs) {
  return ImprovementOverTime(PointersTo(runs), FindLowestCosts(PointersTo(runs)));
}

TEST(ImprovementOverTimeTest, QuartilesOverTheProblemsOfWhatThereIsInHand) {
  // Costs over the lowest of each problem: 4, 2, 1 and 3.
  const std::vector<StoredRun> runs = {
      AnytimeRun(1, {{0.1, 8, 40, 1}, {1, 4, 20, 2}, {10, 1, 10, 3}}),
      AnytimeRun(2, {{0.5, 0, 6, 1}}), AnytimeRun(3, {{0.1, 5, 2, 1}})};
  const AnytimeCurves curves =
      ImprovementOverTime(PointersTo(runs), LowestCosts{{1, 10}, {2, 2}, {3, 2}});
  ASSERT_EQ(curves.cost.size(), static_cast<std::size_t>(kAnytimeSteps));
  const AnytimeStep& first = curves.cost.front();
  EXPECT_EQ(first.time_s, 0.1);
  EXPECT_EQ(first.lower, 2.5);  // between 1 and 4
  EXPECT_EQ(first.median, 4);
  EXPECT_EQ(first.upper, std::nullopt);  // one of three has nothing yet
  const AnytimeStep& last = curves.cost.back();
  EXPECT_EQ(last.time_s, 10);
  EXPECT_EQ(last.lower, 1);
  EXPECT_EQ(last.median, 1);
  EXPECT_EQ(last.upper, 2);  // between 1 and 3
  // Halfway, by the definition: from 1 s on the first has 20 / 10.
  for (const AnytimeStep& step : curves.cost) {
    const double a = step.time_s < 1 ? 4 : step.time_s < 10 ? 2 : 1;
    if (step.time_s < 0.5) continue;
    EXPECT_EQ(step.median, std::min(a, 3.0)) << step.time_s;
  }
  // The second tells no bound.
  EXPECT_EQ(curves.bound.front().median, 8);
  EXPECT_EQ(curves.bound.back().lower, 3);  // between 1 and 5
}

TEST(ImprovementOverTimeTest, WhatCostsNothingIsTheBestThereIs) {
  const std::vector<StoredRun> runs = {AnytimeRun(1, {{0.1, 4, 40, 1}, {1, 2, 20, 2}}),
                                       AnytimeRun(2, {{0.1, 1, 0, 0}})};
  EXPECT_EQ(FindLowestCosts(PointersTo(runs)), (LowestCosts{{1, 20}, {2, 0}}));
  const AnytimeCurves curves = CurvesOf(runs);
  EXPECT_EQ(curves.cost.front().lower, 1.25);  // between 1 and 2
  EXPECT_EQ(curves.cost.back().upper, 1);
  EXPECT_EQ(curves.bound.back().lower, 1.25);
  EXPECT_EQ(curves.bound.back().upper, 1.75);
  // Without a bound 0 is no cost.
  const std::vector<StoredRun> untold = {AnytimeRun(1, {{0.1, 0, 0, 1}})};
  EXPECT_TRUE(FindLowestCosts(PointersTo(untold)).empty());
}

TEST(ImprovementOverTimeTest, AProblemCountsOnceByTheMedianOfItsTrials) {
  const std::vector<PlanProgress> good = {{1, 0, 20, 1}, {2, 0, 10, 1}};
  std::vector<StoredRun> runs = {AnytimeRun(1, good, 1), AnytimeRun(1, good, 2),
                                 AnytimeRun(1, {{1, 0, 40, 1}}, 3), AnytimeRun(2, {{1, 0, 7, 1}})};
  const AnytimeStep last = CurvesOf(runs).cost.back();
  EXPECT_EQ(last.lower, 1);
  EXPECT_EQ(last.median, 1);
  EXPECT_EQ(last.upper, 1);
  // Of an even number without a path in hand in half of them there is none.
  runs[2].trial = 4;
  runs.push_back(AnytimeRun(1, {}, 3));
  runs[1].status = PlanStatus::kTimedOut;
  EXPECT_EQ(CurvesOf(runs).cost.back().upper, std::nullopt);
}

TEST(ImprovementOverTimeTest, WhatTheRefereeRejectedIsNotInHand) {
  std::vector<StoredRun> runs = {AnytimeRun(1, {{1, 3, 20, 1}, {2, 2, 10, 1}}),
                                 AnytimeRun(2, {{1, 3, 9, 1}, {4, 2, 3, 1}})};
  EXPECT_EQ(CurvesOf(runs).cost.back().upper, 1);
  runs[1].status = PlanStatus::kInvalidPath;
  const AnytimeCurves curves = CurvesOf(runs);
  EXPECT_EQ(curves.cost.back().time_s, 2) << "nothing improves after that";
  EXPECT_EQ(curves.cost.back().lower, std::nullopt);  // between 1 and nothing
  EXPECT_EQ(curves.bound.back().median, std::nullopt);
  EXPECT_EQ(FindLowestCosts(PointersTo(runs)), (LowestCosts{{1, 10}}));
}

TEST(ImprovementOverTimeTest, AnAttemptThatFailedBeforeTakesItsTime) {
  std::vector<StoredRun> runs = {AnytimeRun(1, {}), AnytimeRun(1, {{1, 0, 20, 1}, {2, 0, 10, 1}})};
  runs[0].status = PlanStatus::kTimedOut;
  runs[0].time_s = 5;
  runs[1].direction = Direction::kBackward;
  runs[1].time_s = 1;
  EXPECT_EQ(CurvesOf(runs).cost.front().time_s, 6);
  EXPECT_EQ(CurvesOf(runs).cost.front().median, 2);
  EXPECT_EQ(CurvesOf(runs).cost.back().time_s, 7);
  // One that solved it is the run.
  runs[0].status = PlanStatus::kSolved;
  runs[0].progress = {{3, 0, 30, 1}, {4, 0, 15, 1}};
  EXPECT_EQ(CurvesOf(runs).cost.back().time_s, 4);
  EXPECT_EQ(CurvesOf(runs).cost.back().median, 1.5) << "over the lowest of either direction";
}

TEST(ImprovementOverTimeTest, WhatComesAfterTheLimitIsNotInHand) {
  std::vector<StoredRun> runs = {AnytimeRun(1, {{1, 0, 20, 1}, {2, 0, 10, 1}, {2.1, 0, 5, 1}}),
                                 AnytimeRun(2, {{2.1, 0, 9, 1}, {2.2, 0, 3, 1}})};
  EXPECT_EQ(CurvesOf(runs).cost.back().time_s, 2.2) << "the limit is not known";
  for (StoredRun& run : runs) run.time_limit_s = 2;
  EXPECT_EQ(FindLowestCosts(PointersTo(runs)), (LowestCosts{{1, 10}, {2, 9}}));
  const AnytimeStep last = CurvesOf(runs).cost.back();
  EXPECT_EQ(last.time_s, 2.1) << "of the path that was in hand";
  EXPECT_EQ(last.upper, 1);
}

TEST(ImprovementOverTimeTest, IsNothingWhereNothingImproved) {
  EXPECT_TRUE(CurvesOf({}).cost.empty());
  EXPECT_TRUE(CurvesOf({AnytimeRun(1, {}), AnytimeRun(2, {{1, 2, 3, 4}})}).cost.empty());
  EXPECT_TRUE(CurvesOf({AnytimeRun(1, {{1, 0, 3, 4}, {2, 0, 2, 4}})}).bound.empty());
}

TEST(CostsAreLengthsTest, WhereTheLastIsThatOfThePath) {
  std::vector<StoredRun> runs = {AnytimeRun(1, {{1, 0, 20, 1}, {2, 0, 10, 1}}),
                                 AnytimeRun(2, {{1, 0, 7, 1}}), AnytimeRun(3, {{1, 0, 9, 1}})};
  EXPECT_FALSE(CostsAreLengths(PointersTo(runs))) << "nothing was measured";
  runs[0].measures["path_length"] = 10;
  runs[1].measures["path_length"] = 7 * (1 + 1e-12);
  EXPECT_TRUE(CostsAreLengths(PointersTo(runs)));
  runs[2].measures["path_length"] = 8;  // a better one that was not told
  EXPECT_TRUE(CostsAreLengths(PointersTo(runs)));
  runs[1].measures["path_length"] = 3;
  EXPECT_FALSE(CostsAreLengths(PointersTo(runs)));
  EXPECT_FALSE(CostsAreLengths({}));
}

}  // namespace
}  // namespace planbench
