#include "planner_ara/arms.h"

#include <gtest/gtest.h>

#include "support/planning_problems.h"
#include "support/two_arm_robot.h"

namespace planbench {
namespace {

void ExpectOneArm(const Arms& arms, std::size_t num_joints, std::size_t num_tips) {
  EXPECT_EQ(arms.num, 1);
  EXPECT_EQ(arms.of_joint, std::vector<int>(num_joints, 0));
  EXPECT_EQ(arms.of_tip, std::vector<int>(num_tips, 0));
}

TEST(Arms, AreTheJointsThatMoveOneTipAlone) {
  const Robot robot = MakeTwoArmRobot();
  const Arms arms = ArmsOf(robot.model, robot.groups.front());
  EXPECT_EQ(arms.num, 2);
  EXPECT_EQ(arms.of_joint, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(arms.of_tip, (std::vector<int>{0, 1}));
}

TEST(Arms, ATorsoIsOfNone) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const Arms arms = ArmsOf(robot.model, robot.groups.front());
  EXPECT_EQ(arms.num, 2);
  EXPECT_EQ(arms.of_joint, (std::vector<int>{2, 0, 0, 1, 1}));
}

TEST(Arms, ATipThatNoJointMovesAloneHasNone) {
  const Robot robot = MakeTwoArmRobot();
  PlanningGroup group = robot.groups.front();
  group.more_tips.insert(group.more_tips.begin(), robot.model.FindLink("base"));
  const Arms arms = ArmsOf(robot.model, group);
  EXPECT_EQ(arms.num, 2);
  EXPECT_EQ(arms.of_joint, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(arms.of_tip, (std::vector<int>{0, 2, 1}));
}

TEST(Arms, TipsAlongOneChainAreOneArm) {
  const Robot robot = MakeTwoArmRobot();
  PlanningGroup group =
      robot.model.MakeGroup("left", {"left_shoulder", "left_elbow"}, "left_hand", {"left_upper"});
  ExpectOneArm(ArmsOf(robot.model, group), 2, 2);
  ExpectOneArm(OneArm(robot.groups.front()), 4, 2);
  const Robot planar = LoadPlanarRobot();
  ExpectOneArm(ArmsOf(planar.model, planar.groups.front()), 3, 1);
}

}  // namespace
}  // namespace planbench
