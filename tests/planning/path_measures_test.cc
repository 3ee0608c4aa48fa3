#include "planning/path_measures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "common/numbers.h"
#include "support/planning_problems.h"
#include "tests/planning/three_joints.h"
#include "tests/support/two_arm_robot.h"

namespace planbench {
namespace {

TEST(PathLengthTest, OfNothingAndOfOnePointIsZero) {
  EXPECT_EQ(PathLength(ThreeJoints(), {}), 0);
  EXPECT_EQ(PathLength(ThreeJoints(), {{1, 2, 3}}), 0);
}

TEST(PathLengthTest, AddsUpL2Distances) {
  EXPECT_DOUBLE_EQ(PathLength(ThreeJoints(), {{0, 0, 0}, {0, 3, 4}, {0, 3, 4}, {0, 3, 6}}), 7);
}

TEST(PathLengthTest, ContinuousJointsGoTheShortWay) {
  EXPECT_NEAR(PathLength(ThreeJoints(), {{3, 0, 0}, {-3, 0, 0}}), 2 * kPi - 6, 1e-12);
  EXPECT_NEAR(PathLength(ThreeJoints(), {{kPi, 0, 0}, {-kPi, 0, 0}}), 0, 1e-12);
  EXPECT_NEAR(PathLength(ThreeJoints(), {{0.1 + 4 * kPi, 0, 0}, {0, 0, 0}}), 0.1, 1e-12);
}

TEST(PathSmoothnessTest, StraightPathsAreZero) {
  EXPECT_EQ(PathSmoothness(ThreeJoints(), {}), 0);
  EXPECT_EQ(PathSmoothness(ThreeJoints(), {{0, 0, 0}, {0, 1, 0}}), 0);
  EXPECT_NEAR(PathSmoothness(ThreeJoints(), {{0, 0, 0}, {0, 1, 0}, {0, 4, 0}}), 0, 1e-15);
  EXPECT_NEAR(PathSmoothness(ThreeJoints(), {{3, 0, 0}, {-3, 0, 0}, {-2.8, 0, 0}}), 0, 1e-15)
      << "straight across the seam of the continuous joint";
}

TEST(PathSmoothnessTest, ARightAngle) {
  // Turn of pi/2 between segments of 1 and 2: (2 * pi/2 / 3)^2.
  EXPECT_NEAR(PathSmoothness(ThreeJoints(), {{0, 0, 0}, {0, 1, 0}, {0, 1, 2}}),
              std::pow(kPi / 3, 2), 1e-12);
}

TEST(PathSmoothnessTest, AReversalIsATurnOfPi) {
  EXPECT_NEAR(PathSmoothness(ThreeJoints(), {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}), std::pow(kPi, 2),
              1e-12);
}

TEST(PathSmoothnessTest, SumsOverWaypointsAndSkipsRepeatedOnes) {
  const Path path = {{0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(PathSmoothness(ThreeJoints(), path), 2 * std::pow(kPi / 2, 2), 1e-12);
}

/// A straight motion of the planar robot's shoulder, 1.2 rad, by itself and cut into pieces.
class TakeMeasuresTest : public testing::Test {
 protected:
  MeasuredValues Take(const Path& path, const Scene& scene, double step_m = 0.01) {
    const std::vector<double> positions = robot_.model.DefaultPositions();
    checker_->SetScene(scene, positions);
    const EdgeChecker edges(checker_.get(), step_m, EdgeCheck::kFixed);
    PathSurvey survey(edges, path, positions);
    return TakeMeasures(&survey, /*with_clearance=*/true);
  }
  /// Beyond the hand's last sphere (at 1.15 m, radius 0.04), facing the middle of the motion.
  static Scene Wall() {
    Scene scene = EmptyPlanarScene();
    AddBox(&scene, "wall", {1.5, 0, 0}, {0.4, 0.02, 0.2});
    return scene;
  }

  const Robot robot_ = LoadPlanarRobot();
  const std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  const Path straight_ = {{0.6, 0, 0}, {-0.6, 0, 0}};
  const Path cut_ = {{0.6, 0, 0}, {0.59, 0, 0}, {0.58, 0, 0}, {0.58, 0, 0}, {-0.6, 0, 0}};
};

TEST_F(TakeMeasuresTest, OfAPathKnown) {
  const MeasuredValues values = Take(straight_, Wall());
  EXPECT_NEAR(values.at("path_length"), 1.2, 1e-12);
  EXPECT_NEAR(values.at("smoothness"), 0, 1e-12);
  EXPECT_NEAR(values.at("tip_travel"), 1.2 * 1.2, 1e-3) << "an arc of 1.2 rad at 1.2 m";
  EXPECT_NEAR(values.at("clearance"), 1.3 - 1.15 - 0.04, 2e-3);
  EXPECT_GT(values.at("clearance_mean"), values.at("clearance"));
  EXPECT_LT(values.at("clearance_mean"), 1);
}

TEST_F(TakeMeasuresTest, TravelAndClearanceAreOfTheSamples) {
  // In a step as long as the motion there are the ends, as far from the wall as a still arm there.
  const MeasuredValues ends = Take(straight_, Wall(), 10);
  EXPECT_NEAR(ends.at("tip_travel"), 2 * 1.2 * std::sin(0.6), 1e-9) << "the arc's chord";
  const double at_rest = std::min(Take({straight_[0]}, Wall()).at("clearance"),
                                  Take({straight_[1]}, Wall()).at("clearance"));
  EXPECT_NEAR(ends.at("clearance"), at_rest, 1e-12);
  EXPECT_GT(at_rest, Take(straight_, Wall()).at("clearance") + 0.1);
}

TEST_F(TakeMeasuresTest, DoNotDependOnHowAStraightMotionIsCut) {
  const MeasuredValues whole = Take(straight_, Wall(), 0.002);
  for (const auto& [name, value] : Take(cut_, Wall(), 0.002)) {
    EXPECT_NEAR(value, whole.at(name), 1e-4) << name;
  }
}

TEST_F(TakeMeasuresTest, ClearancesAreInfiniteWhereThereIsNothingToCollideWith) {
  Robot robot = LoadPlanarRobot();
  // Nothing of the robot itself either.
  const int num_links = static_cast<int>(robot.model.links().size());
  for (int a = 0; a < num_links; ++a) {
    for (int b = a + 1; b < num_links; ++b) robot.allowed_pairs.emplace_back(a, b);
  }
  const auto checker = MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kSpheres);
  const std::vector<double> positions = robot.model.DefaultPositions();
  checker->SetScene(EmptyPlanarScene(), positions);
  const EdgeChecker edges(checker.get(), 0.01, EdgeCheck::kFixed);
  for (const Path& path : {straight_, cut_, Path{straight_[0]}}) {  // cut_ repeats a waypoint.
    PathSurvey survey(edges, path, positions);
    const MeasuredValues values = TakeMeasures(&survey, true);
    EXPECT_EQ(values.at("clearance"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(values.at("clearance_mean"), std::numeric_limits<double>::infinity());
  }
}

TEST_F(TakeMeasuresTest, TakesEachUnlessItIsAClearanceNotAskedFor) {
  EXPECT_EQ(Take(straight_, Wall()).size(), PathMeasures().size());
  const std::vector<double> positions = robot_.model.DefaultPositions();
  const EdgeChecker edges(checker_.get(), 0.01, EdgeCheck::kFixed);
  PathSurvey survey(edges, straight_, positions);
  const MeasuredValues values = TakeMeasures(&survey, /*with_clearance=*/false);
  for (const PathMeasure& measure : PathMeasures()) {
    EXPECT_EQ(FindMeasure(values, measure.name).has_value(), !measure.is_clearance) << measure.name;
  }
}

TEST(TipTravel, IsTheSumOverTheTips) {
  Robot robot = MakeTwoArmRobot();
  const std::vector<double> positions = robot.model.DefaultPositions();
  const auto travel = [&](const PlanningGroup& group) {
    const auto checker = MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
    Scene scene = EmptyPlanarScene();
    checker->SetScene(scene, positions);
    const EdgeChecker edges(checker.get(), 0.01, EdgeCheck::kFixed);
    const auto n = static_cast<std::size_t>(group.space.size());
    const Path path = {Configuration(n, 0.0), Configuration(n, 0.2)};
    return PathSurvey(edges, path, positions).TipTravel();
  };
  const PlanningGroup both = robot.groups.front();
  PlanningGroup left = both;
  left.more_tips.clear();
  PlanningGroup right = left;
  right.tip_link = both.more_tips.front();
  EXPECT_GT(travel(right), 0.05);
  EXPECT_NEAR(travel(both), travel(left) + travel(right), 1e-12);
}

TEST(PathMeasuresTest, AreDocumentedAsTheyDescribeThemselves) {
  std::ifstream file(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "docs" / "database.md");
  const std::string docs{std::istreambuf_iterator<char>(file), {}};
  std::set<std::string> names;
  for (const PathMeasure& measure : PathMeasures()) {
    EXPECT_TRUE(names.insert(measure.name).second) << measure.name;
    const std::string unit = *measure.unit == '\0' ? "" : fmt::format(" {}", measure.unit);
    EXPECT_THAT(docs, testing::HasSubstr(fmt::format("| `{0}`, `{0}_simplified` |{1} | {2} |\n",
                                                     measure.name, unit, measure.meaning)));
  }
}

}  // namespace
}  // namespace planbench
