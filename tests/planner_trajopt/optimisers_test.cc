// The parts of the trajectory optimisers, each against what is known otherwise.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "collision/edge_checker.h"
#include "common/numbers.h"
#include "common/stopwatch.h"
#include "planner_trajopt/chomp.h"
#include "planner_trajopt/initial_guesses.h"
#include "planner_trajopt/smoothness.h"
#include "planner_trajopt/stomp.h"
#include "planner_trajopt/trajectory.h"
#include "planner_trajopt/trajectory_cost.h"
#include "planner_trajopt/trajopt_settings.h"
#include "planning/resolve.h"
#include "tests/support/planning_problems.h"

namespace planbench {
namespace {

TEST(SmoothnessTest, IsTheInverseOfTheSquaredDifferences) {
  const Eigen::MatrixXd metric = InverseSmoothness(7).inverse();
  Eigen::VectorXd inner(7);
  inner << 0.3, -1, 2, 0.5, 0, 4, -0.2;
  double squares = inner[0] * inner[0] + inner[6] * inner[6];
  for (int i = 1; i < 7; ++i) squares += std::pow(inner[i] - inner[i - 1], 2);
  EXPECT_NEAR(inner.dot(metric * inner), squares, 1e-8);
}

class TrajectoryTest : public testing::Test {
 protected:
  TrajectoryTest() {
    checker_ = MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
    SetScene(PostsScene());
  }
  void SetScene(const Scene& scene) {
    checker_->SetScene(scene, robot_.model.DefaultPositions());
    edges_ = std::make_unique<EdgeChecker>(checker_.get(), 0.02, EdgeCheck::kFixed);
  }
  double CostOf(const TrajectoryCost& cost, const Trajectory& trajectory) const {
    std::vector<double> distances;
    cost.FindDistances(trajectory, &distances);
    return cost.OfTrajectory(trajectory, distances);
  }
  /// Returns the least cost on the way.
  double Optimise(const TrajectoryCost& cost, int num_iterations, Optimiser* optimiser,
                  Trajectory* trajectory) const {
    optimiser->Restart();
    double least = CostOf(cost, *trajectory);
    std::vector<double> distances;
    for (int k = 0; k < num_iterations; ++k) {
      cost.FindDistances(*trajectory, &distances);
      optimiser->Iterate(distances, trajectory);
      least = std::min(least, CostOf(cost, *trajectory));
    }
    return least;
  }

