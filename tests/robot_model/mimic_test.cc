#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/numbers.h"
#include "robot_model/group_kinematics.h"
#include "robot_model/inverse_kinematics.h"
#include "robot_model/robot_model.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Follow {
  std::string leader;
  double multiplier;
  double offset;
};

// A tree of random joints; with `mimic`, some of them follow others (over chains, too), else the
// same joints on their own. The text is the same but for the mimic tags, given the same seed.
std::string RandomTree(std::uint32_t seed, bool mimic, std::map<std::string, Follow>* follows) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto number = [&] { return unit(random); };
  const int num_joints = 4 + static_cast<int>(random() % 6);
  std::string urdf = "<robot name='random'><link name='l0'/>";
  for (int j = 0; j < num_joints; ++j) {
    const char* types[] = {"revolute", "prismatic"};
    const int parent = static_cast<int>(random() % static_cast<unsigned>(j + 1));
    const std::string limit = "<limit lower='-100' upper='100' velocity='1' effort='1'/>";
    std::string tag;
    if (j > 0 && random() % 2 == 0) {
      // Of any other joint before it, so that there are chains but no circles.
      const Follow follow{fmt::format("j{}", random() % static_cast<unsigned>(j)), 2 * number(),
                          number()};
      tag = fmt::format("<mimic joint='{}' multiplier='{}' offset='{}'/>", follow.leader,
                        follow.multiplier, follow.offset);
      (*follows)[fmt::format("j{}", j)] = follow;
    }
    urdf += fmt::format(
        "<link name='l{}'/><joint name='j{}' type='{}'><parent link='l{}'/><child link='l{}'/>"
        "<origin xyz='{} {} {}' rpy='{} {} {}'/><axis xyz='{} {} {}'/>{}{}</joint>",
        j + 1, j, types[random() % 2], parent, j + 1, number(), number(), number(), 3 * number(),
        3 * number(), 3 * number(), number(), number(), number(), limit, mimic ? tag : "");
  }
  return urdf + "</robot>";
}

double PositionOf(const std::string& joint, const RobotModel& model,
                  const std::vector<double>& positions,
                  const std::map<std::string, Follow>& follows) {
  const auto follow = follows.find(joint);
  if (follow != follows.end()) {
    return follow->second.multiplier *
               PositionOf(follow->second.leader, model, positions, follows) +
           follow->second.offset;
  }
  const int index = model.FindJoint(joint);
  return positions[static_cast<std::size_t>(
      model.joints()[static_cast<std::size_t>(index)].position_index)];
}

void ExpectSamePoses(const std::vector<Eigen::Isometry3d>& a,
                     const std::vector<Eigen::Isometry3d>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].isApprox(b[i], 1e-12)) << i;
}

TEST(Mimic, FollowersMoveAsIfTheyWerePutThere) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::map<std::string, Follow> follows;
    const RobotModel model = RobotModel::FromUrdf(RandomTree(seed, true, &follows), "mimic");
    const RobotModel plain = RobotModel::FromUrdf(RandomTree(seed, false, &follows), "plain");
    EXPECT_EQ(model.num_positions() + static_cast<int>(follows.size()), plain.num_positions());
    std::mt19937 random(seed);
    std::vector<double> positions(static_cast<std::size_t>(model.num_positions()));
    for (double& position : positions) {
      position = std::uniform_real_distribution<double>(-2, 2)(random);
    }
    std::vector<double> plain_positions(static_cast<std::size_t>(plain.num_positions()));
    for (const Joint& joint : plain.joints()) {
      plain_positions[static_cast<std::size_t>(joint.position_index)] =
          PositionOf(joint.name, model, positions, follows);
    }
    ExpectSamePoses(ComputeLinkPoses(model, positions), ComputeLinkPoses(plain, plain_positions));
  }
}

// The leaders of a random tree, all or all but one, as a group.
PlanningGroup GroupOfLeaders(const RobotModel& model, std::mt19937* random) {
  std::vector<std::string> names;
  for (const Joint& joint : model.joints()) {
    if (joint.leader < 0) names.push_back(joint.name);
  }
  if (names.size() > 1 && (*random)() % 2 == 0) names.erase(names.begin());
  return model.MakeGroup("leaders", names, model.links().back().name);
}

