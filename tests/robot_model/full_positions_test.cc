#include "robot_model/full_positions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Positions = std::vector<double>;

// slide, turn and spin; grip_b follows grip_a at half its way the other way, from 0.1; far follows
// grip_b; still is fixed, and echo follows it.
constexpr char kUrdf[] = R"(<robot name="r">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="a"/><link name="b"/>
  <link name="c"/><link name="d"/><link name="e"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="l1"/>
    <limit lower="0.5" upper="1" velocity="1" effort="1"/></joint>
  <joint name="cart" type="floating"><parent link="l1"/><child link="l2"/></joint>
  <joint name="far" type="revolute"><parent link="l2"/><child link="c"/>
    <limit lower="-9" upper="9" velocity="1" effort="1"/>
    <mimic joint="grip_b" multiplier="2" offset="1"/></joint>
  <joint name="grip_a" type="revolute"><parent link="l2"/><child link="a"/>
    <limit lower="0" upper="1" velocity="1" effort="1"/></joint>
  <joint name="grip_b" type="revolute"><parent link="l2"/><child link="b"/>
    <limit lower="-9" upper="9" velocity="1" effort="1"/>
    <mimic joint="grip_a" multiplier="-0.5" offset="0.1"/></joint>
  <joint name="still" type="fixed"><parent link="l2"/><child link="d"/>
    <origin xyz="0 -0.065 0.2" rpy="0 0 0.9"/>
    <mimic joint="grip_a"/></joint>
  <joint name="echo" type="revolute"><parent link="l2"/><child link="e"/>
    <limit lower="-9" upper="9" velocity="1" effort="1"/>
    <mimic joint="still" offset="0.3"/></joint>
</robot>)";

class FullPositionsTest : public testing::Test {
 protected:
  Positions Full(const std::vector<std::string>& names, const Positions& positions) {
    contradictions_ = FindContradictions(model_, names, positions);
    return FullPositions(model_, names, positions, "start");
  }

  const RobotModel model_ = RobotModel::FromUrdf(kUrdf, "r.urdf");
  std::vector<std::string> contradictions_;
};

TEST_F(FullPositionsTest, OnePositionForEachJointThatNeedsOne) {
  EXPECT_THAT(model_.position_names(),
              ElementsAre("slide", "cart/trans_x", "cart/trans_y", "cart/trans_z", "cart/rot_x",
                          "cart/rot_y", "cart/rot_z", "cart/rot_w", "grip_a"));
  EXPECT_THAT(model_.DefaultPositions(), ElementsAre(0.5, 0, 0, 0, 0, 0, 0, 1, 0));
  EXPECT_EQ(Full({}, {}), model_.DefaultPositions());
}

TEST_F(FullPositionsTest, TakesNamedOnes) {
  EXPECT_THAT(
      Full({"grip_a", "cart/trans_y", "cart/rot_w", "cart/rot_z", "slide"}, {0.7, 2, 0, -1, 0.25}),
      ElementsAre(0.25, 0, 2, 0, 0, 0, -1, 0, 0.7));
}

TEST_F(FullPositionsTest, AFixedJointMayBeNamedWhereItIs) {
  EXPECT_EQ(Full({"still"}, {0}), model_.DefaultPositions());
  EXPECT_EQ(Full({"still"}, {-1e-9}), model_.DefaultPositions());
  // Or where its origin puts it.
  EXPECT_EQ(Full({"still"}, {0.065}), model_.DefaultPositions());
  EXPECT_EQ(Full({"still"}, {-0.9}), model_.DefaultPositions());
  ExpectInputError([&] { Full({"still"}, {0.1}); }, {"start: joint 'still' is fixed", "0.1"});
}

TEST_F(FullPositionsTest, AFixedJointThatTellsNoAxisIsInDoubtAwayFromZero) {
  EXPECT_FALSE(FindPositionDoubt(model_, "still", 0));
  for (const double position : {0.065, -0.9}) {
    EXPECT_THAT(FindPositionDoubt(model_, "still", position).value_or(""),
                HasSubstr("is fixed; " + std::string(position > 0 ? "0.065" : "-0.9")));
  }
  EXPECT_FALSE(FindPositionDoubt(model_, "still", 0.1)) << "no number of its origin";
}