  const Robot robot_ = LoadPlanarRobot();
  const JointSpace& space_ = robot_.groups.front().space;
  const Configuration left_ = {0.6, 0, 0};
  const Configuration right_ = {-0.6, 0, 0};
  std::unique_ptr<CollisionChecker> checker_;
  std::unique_ptr<EdgeChecker> edges_;
};

TEST_F(TrajectoryTest, GoesThroughThePointsTheShortWayRound) {
  const Trajectory trajectory = Through(space_, {{3, 0, 0}, {-3, 0, 0}, {-3, 1, 0}}, 63);
  ASSERT_EQ(trajectory.rows(), 65);
  const double turn = 2 * std::numbers::pi - 6;
  EXPECT_NEAR(trajectory(64, 0), 3 + turn, 1e-12);
  EXPECT_NEAR(trajectory(64, 1), 1, 1e-12);
  const double spacing = (turn + 1) / 64;
  for (int i = 1; i < 65; ++i) {
    const double motion = (trajectory.row(i) - trajectory.row(i - 1)).norm();
    EXPECT_LE(motion, spacing + 1e-12);
    EXPECT_GE(motion, spacing / std::numbers::sqrt2 - 1e-12) << "across the corner";
  }
  for (const Configuration& q : PathOf(space_, trajectory)) {
    EXPECT_LT(std::abs(q[0]), std::numbers::pi + 1e-12);
  }
}

TEST_F(TrajectoryTest, PointsThatAreOneMakeATrajectoryThatRests) {
  const Trajectory trajectory = Through(space_, {left_, left_}, 3);
  EXPECT_EQ(trajectory.row(2), trajectory.row(0));
  EXPECT_EQ(Speeds(trajectory).norm(), 0);
}

TEST_F(TrajectoryTest, TheCostOfDistanceIsSmoothAndFalls) {
  const TrajectoryCost cost(edges_.get(), 0.05, 0);
  EXPECT_EQ(cost.OfDistance(0.05), 0);
  EXPECT_EQ(cost.OfDistance(1), 0);
  EXPECT_NEAR(cost.OfDistance(0), 0.025, 1e-12);
  EXPECT_NEAR(cost.OfDistance(-0.01), 0.035, 1e-12);
  constexpr double kStep = 1e-6;
  for (const double d : {-0.02, 0.0, 0.02, 0.05}) {
    const double before = (cost.OfDistance(d) - cost.OfDistance(d - kStep)) / kStep;
    const double after = (cost.OfDistance(d + kStep) - cost.OfDistance(d)) / kStep;
    EXPECT_NEAR(before, after, 1e-4) << d;
    EXPECT_LE(after, 0) << d;
  }
}

TEST_F(TrajectoryTest, ACostIsThatOfItsDistancesAndItsLength) {
  const TrajectoryCost cost(edges_.get(), 0.05, 0.5);
  const Trajectory trajectory = Through(space_, {left_, right_}, 20);
  std::vector<double> distances;
  cost.FindDistances(trajectory, &distances);
  double expected = 0.5 / 2 * 21 * std::pow(1.2 / 21, 2);
  for (int i = 1; i <= 20; ++i) {
    const double d = checker_->FindClosest(Row(trajectory, i)).distance_m;
    // Of a ball whose centre is inside an obstacle the engine knows no more than that.
    const double found = distances[static_cast<std::size_t>(i)];
    EXPECT_NEAR(std::max(found, -0.04), std::clamp(d, -0.04, 0.05), 1e-4);
    expected += cost.OfDistance(found) * 1.2 / 21;
  }
  EXPECT_NEAR(cost.OfTrajectory(trajectory, distances), expected, 1e-9);
}

TEST_F(TrajectoryTest, GuessesBeginStraightAndKeepTheEnds) {
  const TrajoptSettings settings;
  const TrajectoryCost cost(edges_.get(), settings.clearance, settings.smoothness);
  InitialGuesses guesses(space_, left_, right_, settings, &cost, 1);
  const Trajectory straight = guesses.Next();
  EXPECT_EQ(straight, Through(space_, {left_, right_}, settings.waypoints));
  const JointBounds bounds(space_);
  for (int k = 0; k < 20; ++k) {
    const Trajectory guess = guesses.Next();
    EXPECT_EQ(guess.row(0), straight.row(0));
    EXPECT_NE(guess, straight);
    Trajectory clamped = guess;
    bounds.Clamp(clamped);
    EXPECT_EQ(clamped, guess);
    for (int j = 0; j < space_.size(); ++j) {
      EXPECT_NEAR(
          space_.Difference(j, guess(guess.rows() - 1, j), right_[static_cast<std::size_t>(j)]), 0,
          1e-12);
    }
  }
  EXPECT_EQ(guesses.count(), 21);
}

TEST_F(TrajectoryTest, BothOptimisersLowerTheCostAndKeepTheEnds) {
  TrajoptSettings settings;
  const TrajectoryCost cost(edges_.get(), settings.clearance, settings.smoothness);
  // Folded enough to be half over the post.
  const Trajectory guess = Through(space_, {left_, {0, 1.2, 0.3}, right_}, settings.waypoints);
  Stomp stomp(space_, settings, &cost, 1);
  Chomp chomp(space_, settings, &cost);
  for (Optimiser* optimiser : std::vector<Optimiser*>{&stomp, &chomp}) {
    Trajectory trajectory = guess;
    EXPECT_LT(Optimise(cost, 30, optimiser, &trajectory), 0.8 * CostOf(cost, guess));
    EXPECT_EQ(trajectory.row(0), guess.row(0));
    EXPECT_EQ(trajectory.bottomRows(1), guess.bottomRows(1));
    Trajectory clamped = trajectory;
    JointBounds(space_).Clamp(clamped);
    EXPECT_EQ(clamped, trajectory);
  }
}

TEST_F(TrajectoryTest, WithoutObstaclesBothComeBackTowardsTheStraightLine) {
  SetScene(EmptyPlanarScene());
  TrajoptSettings settings;
  settings.smoothness = 0.5;
  settings.waypoints = 20;
  const TrajectoryCost cost(edges_.get(), settings.clearance, settings.smoothness);
  const Trajectory guess = Through(space_, {left_, {0, 1, 0}, right_}, settings.waypoints);
  Stomp stomp(space_, settings, &cost, 1);
  Chomp chomp(space_, settings, &cost);
  for (Optimiser* optimiser : std::vector<Optimiser*>{&stomp, &chomp}) {
    Trajectory trajectory = guess;
    Optimise(cost, 100, optimiser, &trajectory);
    EXPECT_LT(trajectory.col(1).maxCoeff(), 0.5);
  }
}

TEST_F(TrajectoryTest, ChompBringsJointsBackToTheirLimitsSmoothlyAndNoFurther) {
  const TrajoptSettings settings;
  const TrajectoryCost cost(edges_.get(), settings.clearance, /*smoothness=*/0);
  const double limit = space_.joint(1).upper;
  Trajectory trajectory = Trajectory::Zero(settings.waypoints + 2, space_.size());
  // As a step may leave it: one joint is outside beside the start, another one, less, for long.
  trajectory.col(2).segment(0, 5).setConstant(limit + 0.1);
  trajectory(0, 2) = limit;
  trajectory.col(1).segment(10, 31).setConstant(limit + 0.09);
  const Trajectory before = trajectory;
  // Nothing is near, so that there is nothing else to be done.
  Chomp(space_, settings, &cost)
      .Iterate(std::vector<double>(static_cast<std::size_t>(trajectory.rows()), settings.clearance),
               &trajectory);
  Trajectory clamped = trajectory;
  JointBounds(space_).Clamp(clamped);
  EXPECT_EQ(clamped, trajectory);
  EXPECT_LT((trajectory - before).cwiseAbs().maxCoeff(), 0.2);
  EXPECT_LT(trajectory(8, 1), before(8, 1)) << "neighbours go along";
  EXPECT_LT(trajectory(6, 2), before(6, 2));
  EXPECT_EQ(trajectory.col(0), before.col(0));
}

TEST_F(TrajectoryTest, SettingUpStompForManyWaypointsTakesNoFactorisation) {
  TrajoptSettings settings;
  settings.waypoints = 400;
  const TrajectoryCost cost(edges_.get(), settings.clearance, settings.smoothness);
  const auto shortest_s = [](const auto& run) {
    double least = kInfinity;
    for (int i = 0; i < 3; ++i) {
      const Stopwatch clock;
      run();
      least = std::min(least, clock.seconds());
    }
    return least;
  };
  const Eigen::MatrixXd covariance = InverseSmoothness(settings.waypoints);
  const double factorisation_s =
      shortest_s([&] { EXPECT_EQ(covariance.llt().info(), Eigen::Success); });
  const double set_up_s = shortest_s([&] { const Stomp stomp(space_, settings, &cost, 1); });
  EXPECT_LT(set_up_s, factorisation_s / 2);
}

TEST_F(TrajectoryTest, DistancesOfManyConfigurationsCanBeStopped) {
  TrajoptSettings settings;
  settings.waypoints = 1000;
  settings.rollouts = 20;
  TrajectoryCost cost(edges_.get(), settings.clearance, settings.smoothness);
  const Trajectory guess = Through(space_, {left_, {0, 1, 0}, right_}, settings.waypoints);
  std::vector<double> distances;
  EXPECT_TRUE(cost.FindDistances(guess, &distances));
  bool stop = false;
  cost.StopWhen([&stop] { return stop; });
  Stomp stomp(space_, settings, &cost, 1);
  Trajectory trajectory = guess;
  stomp.Iterate(distances, &trajectory);
  EXPECT_NE(trajectory, guess);

  stop = true;
  const Trajectory before = trajectory;
  const std::int64_t num_checked = edges_->counters().configurations;
  stomp.Iterate(distances, &trajectory);
  EXPECT_EQ(trajectory, before);
  EXPECT_LT(edges_->counters().configurations - num_checked, 20 * 1002 / 2);
}

TEST_F(TrajectoryTest, DistancesFoundInPartsAreThoseOfAllRowsAtOnce) {
  const TrajectoryCost cost(edges_.get(), 0.05, 0);
  const Trajectory rows = Through(space_, {left_, {0, 1.2, 0.3}, right_}, 301);
  std::vector<double> distances;
  ASSERT_TRUE(cost.FindDistances(rows, &distances));
  std::vector<double> at_once(distances.size());
  edges_->FindClearances({rows.data(), static_cast<std::size_t>(rows.size())},
                         static_cast<int>(rows.rows()), 0.05, at_once);
  EXPECT_EQ(distances, at_once);
}

TEST_F(TrajectoryTest, IterationsAskAllTheWayAndAreLeftUndoneWhereverTheyAreStopped) {
  TrajoptSettings settings;
  settings.waypoints = 60;
  settings.rollouts = 12;
  // Near enough a post all along for CHOMP's gradient to be found in parts, too.
  TrajectoryCost cost(edges_.get(), /*clearance=*/0.45, settings.smoothness);
  const Trajectory guess = Through(space_, {left_, {0, 1.2, 0.3}, right_}, settings.waypoints);
  std::vector<double> distances;
  ASSERT_TRUE(cost.FindDistances(guess, &distances));
  for (const bool is_stomp : {true, false}) {
    // A new one each time: the same noise.
    const auto iterated = [&] {
      std::unique_ptr<Optimiser> optimiser;
      if (is_stomp) {
        optimiser = std::make_unique<Stomp>(space_, settings, &cost, 1);
      } else {
        optimiser = std::make_unique<Chomp>(space_, settings, &cost);
      }
      Trajectory trajectory = guess;
      optimiser->Iterate(distances, &trajectory);
      return trajectory;
    };
    cost.StopWhen({});
    const Trajectory undisturbed = iterated();
    EXPECT_NE(undisturbed, guess);
    int num_asked = 0;
    int stop_at = 0;  // never
    cost.StopWhen([&] { return ++num_asked == stop_at; });
    EXPECT_EQ(iterated(), undisturbed);
    const int num_parts = num_asked;
    if (is_stomp) {
      EXPECT_GE(num_parts, 2 * settings.rollouts + settings.waypoints);
    }
    EXPECT_GT(num_parts, 0);
    for (stop_at = 1; stop_at <= num_parts; ++stop_at) {
      num_asked = 0;
      EXPECT_EQ(iterated(), guess) << is_stomp << ", " << stop_at;
      EXPECT_EQ(num_asked, stop_at) << "goes on though it was stopped";
    }
  }
}

}  // namespace
}  // namespace planbench