TEST(Mimic, AGroupTakesItsFollowersAlong) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::map<std::string, Follow> follows;
    const RobotModel model = RobotModel::FromUrdf(RandomTree(seed, true, &follows), "mimic");
    const PlanningGroup group = GroupOfLeaders(model, &random);
    const auto draw = [&] { return std::uniform_real_distribution<double>(-2, 2)(random); };
    std::vector<double> held(static_cast<std::size_t>(model.num_positions()));
    for (double& position : held) position = draw();
    GroupKinematics kinematics(model, group, held);
    InverseKinematics inverse(model, group, held);
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<double> q(group.joints.size());
      for (double& position : q) position = draw();
      kinematics.Update(q);
      const auto expected = ComputeLinkPoses(model, WithGroupAt(model, group, held, q));
      for (int link = 0; link < model.num_links(); ++link) {
        EXPECT_TRUE(
            kinematics.X_BL(link).isApprox(expected[static_cast<std::size_t>(link)], 1e-12));
      }
      EXPECT_TRUE(
          inverse.TipPose(q).isApprox(expected[static_cast<std::size_t>(group.tip_link)], 1e-12));
    }
  }
}

// Two fingers and a wrist: what moves by one joint may turn all of a chain.
constexpr char kSnake[] = R"(<robot name="snake">
  <link name="l0"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/>
  <joint name="a" type="revolute"><parent link="l0"/><child link="l1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="b" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1.5" velocity="1" effort="1"/></joint>
  <joint name="c" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-9" upper="9" velocity="1" effort="1"/>
    <mimic joint="b" multiplier="-2" offset="0.5"/></joint>
  <joint name="d" type="prismatic"><parent link="l3"/><child link="l4"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" velocity="1" effort="1"/></joint>
</robot>)";

TEST(Mimic, InverseKinematicsMovesLeadersAndFollowersTogether) {
  const RobotModel model = RobotModel::FromUrdf(kSnake, "snake");
  const PlanningGroup group = model.MakeGroup("all", {"d", "b", "a"}, "l4");
  std::mt19937 poses(3);
  std::mt19937_64 random(3);
  InverseKinematics kinematics(model, group, model.DefaultPositions());
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d X_BT = kinematics.TipPose(RandomConfiguration(group.space, &poses));
    const IkResult result = kinematics.Solve(X_BT, &random);
    ASSERT_TRUE(result.solved) << trial;
    EXPECT_TRUE(kinematics.TipPose(result.q).isApprox(X_BT, 1e-5));
    EXPECT_TRUE(group.space.WithinLimits(result.q));
  }
}

Joint JointOf(const RobotModel& model, const std::string& name) {
  return model.joints()[static_cast<std::size_t>(model.FindJoint(name))];
}

TEST(Mimic, ALeaderStaysWhereItsFollowersMayBe) {
  const auto gripper = [](const std::string& follower_limits, const std::string& mimic,
                          std::vector<std::string>* warnings) {
    return RobotModel::FromUrdf(
        "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\n"
        "<joint name='f1' type='prismatic'><parent link='a'/><child link='b'/>"
        "<limit lower='0' upper='0.08' velocity='1' effort='1'/></joint>\n"
        "<joint name='f2' type='prismatic'><parent link='a'/><child link='c'/><limit " +
            follower_limits + " velocity='1' effort='1'/><mimic joint='f1' " + mimic +
            "/></joint></robot>",
        "r.urdf", warnings);
  };
  std::vector<std::string> warnings;
  RobotModel model = gripper("lower='0' upper='0.08'", "", &warnings);
  EXPECT_EQ(JointOf(model, "f1").upper, 0.08);
  EXPECT_TRUE(warnings.empty());

  model = gripper("lower='-0.02' upper='0.01'", "multiplier='-0.5' offset='0.01'", &warnings);
  EXPECT_DOUBLE_EQ(JointOf(model, "f1").lower, 0);
  EXPECT_DOUBLE_EQ(JointOf(model, "f1").upper, 0.06);
  EXPECT_DOUBLE_EQ(JointOf(model, "f2").lower, -0.02);
  EXPECT_DOUBLE_EQ(JointOf(model, "f2").upper, 0.01);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("r.urdf:2: joint 'f1': the limits of joint 'f2'")));

  warnings.clear();
  model = gripper("lower='0' upper='0.08'", "multiplier='-1'", &warnings);
  EXPECT_EQ(JointOf(model, "f1").upper, 0.08);
  EXPECT_EQ(JointOf(model, "f2").lower, -0.08);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("contradict")));

  warnings.clear();
  model = gripper("lower='0' upper='0'", "", &warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("joint 'f1': the limits of joint 'f2'")));
}

