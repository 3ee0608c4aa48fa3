#include "planner_ara/joint_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "common/numbers.h"
#include "support/planning_problems.h"

namespace planbench {
namespace {

// Of the planar arm from one side of the x axis to the other, behind it.
std::vector<std::optional<double>> WallsBehind(const Scene& scene, double side) {
  const Robot robot = LoadPlanarRobot();
  const std::unique_ptr<CollisionChecker> checker =
      MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kSpheres);
  checker->SetScene(scene, std::vector<double>(4, 0.0));
  EdgeChecker edges(checker.get(), robot.edge_resolution_m, EdgeCheck::kCertified);
  return FindWalls(&edges, Configuration{side, 0.1, 0}, Configuration{-side, 0, -0.1});
}

TEST(FindWalls, FindsWhereAContinuousJointCannotPassWhateverTheOthersDo) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "post", {-0.3, 0, 0}, {0.05, 0.05, 0.2});
  const std::vector<std::optional<double>> walls = WallsBehind(scene, 2.5);
  ASSERT_EQ(walls.size(), 3u);
  ASSERT_TRUE(walls[0]);
  EXPECT_LT(std::abs(WrapAngle(*walls[0] - kPi)), 0.3);
  EXPECT_GE(*walls[0], -kPi);
  EXPECT_LT(*walls[0], kPi);
  EXPECT_FALSE(walls[1]);
  EXPECT_FALSE(walls[2]);
  EXPECT_FALSE(WallsBehind(scene, 0.5)[0]) << "the short way is ahead of the arm";
}

TEST(FindWalls, FindsNoneWhereTheOthersCanMakeWay) {
  Scene scene = PostsScene();  // Both ends stretch out before them.
  EXPECT_FALSE(WallsBehind(scene, 2.5)[0]);
}

}  // namespace
}  // namespace planbench
