#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "collision/simd/simd_checker.h"
#include "robot_model/full_positions.h"
#include "robot_model/robot_folder.h"
#include "scene/moveit_yaml.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

/// The rail robot: a sphere of radius 0.25 m at (0, 0, slide).
Robot RailRobotWithGrid(bool walls) {
  Robot robot = MakeRailRobot();
  robot.voxels = VoxelSettings{0.02, Eigen::Vector3d(-1, -1, -2), Eigen::Vector3d(1, 1, 2), walls};
  return robot;
}

Scene BoxAt(double z) {
  return SceneWith("box", Box{Eigen::Vector3d(0.4, 0.4, 0.4)},
                   Eigen::Isometry3d(Eigen::Translation3d(0, 0, z)));
}

TEST(VoxelsModelTest, VerdictIsThatOfTheFieldAtTheSpheresCentre) {
  const Robot robot = RailRobotWithGrid(false);
  SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
  const Scene scene = BoxAt(0);
  checker.SetScene(scene, std::vector<double>{0.0});
  DistanceFieldBuilder builder(*robot.voxels);
  const DistanceField& field = builder.Rebuild(scene);
  int num_free = 0;
  for (double z = -1.95; z < 1.95; z += 0.0103) {
    const auto i = static_cast<std::size_t>(std::floor((z + 2) / 0.02));
    const std::size_t nx = static_cast<std::size_t>(field.size[0]);
    const std::size_t ny = static_cast<std::size_t>(field.size[1]);
    const float value = field.values[nx / 2 + nx * (ny / 2 + ny * i)];
    if (std::abs(value - 0.25) < 1e-4) continue;
    const std::vector<double> q = {z};
    EXPECT_EQ(checker.IsFree(q), value > 0.25) << z;
    num_free += checker.IsFree(q) ? 1 : 0;
    EXPECT_EQ(checker.FindContact(q).has_value(), value < 0.25) << z;
    EXPECT_NEAR(checker.FindClosest(q).distance_m, std::min(value - 0.25, 0.5), 1e-4);
  }
  EXPECT_GT(num_free, 100);
}

/// Far out single precision may take a centre to be in the next cell.
TEST(VoxelsModelTest, FarFromTheOriginNoCellThatCollidesIsMissed) {
  Robot robot = MakeRailRobot();
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double far_m : {10.0, 100.0, 1000.0}) {
    // The sphere far along its link and the rail.
    const Eigen::Vector3d p_L(0.003, 0.001, far_m);
    robot.spheres[0].p_LS = p_L;
    robot.voxels = VoxelSettings{0.02, p_L - Eigen::Vector3d(0.4, 0.4, 2),
                                 p_L + Eigen::Vector3d(0.4, 0.4, 2), false};
    const Scene scene = SceneWith("box", Box{Eigen::Vector3d(0.1, 0.1, 0.4)},
                                  Eigen::Isometry3d(Eigen::Translation3d(p_L)));
    SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
    checker.SetScene(scene, std::vector<double>{0.0});
    DistanceFieldBuilder builder(*robot.voxels);
    const DistanceField& field = builder.Rebuild(scene);
    const auto value_at = [&](const Eigen::Vector3d& p_W) {
      std::size_t index = 0;
      for (int axis = 2; axis >= 0; --axis) {
        const auto cell = std::floor((p_W[axis] - robot.voxels->lower[axis]) / 0.02);
        index = index * static_cast<std::size_t>(field.size[static_cast<std::size_t>(axis)]) +
                static_cast<std::size_t>(cell);
      }
      return field.values[index];
    };
    int num_free = 0;
    int num_hit = 0;
    for (int i = 0; i < 2000; ++i) {
      // Half of them close to a side of a cell, where the verdict changes.
      double z = 1.8 * unit(generator);
      if (i % 2 == 0) {
        z = std::copysign(0.45, z) + 0.07 * unit(generator);
        const double lower = robot.voxels->lower.z() - p_L.z();
        z = lower + 0.02 * std::round((z - lower) / 0.02) + 1e-6 * unit(generator);
      }
      const std::vector<double> q = {z};
      const bool hits = value_at(p_L + Eigen::Vector3d(0, 0, z)) < 0.25;
      num_hit += hits ? 1 : 0;
      num_free += checker.IsFree(q) ? 1 : 0;
      EXPECT_FALSE(hits && checker.IsFree(q)) << far_m << " m, " << z;
    }
    EXPECT_GT(num_hit, 300);
    EXPECT_GT(num_free, 300);
  }
}