TEST(Mimic, AFollowerThatStandsStillOutOfItsLimitsIsNamed) {
  const auto warnings = [](const std::string& leader, const std::string& mimic) {
    std::vector<std::string> found;
    const RobotModel model = RobotModel::FromUrdf(
        "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
        "<joint name='i' " +
            leader +
            "<parent link='a'/><child link='b'/></joint>\n"
            "<joint name='j' type='prismatic'><parent link='b'/><child link='c'/><limit "
            "lower='-0.6' upper='0.9' velocity='1' effort='1'/><mimic joint='i' " +
            mimic + "/></joint></robot>",
        "r.urdf", &found);
    return found;
  };
  const std::string fixed = "type='fixed'>";
  const std::string turns = "type='continuous'>";
  const std::string stuck =
      "type='revolute'><limit lower='0.5' upper='0.5' velocity='1' effort='1'/>";
  EXPECT_THAT(warnings(fixed, "multiplier='-2' offset='0.9'"), ElementsAre());
  EXPECT_THAT(
      warnings(fixed, "multiplier='-2' offset='0.95'"),
      ElementsAre("r.urdf:2: joint 'j': it stands still at 0.95, out of its limits [-0.6, "
                  "0.9], which do not count, as it follows joint 'i', which does not move"));
  EXPECT_THAT(warnings(turns, "multiplier='0' offset='0.5'"), ElementsAre());
  EXPECT_THAT(warnings(turns, "multiplier='0' offset='5'"),
              ElementsAre(HasSubstr("at 5, out of its limits [-0.6, 0.9], which do not count, as "
                                    "it follows joint 'i' with the multiplier 0")));
  EXPECT_THAT(warnings(stuck, "multiplier='2'"),
              ElementsAre(HasSubstr("no range"), HasSubstr("joint 'j': it stands still at 1, ")));
}

TEST(Mimic, AGroupNamesLeadersOnly) {
  const RobotModel model = RobotModel::FromUrdf(kSnake, "snake");
  ExpectInputError(
      [&] {
        model.MakeGroup("g", {"a", "c"}, "l4");
      },
      {"joint 'c' follows joint 'b'", "name that one"});
  const PlanningGroup group = model.MakeGroup("g", {"a", "b"}, "l4");
  ASSERT_EQ(group.followers.size(), 1u);
  EXPECT_EQ(group.followers[0].joint, model.FindJoint("c"));
  EXPECT_EQ(group.followers[0].group_index, 1);
  EXPECT_TRUE(model.MakeGroup("g", {"a"}, "l4").followers.empty());
}

TEST(Mimic, AContinuousLeaderNeedsFollowersThatAreTheSameATurnLater) {
  const auto model = [](const char* type, const char* multiplier) {
    return RobotModel::FromUrdf(
        fmt::format("<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
                    "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
                    "<joint name='k' type='{}'><parent link='b'/><child link='c'/>"
                    "<limit velocity='1' effort='1'/>"
                    "<mimic joint='j' multiplier='{}'/></joint></robot>",
                    type, multiplier),
        "r.urdf");
  };
  EXPECT_NO_THROW(model("continuous", "-2").MakeGroup("g", {"j"}, "c"));
  EXPECT_EQ(model("continuous", "-2").FollowerThatTurnsMove(0), -1);
  EXPECT_EQ(model("continuous", "0.5").FollowerThatTurnsMove(0), 1);
  ExpectInputError([&] { model("continuous", "0.5").MakeGroup("g", {"j"}, "c"); },
                   {"'j' is continuous", "'k'", "a turn later"});
}

