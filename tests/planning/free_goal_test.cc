#include "planning/free_goal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "planning/planner.h"
#include "tests/planning/scripted_planner_test.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class GoalRegions : public ScriptedPlannerTest {
 protected:
  static Scene SceneWithGoalInPost() {
    Scene scene = EmptyPlanarScene();
    AddBox(&scene, "post", {0.9 * std::cos(-0.6), 0.9 * std::sin(-0.6), 0}, {0.1, 0.1, 0.2});
    return scene;
  }
};

TEST_F(GoalRegions, AreSearchedWhereTheirMiddleIsBlocked) {
  const Scene scene = SceneWithGoalInPost();
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = Request();
    request.direction = direction;
    const PlanResult point = Plan(StraightLine, request, scene);
    EXPECT_EQ(point.status, PlanStatus::kGoalInvalid);
    EXPECT_THAT(point.message, HasSubstr("goal is in collision: "));

    request = Request(0.3);
    request.direction = direction;
    const PlanResult region = Plan(StraightLine, request, scene);
    EXPECT_EQ(region.status, PlanStatus::kSolved) << region.message;
    const Configuration& end = region.path.back();
    EXPECT_EQ(region.path.front(), start_);
    EXPECT_NE(end, goal_);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(end[j], goal_[j], 0.3);
    EXPECT_EQ(Plan(StraightLine, request, scene).path, region.path);

    request = Request(0.001);
    request.direction = direction;
    const PlanResult small = Plan(StraightLine, request, scene);
    EXPECT_EQ(small.status, PlanStatus::kGoalInvalid);
    EXPECT_THAT(small.message, AllOf(StartsWith("goal is in collision: "), HasSubstr("post"),
                                     EndsWith("; no valid point among 1000 tried of its region")));
  }
}

TEST_F(GoalRegions, ThatTimeDidNotSufficeForAreNotCalledInvalid) {
  const Scene scene = SceneWithGoalInPost();
  PlanRequest region = Request(0.001);  // all of it in the post
  PlanControl cancelled;
  cancelled.cancelled = true;
  const PlanResult stopped = Plan(StraightLine, region, scene, &cancelled);
  EXPECT_EQ(stopped.status, PlanStatus::kCancelled);
  EXPECT_THAT(stopped.message, AllOf(StartsWith("goal is in collision: "), HasSubstr("post"),
                                     EndsWith("0 tried of its region before the request was "
                                              "cancelled")));
  // One that is certain makes no difference to one that is not, wherever it stands.
  for (const bool certain_first : {true, false}) {
    PlanRequest both = region;
    const std::vector<JointGoal> point = Request().goal;
    both.goal.insert(certain_first ? both.goal.begin() : both.goal.end(), point.begin(),
                     point.end());
    EXPECT_EQ(Plan(StraightLine, both, scene, &cancelled).status, PlanStatus::kCancelled);
  }
  region.time_limit_s = 1e-9;
  const PlanResult late = Plan(StraightLine, region, scene);
  EXPECT_EQ(late.status, PlanStatus::kTimedOut);
  EXPECT_THAT(late.message, EndsWith("0 tried of its region before the time limit"));
  EXPECT_EQ(num_searches_, 0);

  // A point is decided at once.
  PlanRequest point = Request();
  point.time_limit_s = 1e-9;
  EXPECT_EQ(Plan(StraightLine, point, scene).status, PlanStatus::kGoalInvalid);
}

TEST_F(GoalRegions, CountAsFarAsTheyAreWithinTheLimits) {
  PlanRequest request = MakeRequest(robot_, start_, {-0.6, 2.7, 0}, 0.2);  // elbow: at most 2.6
  const PlanResult result = Plan(StraightLine, request);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_LE(result.path.back()[1], 2.6);
  EXPECT_GE(result.path.back()[1], 2.5);
}

}  // namespace
}  // namespace planbench
