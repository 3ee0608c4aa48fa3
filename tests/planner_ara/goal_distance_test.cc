#include "planner_ara/goal_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/numbers.h"
#include "tests/planner_ara/point_goal.h"

namespace planbench {
namespace {

JointSpace TestSpace() {
  return JointSpace({{"lift", false, true, 0.0, 0.4, 0.1},
                     {"elbow", false, false, -1.0, 2.0, 1.0},
                     {"roll", true, false, -kPi, kPi, 1.0}});
}

TEST(GoalDistance, OfAPointIsTheWeightedDistance) {
  const JointSpace space = TestSpace();
  const Configuration goal{0.1, 1.0, 3.0};
  const std::vector<double> weights{10, 1, 2};
  const GoalDistance distance(space, PointGoal(goal), weights);
  EXPECT_FALSE(distance.has_extent());
  const Configuration q{0.3, 0.5, -3.0};
  // Roll goes the short way: 2 pi - 6.
  const double expected = std::sqrt(4 + 0.25 + std::pow(2 * (2 * kPi - 6), 2));
  EXPECT_NEAR(distance(q), expected, 1e-12);
  EXPECT_NEAR(WeightedDistance(space, weights, q, goal), expected, 1e-12);
  Configuration nearest(3);
  distance.Nearest(q, nearest);
  EXPECT_EQ(nearest, goal);
}

TEST(GoalDistance, RoundAWallIsThatOfTheOtherWay) {
  const JointSpace space = TestSpace();
  const GoalBox box{{0.1, 1.0, 3.0}, {0.1, 1.0, 2.9}, {0.1, 1.0, 3.1}};
  const GoalDistance distance(space, box, {1, 1, 2});
  // The wall is beyond pi, as seen from the goal: from -3 the way is round by 0.
  const std::vector<double> values = {2.0, 2.95, 3.12, -3.0, 0.0};
  const std::vector<double> ways = {0.9, 0, 0.02, 5.9, 2.9};
  const std::vector<double> terms = distance.SquaredTermsRound(2, values, -3.1);
  ASSERT_EQ(terms.size(), values.size());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    EXPECT_NEAR(terms[i], std::pow(2 * ways[i], 2), 1e-12) << values[i];
  }
}

TEST(GoalDistance, OfABoxIsTheDistanceToItsNearestPoint) {
  const JointSpace space = TestSpace();
  const GoalBox box{{0.2, 1.0, 3.1}, {0.1, 0.8, 2.9}, {0.25, 1.5, 3.3}};  // roll across pi
  const GoalDistance distance(space, box, {1, 1, 1});
  EXPECT_TRUE(distance.has_extent());
  struct Case {
    Configuration q;
    Configuration nearest;
  };
  const std::vector<Case> cases = {
      {{0.0, 0.0, 0.0}, {0.1, 0.8, 2.9}},
      {{0.4, 2.0, -1.0}, {0.25, 1.5, 3.3}},
      {{0.15, 1.2, 3.0}, {0.15, 1.2, 3.0}},
      {{0.15, 1.2, -3.1}, {0.15, 1.2, -3.1}},  // inside, on the other side of pi
      {{0.15, 1.2, -2.9}, {0.15, 1.2, 3.3}},
  };
  for (const Case& test : cases) {
    Configuration nearest(3);
    distance.Nearest(test.q, nearest);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(nearest[j], test.nearest[j], 1e-12) << j;
    EXPECT_TRUE(box.Contains(space, nearest));
    EXPECT_NEAR(distance(test.q), space.Distance(test.q, nearest), 1e-12);
  }
  for (int j = 0; j < 3; ++j) {
    std::vector<double> values;
    for (int k = -40; k <= 40; ++k) values.push_back(0.1 * k);
    const std::vector<double> terms = distance.SquaredTerms(j, values);
    ASSERT_EQ(terms.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      EXPECT_EQ(terms[k], distance.SquaredTerm(j, values[k])) << values[k];
    }
  }
}

TEST(GoalDistance, BoxEndsAtTheLimits) {
  const JointSpace space = TestSpace();
  const GoalBox box{{0.3, 1.9, 0}, {-1, 1.0, -9}, {5, 3.0, 9}};
  const GoalDistance distance(space, box, {1, 1, 1});
  const Configuration q{0.4, 2.0, 2.0};
  EXPECT_EQ(distance(q), 0);
  Configuration nearest(3);
  distance.Nearest(Configuration{0.4 + 0.1, 2.0 + 0.5, -3.1}, nearest);
  EXPECT_NEAR(nearest[0], 0.4, 1e-12);
  EXPECT_NEAR(nearest[1], 2.0, 1e-12);
  EXPECT_NEAR(nearest[2], -3.1, 1e-12);  // any roll will do
}

TEST(GoalDistance, NominalPointBelongsToTheGoalEvenJustOutsideTheLimits) {
  const JointSpace space = TestSpace();
  const Configuration goal{0.4 + 5e-7, 1.0, 0.0};
  const GoalDistance distance(space, PointGoal(goal), {1, 1, 1});
  Configuration nearest(3);
  distance.Nearest(Configuration{0.1, 0.1, 0.1}, nearest);
  EXPECT_EQ(nearest, goal);
}

TEST(GoalDistance, ChangesByNoMoreThanTheMotion) {
  const JointSpace space = TestSpace();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto random_state = [&] {
    return Configuration{0.4 * unit(random), -1 + 3 * unit(random), -kPi + 2 * kPi * unit(random)};
  };
  for (int i = 0; i < 200; ++i) {
    GoalBox box{random_state(), {}, {}};
    for (const double nominal : box.nominal) {
      const double scale = i % 4;  // 0: a point
      box.lower.push_back(nominal - scale * unit(random));
      box.upper.push_back(nominal + scale * unit(random));
    }
    const std::vector<double> weights{3 * unit(random) + 0.1, 3 * unit(random) + 0.1,
                                      3 * unit(random) + 0.1};
    const GoalDistance distance(space, box, weights);
    EXPECT_EQ(distance(box.nominal), 0);
    for (int k = 0; k < 50; ++k) {
      const Configuration a = random_state();
      const Configuration b = random_state();
      EXPECT_LE(distance(a), WeightedDistance(space, weights, a, b) + distance(b) + 1e-12);
      Configuration nearest(3);
      distance.Nearest(a, nearest);
      EXPECT_TRUE(box.Contains(space, nearest));
      EXPECT_TRUE(space.WithinLimits(nearest));
      EXPECT_NEAR(distance(a), WeightedDistance(space, weights, a, nearest), 1e-9);
      EXPECT_LE(distance(a), WeightedDistance(space, weights, a, box.nominal) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace planbench
