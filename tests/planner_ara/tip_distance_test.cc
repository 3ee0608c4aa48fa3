#include "planner_ara/tip_distance.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/planning_problems.h"

namespace planbench {
namespace {

// The tip of the planar arm is 1.2 m from the axis when the arm is stretched.
class TipDistanceTest : public testing::Test {
 protected:
  TipDistance Distance(const Scene& scene, const Configuration& start, const Configuration& goal) {
    return TipDistance(scene, robot_.model, robot_.groups.front(), base_, start, goal);
  }

  const Robot robot_ = LoadPlanarRobot();
  const std::vector<double> base_ = std::vector<double>(4, 0.0);
  const Configuration left_ = {0.4, 0, 0};
  const Configuration right_ = {-0.4, 0, 0};
};

TEST_F(TipDistanceTest, IsZeroAtTheGoalAndTheCrowsWayInFreeSpace) {
  TipDistance distance = Distance(EmptyPlanarScene(), left_, right_);
  EXPECT_EQ(distance(right_), 0);
  // The tips are 2 * 1.2 * sin(0.4) = 0.93 m apart along y; a cell is 0.07 m.
  EXPECT_NEAR(distance(left_), 0.93, 0.08);
  EXPECT_LT(distance(Configuration{0, 0, 0}), distance(left_));
}

TEST_F(TipDistanceTest, LeadsRoundObstacles) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "wall", {2.0, 0, 0}, {2.3, 0.05, 2});  // from 0.85 m ahead
  const Configuration left = {0.2, 0, 0};
  const Configuration right = {-0.2, 0, 0};
  TipDistance free = Distance(EmptyPlanarScene(), left, right);
  TipDistance round = Distance(scene, left, right);
  EXPECT_EQ(round(right), 0);
  EXPECT_GT(round(left), free(left) + 0.15);
}

TEST_F(TipDistanceTest, GoalsThatAreWalledInAreFarFromEverywhere) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "wall", {0, 0, 0}, {8, 0.05, 8});
  TipDistance distance = Distance(scene, left_, right_);
  EXPECT_EQ(distance(right_), 0);
  EXPECT_EQ(distance(left_), distance(Configuration{0.5, 0, 0}));
  EXPECT_GT(distance(left_), distance(Configuration{-0.6, 0, 0}));
}

TEST_F(TipDistanceTest, BeyondTheGridTheNearestCellCounts) {
  TipDistance distance = Distance(EmptyPlanarScene(), {0.1, 0, 0}, {0, 0, 0});
  EXPECT_GT(distance(Configuration{3.1, 0, 0}), 0);
  EXPECT_LT(distance(Configuration{3.1, 0, 0}), 2);
}

TEST_F(TipDistanceTest, DoesNotDependOnWhatWasAskedBefore) {
  TipDistance one = Distance(PostsScene(), left_, right_);
  TipDistance other = Distance(PostsScene(), left_, right_);
  std::vector<double> forward, backward;
  for (int k = 0; k <= 20; ++k) forward.push_back(one(Configuration{-2 + 0.2 * k, 0.5, 0}));
  for (int k = 20; k >= 0; --k) backward.push_back(other(Configuration{-2 + 0.2 * k, 0.5, 0}));
  EXPECT_EQ(forward, std::vector<double>(backward.rbegin(), backward.rend()));
}

}  // namespace
}  // namespace planbench
