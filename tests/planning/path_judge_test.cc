#include "planning/path_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "planning/path_measures.h"
#include "support/expect_input_error.h"
#include "support/planning_problems.h"

namespace planbench {
namespace {

using testing::HasSubstr;

class PathJudgeTest : public testing::Test {
 protected:
  PathVerdict Judge(const Path& path, const Scene& scene, bool with_clearance = false,
                    double step_m = 0.01) {
    checker_->SetScene(scene, robot_.model.DefaultPositions());
    return JudgePath(checker_.get(), path, start_, goals_, step_m, with_clearance);
  }

  const Robot robot_ = LoadPlanarRobot();
  const std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  const Configuration start_ = {0.6, 0, 0};
  std::vector<GoalBox> goals_ = {{{-0.6, 0, 0}, {-0.6, 0, -0.1}, {-0.6, 0, 0.1}}};
  const Path straight_ = {{0.6, 0, 0}, {-0.6, 0, 0}};
};

TEST_F(PathJudgeTest, AcceptsAFreePathAndMeasuresIt) {
  const PathVerdict verdict = Judge(straight_, EmptyPlanarScene());
  EXPECT_TRUE(verdict.valid) << verdict.reason;
  EXPECT_EQ(verdict.reason, "");
  EXPECT_NEAR(verdict.measures.at("path_length"), 1.2, 1e-12);
  EXPECT_FALSE(verdict.measures.contains("clearance")) << "not asked for";
  EXPECT_GE(verdict.num_samples, 1.2 * 1.2 / 0.01);
}

TEST_F(PathJudgeTest, FindsAThinObjectInTheWay) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "blade", {0.9, 0, 0}, {0.2, 0.0005, 0.2});
  const PathVerdict verdict = Judge(straight_, scene);
  EXPECT_FALSE(verdict.valid);
  EXPECT_THAT(verdict.reason, HasSubstr("blade"));
  EXPECT_EQ(verdict.segment, 0);
  EXPECT_NEAR(verdict.fraction, 0.5, 0.1);
  ASSERT_TRUE(verdict.contact.has_value());
  EXPECT_EQ(verdict.contact->body_b, "blade");
}

TEST_F(PathJudgeTest, JudgesEveryEdge) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "blade", {0.9, 0, 0}, {0.2, 0.0005, 0.2});
  const PathVerdict verdict = Judge({{0.6, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {-0.6, 0, 0}}, scene);
  EXPECT_FALSE(verdict.valid);
  EXPECT_EQ(verdict.segment, 2);
}

TEST_F(PathJudgeTest, TakesContinuousJointsTheShortWay) {
  Scene scene = PostsScene();
  scene.objects.pop_back();  // Leaves the post ahead; the path goes round behind.
  const PathVerdict verdict = Judge({{0.6, 0, 0}, {2.5, 0, 0}, {-2.5, 0, 0}, {-0.6, 0, 0}}, scene);
  EXPECT_TRUE(verdict.valid) << verdict.reason;
  EXPECT_NEAR(verdict.measures.at("path_length"), 1.9 + (2 * M_PI - 5) + 1.9, 1e-9);
}

TEST_F(PathJudgeTest, RefusesWhatIsNoPathFromStartToGoal) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    Path path;
    std::string reason;
    int segment;
  };
  const std::vector<Case> cases = {
      {{}, "empty", -1},
      {{{0.5, 0, 0}, {-0.6, 0, 0}}, "start", 0},
      {{{0.6, 0, 0}, {-0.5, 0, 0}}, "goal", 0},
      {{{0.6, 0, 0}, {0, 0, 0}, {-0.6, 0, 0.2}}, "goal", 1},
      {{{0.6, 0, 0}}, "goal", 0},
      {{{0.6, 0, 0}, {0, 2.7, 0}, {-0.6, 0, 0}}, "elbow", 0},
      {{{0.6, 0, 0}, {0, nan, 0}, {-0.6, 0, 0}}, "elbow", 0},
      {{{nan, 0, 0}, {-0.6, 0, 0}}, "shoulder", 0},
      {{{0.6, 0, 0}, {INFINITY, 0, 0}, {-0.6, 0, 0}}, "shoulder", 0},
      {{{0.6, 0, 0}, {0, 0}, {-0.6, 0, 0}}, "2 positions", 0},
      {{{0.6, 0, 0}, {0, 0, 0, 0}, {-0.6, 0, 0}}, "4 positions", 0},
  };
  for (const Case& bad : cases) {
    const PathVerdict verdict = Judge(bad.path, EmptyPlanarScene());
    EXPECT_FALSE(verdict.valid) << bad.reason;
    EXPECT_THAT(verdict.reason, HasSubstr(bad.reason));
    EXPECT_EQ(verdict.segment, bad.segment) << verdict.reason;
    const bool of_configurations = bad.reason == "start" || bad.reason == "goal";
    EXPECT_EQ(verdict.measures.empty(), !of_configurations) << bad.reason;
  }
}

TEST_F(PathJudgeTest, ReasonsHaveUnitsAndNoMoreDigitsThanTheyNeed) {
  EXPECT_EQ(Judge({{0.6 - 0.1 / 3, 0, 0}, {-0.6, 0, 0}}, EmptyPlanarScene()).reason,
            "the path does not begin at the start: joint 'shoulder' is 0.0333 rad away");
  EXPECT_EQ(Judge({{0.6, 0, 0}, {0, 8.0 / 3, 0}, {-0.6, 0, 0}}, EmptyPlanarScene()).reason,
            "waypoint 1: joint 'elbow' at 2.6666667 rad is outside [-2.6, 2.6]");
}