TEST(Mimic, WholeTurnsAreTakenFromLeadersWhoseFollowersAreTheSameATurnLater) {
  const auto model = [](const std::string& type, double multiplier) {
    return RobotModel::FromUrdf(
        fmt::format("<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
                    "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
                    "<limit lower='-9' upper='9' velocity='1' effort='1'/></joint>"
                    "<joint name='k' type='{}'><parent link='a'/><child link='c'/>"
                    "<limit lower='-99' upper='99' velocity='1' effort='1'/>"
                    "<mimic joint='j' multiplier='{}' offset='0.3'/></joint></robot>",
                    type, multiplier),
        "r.urdf");
  };
  const auto turned = [&](const std::string& type, double multiplier) {
    const RobotModel robot = model(type, multiplier);
    const PlanningGroup group = robot.MakeGroup("g", {"j"}, "b");  // Which `k` does not move.
    std::vector<double> q = {-4};
    group.space.ToNearestTurn(std::vector<double>{4}, q);
    ExpectSamePoses(ComputeLinkPoses(robot, q), ComputeLinkPoses(robot, std::vector<double>{-4}));
    return q[0];
  };
  for (const double multiplier : {0.0, 1.0, -3.0}) {
    EXPECT_NEAR(turned("revolute", multiplier), 2 * kPi - 4, 1e-12) << multiplier;
  }
  for (const double multiplier : {0.5, -1.25}) {
    EXPECT_EQ(turned("revolute", multiplier), -4) << multiplier;
    EXPECT_EQ(model("revolute", multiplier).FollowerThatTurnsMove(0), 1);
  }
  EXPECT_NEAR(turned("prismatic", 0), 2 * kPi - 4, 1e-12);
  EXPECT_EQ(turned("prismatic", 1), -4) << "metres are no turns";
}

TEST(Mimic, AContinuousLeaderHasNoEndlessRange) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='prismatic'><parent link='b'/><child link='c'/>"
      "<limit lower='-1' upper='1' velocity='1' effort='1'/>"
      "<mimic joint='j' multiplier='1e-300'/></joint></robot>",
      "r.urdf");
  EXPECT_EQ(model.joints()[0].lower, -1e4);
  EXPECT_EQ(model.joints()[0].upper, 1e4);
}

TEST(Mimic, WhatItsLeaderLeavesItTellsWhetherAFollowerTurnsForEver) {
  const auto follower = [](const char* j, const char* k) {
    const RobotModel model = RobotModel::FromUrdf(
        fmt::format("<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
                    "<joint name='j' {}<parent link='a'/><child link='b'/></joint>"
                    "<joint name='k' {}<parent link='b'/><child link='c'/></joint></robot>",
                    j, k),
        "r.urdf");
    return SpaceJoint(JointOf(model, "k"));
  };
  const JointSpace::Joint bounded =
      follower("type='revolute'><limit lower='-1' upper='2' velocity='1' effort='1'/>",
               "type='continuous'><mimic joint='j' multiplier='3'/>");
  EXPECT_FALSE(bounded.continuous);
  EXPECT_EQ(bounded.lower, -3);
  EXPECT_EQ(bounded.upper, 6);
  // Limits that leave its leader no range do not count.
  const JointSpace::Joint turning = follower(
      "type='continuous'>",
      "type='revolute'><limit lower='0' upper='0' velocity='1' effort='1'/><mimic joint='j'/>");
  EXPECT_TRUE(turning.continuous);
  EXPECT_EQ(turning.lower, -kPi);
  EXPECT_EQ(turning.upper, kPi);
}

TEST(MultiDof, PlanarAndFloatingJointsHoldAPose) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
      "<joint name='p' type='planar'><parent link='a'/><child link='b'/>"
      "<origin xyz='1 0 0'/></joint>"
      "<joint name='f' type='floating'><parent link='b'/><child link='c'/></joint>"
      "<joint name='j' type='continuous'><parent link='c'/><child link='d'/></joint></robot>",
      "r.urdf");
  EXPECT_EQ(model.num_positions(), 15);
  std::vector<double> positions = model.DefaultPositions();
  auto X_BL = ComputeLinkPoses(model, positions);
  EXPECT_TRUE(X_BL[3].translation().isApprox(Eigen::Vector3d(1, 0, 0)));
  positions[1] = 2;  // p/trans_y
  positions[5] = 2;  // p/rot_z: half a turn with rot_w = 0, whatever its length
  positions[6] = 0;  // p/rot_w
  positions[7] = 3;  // f/trans_x
  X_BL = ComputeLinkPoses(model, positions);
  EXPECT_TRUE(X_BL[1].translation().isApprox(Eigen::Vector3d(1, 2, 0)));
  EXPECT_TRUE(X_BL[3].translation().isApprox(Eigen::Vector3d(-2, 2, 0)));
  ExpectInputError([&] { model.MakeGroup("g", {"p"}, "d"); }, {"'p' is planar"});
  ExpectInputError([&] { model.MakeGroup("g", {"f"}, "d"); }, {"'f' is floating"});
}

}  // namespace
}  // namespace planbench
