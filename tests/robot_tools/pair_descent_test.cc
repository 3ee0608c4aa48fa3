#include "robot_tools/pair_descent.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "robot_tools/joint_draw.h"
#include "robot_tools/pair_sampling.h"

namespace planbench {
namespace {

// An arm of two links of 0.4 m that turns about its foot, with a ball of 1 cm at its tip. The foot
// is a link on a rail along x, at `x` where the rail is at zero.
std::string Arm(const std::string& name, double x, double travel) {
  return fmt::format(
      R"(<link name="{0}_foot"/><link name="{0}_turn"/><link name="{0}_upper"/><link name="{0}_tip"/>
  <joint name="{0}_rail" type="prismatic"><parent link="floor"/><child link="{0}_foot"/>
    <origin xyz="{1} 0 0"/><axis xyz="1 0 0"/>
    <limit lower="-{2}" upper="{2}" velocity="1" effort="1"/></joint>
  <joint name="{0}_1" type="continuous"><parent link="{0}_foot"/><child link="{0}_turn"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="{0}_2" type="revolute"><parent link="{0}_turn"/><child link="{0}_upper"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="{0}_3" type="revolute"><parent link="{0}_upper"/><child link="{0}_tip"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>)",
      name, x, travel);
}

Robot Make(const std::string& body) {
  Robot robot;
  robot.model = RobotModel::FromUrdf(
      "<robot name=\"test\"><link name=\"floor\"/>" + body + "</robot>", "test.urdf");
  return robot;
}

Robot TwoArms(double apart, double travel) {
  Robot robot = Make(Arm("left", 0, travel) + Arm("right", apart, travel));
  for (const char* tip : {"left_tip", "right_tip"}) {
    robot.spheres.push_back({robot.model.FindLink(tip), {0.4, 0, 0}, 0.01});
  }
  return robot;
}

bool Meet(const Robot& robot, const char* a, const char* b) {
  return FindContact(robot, robot.model.FindLink(a), robot.model.FindLink(b), 1);
}

bool MetInSamples(const Robot& robot) {
  return SamplePairs(robot, {JointsToDraw(robot.model), 500, 1}).Never().empty();
}

TEST(PairDescentTest, FindsContactThatSamplesMiss) {
  const Robot near = TwoArms(1, 0);
  EXPECT_FALSE(MetInSamples(near));
  EXPECT_TRUE(Meet(near, "left_tip", "right_tip"));
  EXPECT_TRUE(Meet(near, "right_tip", "left_tip"));
  EXPECT_FALSE(Meet(TwoArms(1.7, 0), "left_tip", "right_tip")) << "out of reach";
}

TEST(PairDescentTest, LongRailsAreTravelledToWhereTheArmsMeet) {
  for (const double travel : {50.0, 1000.0}) {
    const Robot robot = TwoArms(1, travel);
    EXPECT_FALSE(MetInSamples(robot));
    EXPECT_TRUE(Meet(robot, "left_tip", "right_tip")) << travel;
  }
  EXPECT_FALSE(Meet(TwoArms(10, 4), "left_tip", "right_tip")) << "the rails end before";
}

// A pointer that turns about z, and a peg where it points at 1.5 rad.
Robot PointerAndPeg(double lower, double upper) {
  Robot robot = Make(fmt::format(
      R"(<link name="pointer"/><joint name="turn" type="revolute"><parent link="floor"/>
  <child link="pointer"/><axis xyz="0 0 1"/>
  <limit lower="{}" upper="{}" velocity="1" effort="1"/></joint>)",
      lower, upper));
  robot.spheres = {{robot.model.FindLink("floor"), {std::cos(1.5), std::sin(1.5), 0}, 1e-3},
                   {robot.model.FindLink("pointer"), {1, 0, 0}, 1e-3}};
  return robot;
}

TEST(PairDescentTest, KeepsToTheLimits) {
  EXPECT_TRUE(Meet(PointerAndPeg(0, 1.6), "floor", "pointer"));
  EXPECT_FALSE(Meet(PointerAndPeg(0, 1.49), "floor", "pointer")) << "8 mm are left";
  EXPECT_TRUE(Meet(PointerAndPeg(0, 1.494), "floor", "pointer")) << "4 mm, taken for contact";
  EXPECT_FALSE(Meet(PointerAndPeg(1.6, 7), "floor", "pointer"));
  EXPECT_TRUE(Meet(PointerAndPeg(1.6, 8), "floor", "pointer")) << "a turn later";
}

TEST(PairDescentTest, FindsContactWhereOtherSpheresAreNearestElsewhere) {
  // The arm's tip is 3 cm off the globe wherever it points, and meets the peg in one place.
  Robot robot = Make(
      R"(<link name="turn"/><link name="arm"/>
  <joint name="pan" type="revolute"><parent link="floor"/><child link="turn"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="lift" type="revolute"><parent link="turn"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" velocity="1" effort="1"/></joint>)");
  const int floor = robot.model.FindLink("floor");
  robot.spheres = {{floor, {0, 0, 0}, 0.96},
                   {floor, {0, 0.8, 0.6}, 0.01},
                   {robot.model.FindLink("arm"), {1, 0, 0}, 0.01}};
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    EXPECT_TRUE(FindContact(robot, floor, robot.model.FindLink("arm"), seed)) << seed;
  }
}

TEST(PairDescentTest, JointsThatFollowMoveAlong) {
  // Two blocks approach each other by one joint, and the peg by the joint that follows.
  Robot robot = Make(
      R"(<link name="lead"/><link name="follow"/>
  <joint name="a" type="prismatic"><parent link="floor"/><child link="lead"/>
    <origin xyz="500 0 0"/><axis xyz="-1 0 0"/>
    <limit lower="0" upper="990" velocity="1" effort="1"/></joint>
  <joint name="b" type="prismatic"><parent link="floor"/><child link="follow"/>
    <origin xyz="-500 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="990" velocity="1" effort="1"/><mimic joint="a"/></joint>)");
  const int floor = robot.model.FindLink("floor");
  robot.spheres = {{floor, {480, 0, 0}, 0.005},
                   {robot.model.FindLink("lead"), {0, 0, 0}, 0.005},
                   {robot.model.FindLink("follow"), {0, 0, 0}, 0.005}};
  EXPECT_TRUE(Meet(robot, "lead", "follow"));
  EXPECT_TRUE(Meet(robot, "floor", "follow"));
  robot.spheres.front().p_LS.x() = 490.1;
  EXPECT_FALSE(Meet(robot, "floor", "follow")) << "beyond the travel";
}

}  // namespace
}  // namespace planbench