TEST(FullPositions, TheAxisOfAFixedJointTellsWhereItWasFixed) {
  const std::string ends = "<parent link='base'/><child link='";
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='base'/><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='finger' type='fixed'>" +
          ends +
          "a'/><origin xyz='0 -0.065 0.0584'/><axis xyz='0 -1 0'/></joint>"
          "<joint name='knuckle' type='fixed'>" +
          ends +
          "b'/><origin xyz='0.3 0 0' rpy='0 0 0.9'/><axis xyz='0 0 2'/></joint>"
          "<joint name='odd' type='fixed'>" +
          ends + "c'/><origin xyz='0.3 0 0'/><axis xyz='x'/></joint></robot>",
      "r.urdf");
  const auto is_taken = [&](const std::string& name, double position) {
    return !FindPositionFault(model, name, position);
  };
  const auto is_sure = [&](const std::string& name, double position) {
    return is_taken(name, position) && !FindPositionDoubt(model, name, position);
  };
  EXPECT_TRUE(is_sure("finger", 0.065));
  EXPECT_TRUE(is_sure("knuckle", 0.9));
  for (const auto& [name, position] :
       std::vector<std::pair<std::string, double>>{{"finger", -0.065},
                                                   {"finger", 0.0584},
                                                   {"knuckle", -0.9},
                                                   {"knuckle", 0.3},
                                                   {"odd", 0.3}}) {
    EXPECT_TRUE(is_taken(name, position)) << name << " " << position;
    EXPECT_FALSE(is_sure(name, position)) << name << " " << position;
  }
  EXPECT_FALSE(is_taken("finger", 0.04));
}

TEST(FullPositions, APlanarJointStaysInItsPlane) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='base'/><link name='l'/><joint name='cart' type='planar'>"
      "<parent link='base'/><child link='l'/></joint></robot>",
      "r.urdf");
  const auto at = [&](const std::string& part, double position) {
    return FindPositionFault(model, "cart/" + part, position);
  };
  for (const char* free : {"trans_x", "trans_y", "rot_z"}) EXPECT_FALSE(at(free, 0.5)) << free;
  for (const char* off : {"trans_z", "rot_x", "rot_y"}) {
    EXPECT_FALSE(at(off, -5e-5)) << off;
    EXPECT_THAT(at(off, -0.5).value_or(""), HasSubstr("cannot be at -0.5")) << off;
  }
}

TEST_F(FullPositionsTest, FollowersFollow) {
  EXPECT_EQ(Full({"grip_b", "grip_a", "far"}, {-0.1, 0.4, 0.8}).back(), 0.4);
  EXPECT_TRUE(contradictions_.empty());
  EXPECT_EQ(Full({"grip_a", "echo"}, {0.4, 0.3}).back(), 0.4);
  EXPECT_TRUE(contradictions_.empty());
}

TEST_F(FullPositionsTest, AFollowerThatContradictsItsLeaderDoesNotCount) {
  for (const bool leader_first : {true, false}) {
    EXPECT_EQ(leader_first ? Full({"grip_a", "grip_b"}, {0.4, 0.3}).back()
                           : Full({"grip_b", "grip_a"}, {0.3, 0.4}).back(),
              0.4);
    ASSERT_EQ(contradictions_.size(), 1u);
    EXPECT_EQ(contradictions_[0],
              "joint 'grip_b' is given at 0.3, but follows joint 'grip_a', which puts it at "
              "-0.1");
  }
  Full({"echo"}, {0});
  EXPECT_THAT(contradictions_, ElementsAre(HasSubstr("joint 'still', which puts it at 0.3")));
  // 0.1 - 0.3 / 2 is not quite -0.05.
  Full({"grip_b", "grip_a"}, {0, 0.3});
  EXPECT_THAT(contradictions_, ElementsAre(testing::EndsWith("puts it at -0.05")));
  // Where only followers are named, the last one tells.
  EXPECT_NEAR(Full({"grip_b", "far"}, {0.1, 0.6}).back(), 0.6, 1e-12);
  EXPECT_THAT(contradictions_,
              ElementsAre("joint 'grip_b' is given at 0.1, but follows joint "
                          "'grip_a', which is where 'far' has it, and puts it at -0.2"));
}

TEST_F(FullPositionsTest, AFollowerAloneTellsWhereItsLeaderIs) {
  EXPECT_NEAR(Full({"grip_b"}, {-0.2}).back(), 0.6, 1e-12);
  EXPECT_NEAR(Full({"far"}, {0.6}).back(), 0.6, 1e-12);
  EXPECT_TRUE(contradictions_.empty());
}

TEST_F(FullPositionsTest, RefusesWhatTheRobotDoesNotHave) {
  const auto full = [this](const std::vector<std::string>& names, const Positions& positions) {
    return [this, names, positions] { Full(names, positions); };
  };
  ExpectInputError(full({"slide"}, {1, 2}), {"start", "1 joint names", "2 positions"});
  ExpectInputError(full({"yankee"}, {1}), {"start", "'yankee' is unknown"});
  ExpectInputError(full({"cart"}, {1}), {"start", "'cart' takes a pose"});
  ExpectInputError(full({"cart/x"}, {1}), {"start", "'cart/x' is unknown"});
  ExpectInputError(full({"slide", "slide"}, {1, 1}), {"start", "'slide' occurs twice"});
}

TEST_F(FullPositionsTest, WherePossibleTakesWhatItCan) {
  EXPECT_THAT(FullPositionsWherePossible(
                  model_, {"yankee", "still", "grip_b", "grip_a", "cart", "cart/trans_x"},
                  {1, 0.5, 7, 0.2, 3, 4}),
              ElementsAre(0.5, 4, 0, 0, 0, 0, 0, 1, 0.2));
}

}  // namespace
}  // namespace planbench