TEST_F(PathJudgeTest, PathsMayEndInAnyOfTheGoals) {
  const Path elsewhere = {{0.6, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(Judge(elsewhere, EmptyPlanarScene()).reason, HasSubstr("goal"));
  goals_.insert(goals_.begin(), GoalBox{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  EXPECT_TRUE(Judge(elsewhere, EmptyPlanarScene()).valid);
  EXPECT_TRUE(Judge(straight_, EmptyPlanarScene()).valid);
  EXPECT_FALSE(Judge({{0.6, 0, 0}, {0.8, 0, 0}}, EmptyPlanarScene()).valid);
}

TEST_F(PathJudgeTest, EndsMayBeOffByRounding) {
  EXPECT_TRUE(Judge({{0.6 + 5e-7, 0, 0}, {-0.6, 5e-7, 0.1}}, EmptyPlanarScene()).valid);
  EXPECT_TRUE(Judge({{0.6 + 2 * M_PI, 0, 0}, {-0.6, 0, 0}}, EmptyPlanarScene()).valid);
  EXPECT_FALSE(Judge({{0.6 + 5e-6, 0, 0}, {-0.6, 0, 0}}, EmptyPlanarScene()).valid);
}

TEST_F(PathJudgeTest, MeasuresInvalidPathsButNotTheirClearance) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "blade", {0.9, 0, 0}, {0.2, 0.0005, 0.2});
  const PathVerdict verdict = Judge(straight_, scene, /*with_clearance=*/true);
  ASSERT_FALSE(verdict.valid);
  for (const PathMeasure& measure : PathMeasures()) {
    EXPECT_EQ(verdict.measures.contains(measure.name), !measure.is_clearance) << measure.name;
  }
}

TEST_F(PathJudgeTest, APathOfOneWaypointServesAStartInTheGoal) {
  checker_->SetScene(EmptyPlanarScene(), robot_.model.DefaultPositions());
  const PathVerdict verdict =
      JudgePath(checker_.get(), {start_}, start_, {{start_, start_, start_}}, 0.01, false);
  EXPECT_TRUE(verdict.valid) << verdict.reason;
  EXPECT_EQ(verdict.num_samples, 1);
  EXPECT_EQ(verdict.measures.at("tip_travel"), 0);
}

TEST_F(PathJudgeTest, HeldJointsCount) {
  // With the column raised the arm passes over the posts.
  std::vector<double> raised = robot_.model.DefaultPositions();
  const int lift = robot_.model.FindJoint("lift");
  raised[static_cast<std::size_t>(
      robot_.model.joints()[static_cast<std::size_t>(lift)].position_index)] = 0.5;
  checker_->SetScene(PostsScene(), raised);
  const PathVerdict over =
      JudgePath(checker_.get(), straight_, start_, goals_, 0.01, false, raised);
  EXPECT_TRUE(over.valid) << over.reason;
  EXPECT_FALSE(Judge(straight_, PostsScene()).valid);
}

TEST_F(PathJudgeTest, OfTooManySamplesAPathIsTooLongOrTheStepTooFine) {
  // Every edge has few samples; all together have too many.
  Path long_path = {straight_.front()};
  for (int i = 0; i < 8000; ++i) long_path.push_back({i % 2 == 0 ? 2.5 : -0.5, 0, 0});
  long_path.push_back(straight_.back());
  for (const double step_m : {0.01, 1.0}) {
    const PathVerdict verdict = Judge(long_path, EmptyPlanarScene(), false, step_m);
    EXPECT_FALSE(verdict.valid);
    EXPECT_THAT(verdict.reason,
                HasSubstr("the path is too long: points of the robot move by up to"));
    EXPECT_TRUE(verdict.measures.empty());
  }

  ExpectInputError([&] { Judge(straight_, EmptyPlanarScene(), false, 1e-6); },
                   {"step_m of 1e-06 m", "more than 1000000 samples", "--referee-step"});
  // What is no matter of samples is said at any step.
  EXPECT_THAT(Judge({{0.6, 0, 0}, {-0.5, 0, 0}}, EmptyPlanarScene(), false, 1e-6).reason,
              HasSubstr("goal"));
  EXPECT_THAT(Judge({{0.6, 0, 0}, {0, 1e9, 0}, {-0.6, 0, 0}}, EmptyPlanarScene()).reason,
              HasSubstr("waypoint 1: joint 'elbow' at 1e+09 rad is outside"));
}

TEST_F(PathJudgeTest, ByDefaultAtHalfTheEdgeResolutionButNotTooFine) {
  EXPECT_EQ(DefaultRefereeStep(0.02), 0.01);
  const double step_m = DefaultRefereeStep(1e-6);
  EXPECT_TRUE(Judge(straight_, EmptyPlanarScene(), false, step_m).valid) << step_m;
}

TEST_F(PathJudgeTest, RefusesBadSteps) {
  for (const double step_m : {0.0, -0.01, std::nan(""), double{INFINITY}}) {
    ExpectInputError([&] { Judge(straight_, EmptyPlanarScene(), false, step_m); }, {"step_m"});
  }
}

}  // namespace
}  // namespace planbench
