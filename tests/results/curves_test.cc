#include "results/curves.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "common/random.h"
#include "results/comparison.h"

namespace planbench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Times of the trials of each problem, infinite where it failed.
Outcomes Of(const std::vector<std::vector<double>>& times) {
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
  return Of(times);
}

TEST(SolvedOverTimeTest, IsTheShareOfTrialsSolvedByThenProblemByProblem) {
  std::mt19937_64 random(5);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Outcomes outcomes = Drawn(&random, 7, 3);
    const std::vector<SolvedBy> steps = SolvedOverTime(outcomes);
    ASSERT_FALSE(steps.empty());
    double before = 0;
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

TEST(SolvedOverTimeTest, NothingSolvedHasNoSteps) {
  EXPECT_TRUE(SolvedOverTime(Of({{kInfinity}})).empty());
  EXPECT_TRUE(SolvedOverTime({}).empty());
}

TEST(PerformanceProfilesTest, CountsProblemsWithinTheRatioOfTheFastest) {
  std::mt19937_64 random(6);
  std::map<std::string, Outcomes> all;
  for (const char* name : {"A", "B", "C"}) all[name] = Drawn(&random, 12, 1);
  all["C"].by_problem.erase(4);
  const auto profiles = PerformanceProfiles(all);
  for (const auto& [name, steps] : profiles) {
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
  const auto profiles =
      PerformanceProfiles({{"A", Of({{1}, {kInfinity}})}, {"B", Of({{4}, {kInfinity}})}});
  ASSERT_EQ(profiles.at("A").size(), 1u);
  EXPECT_EQ(profiles.at("A")[0].ratio, 1);
  EXPECT_EQ(profiles.at("A")[0].share, 0.5);
  ASSERT_EQ(profiles.at("B").size(), 1u);
  EXPECT_EQ(profiles.at("B")[0].ratio, 4);
  EXPECT_TRUE(PerformanceProfiles({}).empty());
}

}  // namespace
}  // namespace planbench
