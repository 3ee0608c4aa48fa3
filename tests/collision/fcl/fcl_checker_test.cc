#include "collision/fcl/fcl_checker.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/contract/collision_test_worlds.h"

namespace planbench {
namespace {

// Whoever notes something of each pair of so many objects needs 22 GB for it.
TEST(FclCheckerTest, TakesScenesOfManyObjects) {
  const Robot robot = MakeRailRobot();
  FclChecker checker(robot, robot.groups.front(), CollisionModel::kSpheres);
  Scene scene;
  const auto at = [](double x, double y, double z) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
  };
  for (int i = 0; i < 150'000; ++i) {
    AddObject(&scene, "pebble" + std::to_string(i), Sphere{0.01},
              at(30 + 0.1 * (i / 500), 0.1 * (i % 500), 0));
  }
  AddObject(&scene, "step", Box{Eigen::Vector3d(1, 1, 1)}, at(0, 0, 3));
  checker.SetScene(scene, std::vector<double>{0});
  EXPECT_TRUE(checker.IsFree(std::vector<double>{0}));
  EXPECT_FALSE(checker.IsFree(std::vector<double>{3}));
  for (const double z : {0.0, 0.5}) {
    const ClosestPair closest = checker.FindClosest(std::vector<double>{z});
    EXPECT_EQ(closest.body_b, "step");
    EXPECT_NEAR(closest.distance_m, 2.25 - z, 1e-9);
  }
}

}  // namespace
}  // namespace planbench
