#include "robot_model/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include "robot_model/robot_folder.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/support/planning_problems.h"

namespace planbench {
namespace {

Eigen::Isometry3d TipPose(const Robot& robot, const PlanningGroup& group,
                          const std::vector<double>& held, const std::vector<double>& q) {
  return ComputeLinkPoses(robot.model, WithGroupAt(robot.model, group, held,
                                                   q))[static_cast<std::size_t>(group.tip_link)];
}

void ExpectNear(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& expected,
                double tolerance) {
  EXPECT_LE((actual.translation() - expected.translation()).norm(), tolerance);
  EXPECT_LE(
      Eigen::AngleAxisd(Eigen::Matrix3d(actual.linear().transpose() * expected.linear())).angle(),
      tolerance);
}

TEST(InverseKinematics, IsTheInverseOfForwardKinematics) {
  const Robot fetch = LoadFetch();
  const PlanningGroup& group = fetch.groups.front();
  std::mt19937 poses(1);
  std::mt19937_64 random(1);
  for (int base = 0; base < 4; ++base) {
    const std::vector<double> held = RandomPositions(fetch.model, &poses);
    InverseKinematics kinematics(fetch.model, group, held);
    for (int trial = 0; trial < 100; ++trial) {
      const Eigen::Isometry3d X_BT =
          TipPose(fetch, group, held, RandomConfiguration(group.space, &poses));
      const IkResult result = kinematics.Solve(X_BT, &random);
      ASSERT_TRUE(result.solved);
      ExpectNear(TipPose(fetch, group, held, result.q), X_BT, 2e-6);
      ExpectNear(kinematics.TipPose(result.q), X_BT, 2e-6);
      EXPECT_EQ(group.space.FirstOutsideLimits(result.q), -1);
      for (int j = 0; j < group.space.size(); ++j) {
        const double position = result.q[static_cast<std::size_t>(j)];
        EXPECT_GE(position, group.space.joint(j).lower);  // of a continuous joint: -pi
        EXPECT_LE(position, group.space.joint(j).upper);
      }
    }
  }
}

TEST(InverseKinematics, FindsConfigurationsAtTheLimits) {
  const Robot fetch = LoadFetch();
  const PlanningGroup& group = fetch.groups.front();
  const std::vector<double> held = fetch.model.DefaultPositions();
  InverseKinematics kinematics(fetch.model, group, held);
  std::mt19937 poses(2);
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> q = RandomConfiguration(group.space, &poses);
    for (int j = 0; j < group.space.size(); ++j) {
      if (!group.space.joint(j).continuous && poses() % 2 == 0) {
        q[static_cast<std::size_t>(j)] =
            poses() % 2 == 0 ? group.space.joint(j).lower : group.space.joint(j).upper;
      }
    }
    const IkResult result = kinematics.Solve(kinematics.TipPose(q), &random);
    EXPECT_TRUE(result.solved);
    EXPECT_TRUE(group.space.WithinLimits(result.q));
  }
}

TEST(InverseKinematics, JointsOutsideTheGroupAreHeldAndThoseBeyondTheTipDoNotMatter) {
  const Robot fetch = LoadFetch();
  const PlanningGroup group =
      fetch.model.MakeGroup("arm",
                            {"shoulder_pan_joint", "shoulder_lift_joint", "upperarm_roll_joint",
                             "elbow_flex_joint", "forearm_roll_joint", "wrist_flex_joint",
                             "wrist_roll_joint", "head_pan_joint", "l_gripper_finger_joint"},
                            "gripper_link");
  std::mt19937 poses(3);
  std::mt19937_64 random(3);
  const std::vector<double> held = RandomPositions(fetch.model, &poses);
  InverseKinematics kinematics(fetch.model, group, held);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d X_BT =
        TipPose(fetch, group, held, RandomConfiguration(group.space, &poses));
    const IkResult result = kinematics.Solve(X_BT, &random);
    ASSERT_TRUE(result.solved);
    ExpectNear(TipPose(fetch, group, held, result.q), X_BT, 2e-6);
    EXPECT_TRUE(group.space.WithinLimits(result.q));
  }
}