TEST(VoxelsModelTest, WallsStandWhereTheGridEnds) {
  for (const bool walls : {false, true}) {
    const Robot robot = RailRobotWithGrid(walls);
    SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
    checker.SetScene({}, std::vector<double>{0.0});
    EXPECT_TRUE(checker.IsFree(std::vector<double>{0.0}));
    EXPECT_TRUE(checker.IsFree(std::vector<double>{1.7}));
    EXPECT_EQ(checker.IsFree(std::vector<double>{1.8}), !walls);
    EXPECT_EQ(checker.IsFree(std::vector<double>{5.0}), !walls);
  }
}

TEST(VoxelsModelTest, WithoutAGridOfItsOwnTheRobotIsCovered) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  SimdChecker voxels(arm, arm.groups.front(), CollisionModel::kVoxels);
  SimdChecker spheres(arm, arm.groups.front());
  std::mt19937_64 generator(5);
  int num_differ = 0;
  int num_blocked = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    if (!world.scene.attached.empty() || !world.scene.allowed_collisions.entries().empty())
      continue;
    voxels.SetScene(world.scene, base);
    spheres.SetScene(world.scene, base);
    for (int i = 0; i < 100; ++i) {
      const auto q = RandomConfiguration(arm.groups.front().space, &generator);
      const double distance = spheres.FindClosest(q).distance_m;
      num_blocked += voxels.IsFree(q) ? 0 : 1;
      // A cell's value and a point in it differ by less than two half diagonals.
      if (std::abs(distance) < 0.04) continue;
      num_differ += voxels.IsFree(q) == (distance > 0) ? 0 : 1;
    }
  }
  EXPECT_EQ(num_differ, 0);
  EXPECT_GT(num_blocked, 20);
}

TEST(VoxelsModelTest, ARobotTooLargeForTheGridIsToldWhatToDo) {
  Robot robot = MakeRailRobot();
  robot.spheres.push_back({robot.spheres[0].link, Eigen::Vector3d(100, 0, 0), 0.25});
  SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
  ExpectInputError([&] { checker.SetScene({}, std::vector<double>{0.0}); },
                   {"voxels of 0.02 m", "cells along x, at most 2048", "robot.yaml (voxels)"});
}

TEST(VoxelsModelTest, ProvesStretchesOfMotions) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  SimdChecker checker(arm, arm.groups.front(), CollisionModel::kVoxels);
  checker.SetScene(MakeTestScenes()[1].scene, base);
  const JointSpace& space = arm.groups.front().space;
  std::mt19937_64 generator(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  int num_proven = 0;
  for (int i = 0; i < 300; ++i) {
    const auto q = RandomConfiguration(space, &generator);
    std::vector<double> motion(q.size());
    for (double& value : motion) value = 0.04 * unit(generator);
    const MotionSample stretch{0.5, 0.5};
    if (checker.CheckSamples(q, motion, {&stretch, 1}).blocked != 0) continue;
    ++num_proven;
    for (int k = 0; k <= 20; ++k) {
      std::vector<double> on_it = q;
      for (std::size_t j = 0; j < q.size(); ++j) on_it[j] += k / 20.0 * motion[j];
      EXPECT_TRUE(checker.IsFree(on_it));
    }
  }
  EXPECT_GT(num_proven, 20);
}

}  // namespace
}  // namespace planbench