TEST(InverseKinematics, PoseOutOfReachEndsAfterTheEffortAllowed) {
  const Robot fetch = LoadFetch();
  const PlanningGroup& group = fetch.groups.front();
  InverseKinematics kinematics(fetch.model, group, fetch.model.DefaultPositions());
  Eigen::Isometry3d X_BT = Eigen::Isometry3d::Identity();
  X_BT.translation() = Eigen::Vector3d(3, 0, 1);
  std::mt19937_64 random(4);
  const IkResult result = kinematics.Solve(X_BT, &random, {.max_starts = 7, .max_steps = 20});
  EXPECT_FALSE(result.solved);
  EXPECT_EQ(result.starts, 7);
  EXPECT_GT(result.steps, 0);
  EXPECT_LE(result.steps, 7 * 20);
  // What it says of the nearest configuration found is true.
  ASSERT_EQ(result.q.size(), 8);
  EXPECT_TRUE(group.space.WithinLimits(result.q));
  EXPECT_GT(result.position_error_m, 1.0);
  EXPECT_NEAR((kinematics.TipPose(result.q).translation() - X_BT.translation()).norm(),
              result.position_error_m, 1e-9);
}

TEST(InverseKinematics, ToleranceDecidesWhenAPoseIsReached) {
  const Robot fetch = LoadFetch();
  InverseKinematics kinematics(fetch.model, fetch.groups.front(), fetch.model.DefaultPositions());
  const Eigen::Isometry3d X_BT =
      kinematics.TipPose(std::vector<double>{0.2, 0.3, 0.1, 0, 1, 0.2, -0.8, 1});
  for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
    std::mt19937_64 random(5);
    const IkResult result = kinematics.Solve(
        X_BT, &random,
        {.position_tolerance_m = tolerance, .orientation_tolerance_rad = 10 * tolerance});
    ASSERT_TRUE(result.solved);
    EXPECT_LE(result.position_error_m, tolerance);
    EXPECT_LE(result.orientation_error_rad, 10 * tolerance);
  }
}

TEST(InverseKinematics, InfiniteToleranceLeavesAPartFree) {
  // An arm of three joints in a plane reaches no more than two coordinates and one angle, exactly.
  const Robot planar =
      LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "tests/data/planar3");
  const PlanningGroup& group = planar.groups.front();
  Eigen::Isometry3d X_LT = Eigen::Isometry3d::Identity();
  X_LT.translation() = Eigen::Vector3d(0.1, 0.05, 0.02);
  X_LT.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const std::vector<double> held = planar.model.DefaultPositions();
  InverseKinematics kinematics(planar.model, group, held, X_LT);
  std::mt19937 poses(6);
  std::mt19937_64 random(6);
  const Eigen::Matrix3d other = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  constexpr double kFree = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d X_BT =
        TipPose(planar, group, held, RandomConfiguration(group.space, &poses)) * X_LT;
    Eigen::Isometry3d turned = X_BT;
    turned.linear() = turned.linear() * other;
    EXPECT_FALSE(kinematics.Solve(turned, &random, {.max_starts = 5}).solved);
    const IkResult position =
        kinematics.Solve(turned, &random, {.orientation_tolerance_rad = kFree});
    ASSERT_TRUE(position.solved);
    EXPECT_EQ(position.orientation_error_rad, 0);
    EXPECT_LE(((TipPose(planar, group, held, position.q) * X_LT).translation() - X_BT.translation())
                  .norm(),
              2e-6);
    Eigen::Isometry3d raised = X_BT;
    raised.translation().z() += 1;
    EXPECT_FALSE(kinematics.Solve(raised, &random, {.max_starts = 5}).solved);
    const IkResult orientation = kinematics.Solve(raised, &random, {.position_tolerance_m = kFree});
    ASSERT_TRUE(orientation.solved);
    ExpectNear(Eigen::Isometry3d((TipPose(planar, group, held, orientation.q) * X_LT).linear()),
               Eigen::Isometry3d(X_BT.linear()), 2e-6);
  }
}

TEST(InverseKinematics, SameSeedSameSolutionOthersDiffer) {
  const Robot fetch = LoadFetch();
  const std::vector<double> held = fetch.model.DefaultPositions();
  InverseKinematics kinematics(fetch.model, fetch.groups.front(), held);
  InverseKinematics other(fetch.model, fetch.groups.front(), held);
  const Eigen::Isometry3d X_BT =
      kinematics.TipPose(std::vector<double>{0.2, 0.3, 0.1, 0, 1, 0.2, -0.8, 1});
  std::mt19937_64 a(6), b(6), c(7);
  const std::vector<double> first = kinematics.Solve(X_BT, &a).q;
  kinematics.Solve(Eigen::Isometry3d::Identity(), &c);  // Leaves no trace.
  EXPECT_EQ(first, other.Solve(X_BT, &b).q);
  EXPECT_EQ(kinematics.Solve(X_BT, &a).q, other.Solve(X_BT, &b).q);
  EXPECT_NE(first, kinematics.Solve(X_BT, &c).q);
}

}  // namespace
}  // namespace planbench
