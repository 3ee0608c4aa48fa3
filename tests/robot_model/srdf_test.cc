#include "robot_model/srdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "common/read_text.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

// A torso that carries two arms of two joints; the left one has a hand with two fingers, of which
// the second follows the first.
constexpr char kTwinUrdf[] = R"(<robot name="twin">
  <link name="base"/><link name="torso"/><link name="l1"/><link name="l2"/><link name="r1"/>
  <link name="r2"/><link name="palm"/><link name="f1"/><link name="f2"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="torso"/>
    <limit lower="0.1" upper="0.4" velocity="1" effort="1"/></joint>
  <joint name="lj1" type="continuous"><parent link="torso"/><child link="l1"/></joint>
  <joint name="lj2" type="continuous"><parent link="l1"/><child link="l2"/></joint>
  <joint name="mount" type="fixed"><parent link="l2"/><child link="palm"/></joint>
  <joint name="fj1" type="prismatic"><parent link="palm"/><child link="f1"/>
    <limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
  <joint name="fj2" type="prismatic"><parent link="palm"/><child link="f2"/>
    <limit lower="0" upper="0.04" velocity="1" effort="1"/><mimic joint="fj1"/></joint>
  <joint name="rj1" type="continuous"><parent link="torso"/><child link="r1"/></joint>
  <joint name="rj2" type="floating"><parent link="r1"/><child link="r2"/></joint>
</robot>)";

RobotModel Twin() { return RobotModel::FromUrdf(kTwinUrdf, "twin.urdf"); }

Srdf Parse(const std::string& elements, const std::string& name = "twin") {
  return ParseSrdf("<robot name=\"" + name + "\">\n" + elements + "\n</robot>", "twin.srdf",
                   Twin());
}

std::vector<std::string> JointNames(const PlanningGroup& group) {
  std::vector<std::string> names;
  for (const JointSpace::Joint& joint : group.space.joints()) names.push_back(joint.name);
  return names;
}

std::vector<std::string> Tips(const PlanningGroup& group) {
  const RobotModel model = Twin();
  std::vector<std::string> names = {model.links()[static_cast<std::size_t>(group.tip_link)].name};
  for (const int tip : group.more_tips) {
    names.push_back(model.links()[static_cast<std::size_t>(tip)].name);
  }
  return names;
}

TEST(ParseSrdf, GroupsAreChainsJointsLinksAndGroups) {
  const Srdf srdf = Parse(R"(
    <group name="left"><chain base_link="torso" tip_link="palm"/></group>
    <group name="joints"><joint name="lj2"/><joint name="lift"/></group>
    <group name="links"><link name="r1"/><link name="base"/><link name="torso"/></group>
    <group name="both"><group name="left"/><chain base_link="base" tip_link="r1"/></group>)");
  ASSERT_EQ(srdf.groups.size(), 4u);
  EXPECT_EQ(srdf.groups[0].name, "left");
  EXPECT_THAT(JointNames(srdf.groups[0]), ElementsAre("lj1", "lj2"));
  EXPECT_THAT(Tips(srdf.groups[0]), ElementsAre("palm"));
  EXPECT_THAT(JointNames(srdf.groups[1]), ElementsAre("lift", "lj2")) << "in the URDF's order";
  EXPECT_THAT(Tips(srdf.groups[1]), ElementsAre("l2")) << "the outermost";
  EXPECT_THAT(JointNames(srdf.groups[2]), ElementsAre("lift", "rj1"));
  EXPECT_THAT(JointNames(srdf.groups[3]), ElementsAre("lift", "lj1", "lj2", "rj1"));
  EXPECT_THAT(Tips(srdf.groups[3]), ElementsAre("r1", "palm"));
  EXPECT_THAT(srdf.left_out, IsEmpty());
  EXPECT_THAT(srdf.warnings, IsEmpty());
}

TEST(ParseSrdf, WhatCannotBePlannedWithIsLeftOutAndSaid) {
  const Srdf srdf = Parse(R"(
    <group name="fingers"><link name="f1"/><link name="f2"/><link name="palm"/></group>
    <group name="mount"><joint name="mount"/></group>
    <group name="right"><joint name="rj1"/><joint name="rj2"/><joint name="lift"/></group>
    <group name="rolling"><joint name="world"/><joint name="lift"/></group>
    <virtual_joint name="world" type="planar" parent_frame="odom" child_link="base"/>
    <passive_joint name="lift"/>)");
  ASSERT_EQ(srdf.groups.size(), 2u);
  EXPECT_THAT(JointNames(srdf.groups[0]), ElementsAre("fj1")) << "the other follows it";
  EXPECT_EQ(srdf.groups[0].followers.size(), 1u);
  EXPECT_THAT(JointNames(srdf.groups[1]), ElementsAre("rj1"));
  EXPECT_THAT(srdf.left_out,
              ElementsAre(HasSubstr("twin.srdf:4: group 'mount' is left out: it has no joint"),
                          AllOf(HasSubstr("twin.srdf:5: group 'right'"), HasSubstr("lift"))));
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre(AllOf(HasSubstr("twin.srdf:5: group 'right': planar and floating"),
                                HasSubstr("held where problems say: rj2")),
                          AllOf(HasSubstr("twin.srdf:6: group 'rolling' is left out"),
                                HasSubstr("held where problems say: world, lift"))));
  EXPECT_THAT(srdf.why_no_group, ElementsAre(Pair("mount", srdf.left_out[0]),
                                             Pair("rolling", srdf.group_warnings[1])));
}

TEST(ParseSrdf, APlanarVirtualJointOfAGroupIsNamedAndAFixedOneSaysNothing) {
  const Srdf srdf = Parse(R"(
    <virtual_joint name="wheels" type="planar" parent_frame="odom" child_link="base"/>
    <virtual_joint name="bolt" type="fixed" parent_frame="world" child_link="base"/>
    <group name="rolling"><joint name="wheels"/><joint name="lift"/></group>
    <group name="whole"><group name="rolling"/><joint name="lj1"/></group>
    <group name="standing"><joint name="bolt"/><joint name="lift"/></group>)");
  EXPECT_EQ(srdf.groups.size(), 3u);
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre(AllOf(HasSubstr("twin.srdf:5: group 'rolling'"), HasSubstr("wheels")),
                          AllOf(HasSubstr("twin.srdf:6: group 'whole'"), HasSubstr("wheels"))));
}

TEST(ParseSrdf, AnEmptyGroupIsLeftOutAndTheOthersStand) {
  const Srdf srdf = Parse(R"(
    <group name="none"/>
    <group name="left"><chain base_link="torso" tip_link="l2"/></group>
    <group name="all"><group name="none"/><group name="left"/></group>
    <group name="part"><group name="none"/></group>)");
  ASSERT_EQ(srdf.groups.size(), 2u);
  EXPECT_EQ(srdf.groups[0].name, "left");
  EXPECT_EQ(srdf.groups[1].name, "all");
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre(HasSubstr("twin.srdf:3: group 'none' is left out: it has no joint"),
                          HasSubstr("twin.srdf:6: group 'part' is left out: it has no joint")));
}

TEST(ParseSrdf, AGroupThatCannotBePlannedWithIsLeftOut) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='wheel' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='half' type='continuous'><parent link='b'/><child link='c'/>"
      "<mimic joint='wheel' multiplier='0.5'/></joint>"
      "<link name='d'/><joint name='turn' type='continuous'><parent link='a'/><child link='d'/>"
      "</joint></robot>",
      "r.urdf");
  const Srdf srdf = ParseSrdf(
      "<robot name='r'><group name='bad'><joint name='wheel'/></group>"
      "<group name='good'><joint name='turn'/></group></robot>",
      "r.srdf", model);
  ASSERT_EQ(srdf.groups.size(), 1u);
  EXPECT_THAT(srdf.group_warnings, ElementsAre(AllOf(HasSubstr("r.srdf:1: group 'bad' is left out"),
                                                     HasSubstr("a turn later"))));
}

TEST(ParseSrdf, AChainIsAllBetweenTwoLinks) {
  const Srdf srdf = Parse(R"(
    <group name="across"><chain base_link="l2" tip_link="r1"/></group>
    <group name="reverse"><chain base_link="palm" tip_link="l1"/></group>
    <group name="to_root"><chain base_link="l1" tip_link="base"/></group>)");
  ASSERT_EQ(srdf.groups.size(), 3u);
  EXPECT_THAT(JointNames(srdf.groups[0]), ElementsAre("lift", "lj1", "lj2", "rj1"))
      << "with the joint beneath";
  EXPECT_THAT(Tips(srdf.groups[0]), ElementsAre("r1", "l2"));
  EXPECT_THAT(JointNames(srdf.groups[1]), ElementsAre("lj1", "lj2"));
  EXPECT_THAT(Tips(srdf.groups[1]), ElementsAre("palm"));
  EXPECT_THAT(JointNames(srdf.groups[2]), ElementsAre("lift", "lj1"));
  EXPECT_THAT(Tips(srdf.groups[2]), ElementsAre("l1"));
}

TEST(ParseSrdf, StatesEffectorsAndVirtualJoints) {
  const Srdf srdf = Parse(R"(
    <group name="left"><chain base_link="base" tip_link="l2"/></group>
    <group name="hand"><link name="f1"/></group>
    <group_state name="home" group="left"><joint name="lj2" value="-1.5"/></group_state>
    <group_state name="odd" group="left"><joint name="lift" value=" 0.2 "/><joint name="rj1" value="1"/>
      <joint name="lj1" value="0"/><joint name="lj2" value="0"/></group_state>
    <end_effector name="hand" group="hand" parent_link="palm" parent_group="left"/>
    <virtual_joint name="world" type="floating" parent_frame="map" child_link="base"/>)");
  EXPECT_THAT(srdf.groups[0].states, ElementsAre(Pair("home", ElementsAre(0.1, 0, -1.5)),
                                                 Pair("odd", ElementsAre(0.2, 0, 0))));
  EXPECT_THAT(srdf.left_out, ElementsAre(AllOf(HasSubstr("twin.srdf:6"), HasSubstr("rj1"))));
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre(AllOf(HasSubstr("twin.srdf:5: state 'home'"),
                                HasSubstr("at their defaults: lift at 0.1, lj1 at 0"))));
  ASSERT_EQ(srdf.end_effectors.size(), 1u);
  EXPECT_EQ(srdf.end_effectors[0].parent_link, "palm");
  EXPECT_EQ(srdf.end_effectors[0].parent_group, "left");
  ASSERT_EQ(srdf.virtual_joints.size(), 1u);
  EXPECT_EQ(srdf.virtual_joints[0].parent_frame, "map");
  EXPECT_EQ(srdf.virtual_joints[0].type, JointType::kFloating);
}

TEST(ParseSrdf, StatesOutsideTheLimitsOrWithAFollowerElsewhereAreNamed) {
  const Srdf srdf = Parse(R"(
    <group name="hand"><joint name="fj1"/></group>
    <group_state name="open" group="hand"><joint name="fj1" value="0.04"/><joint name="fj2" value="0.0405"/></group_state>
    <group_state name="torn" group="hand"><joint name="fj1" value="0.04"/><joint name="fj2" value="0.01"/></group_state>
    <group_state name="half" group="hand"><joint name="fj2" value="0.02"/></group_state>
    <group_state name="wide" group="hand"><joint name="fj1" value="0.05"/></group_state>)");
  EXPECT_THAT(srdf.groups.at(0).states,
              ElementsAre(Pair("half", ElementsAre(0.02)), Pair("open", ElementsAre(0.04)),
                          Pair("torn", ElementsAre(0.04)), Pair("wide", ElementsAre(0.05))));
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre("twin.srdf:5: state 'torn': joint 'fj2' is given at 0.01, but follows "
                          "joint 'fj1', which puts it at 0.04",
                          "twin.srdf:7: state 'wide': joint 'fj1' at 0.05 is outside its limits "
                          "[0, 0.04]"));
  EXPECT_THAT(srdf.left_out, IsEmpty());
}

TEST(ParseSrdf, JointsOfAStateComeInTheFilesOrder) {
  std::string urdf = "<robot name='claw'><link name='base'/>";
  for (const char* joint : {"lead", "b", "a"}) {
    urdf += fmt::format(
        "<link name='{0}_link'/><joint name='{0}' type='continuous'><parent link='base'/>"
        "<child link='{0}_link'/>{1}</joint>",
        joint, joint == std::string("lead") ? "" : "<mimic joint='lead'/>");
  }
  const RobotModel model = RobotModel::FromUrdf(urdf + "</robot>", "claw.urdf");
  const auto state = [&](const std::string& joints) {
    return ParseSrdf(fmt::format("<robot name='claw'><group name='all'><joint name='lead'/></group>"
                                 "<group_state name='grip' group='all'>{}</group_state></robot>",
                                 joints),
                     "claw.srdf", model);
  };
  const std::string followers = "<joint name='b' value='0.2'/><joint name='a' value='0.1'/>";
  EXPECT_THAT(state(followers + "<joint name='lead' value='0'/>").group_warnings,
              ElementsAre(HasSubstr("joint 'b' is given at 0.2"), HasSubstr("joint 'a' is given")));
  // As in problem files the last follower puts its leader.
  EXPECT_THAT(state(followers).groups.at(0).states, ElementsAre(Pair("grip", ElementsAre(0.1))));
}

TEST(ParseSrdf, StatesAreTakenWithoutTurns) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='wheel'><link name='base'/><link name='rim'/><joint name='roll' "
      "type='continuous'><parent link='base'/><child link='rim'/></joint></robot>",
      "wheel.urdf");
  const Srdf srdf = ParseSrdf(
      "<robot name='wheel'><group name='all'><joint name='roll'/></group>\n"
      "<group_state name='on' group='all'><joint name='roll' value='3.5'/></group_state>\n"
      "<group_state name='over' group='all'><joint name='roll' value='90'/></group_state></robot>",
      "wheel.srdf", model);
  EXPECT_THAT(srdf.groups.at(0).states, ElementsAre(Pair("on", ElementsAre(WrapAngle(3.5))),
                                                    Pair("over", ElementsAre(WrapAngle(90)))));
  EXPECT_THAT(srdf.group_warnings, ElementsAre("wheel.srdf:3: state 'over': joint 'roll' is at 90 "
                                               "rad, 14.3 turns; degrees?"));
}

TEST(ParseSrdf, UnknownJointsOfStatesAndPassiveOnesAreNamedAndDoNotCount) {
  const Srdf srdf = Parse(R"(
    <group name="left"><chain base_link="base" tip_link="l2"/></group>
    <group name="none"/>
    <passive_joint name="gripper"/><passive_joint name="lj2"/>
    <group_state name="up" group="left"><joint name="left" value="0.3"/>
      <joint name="lj1" value="1"/><joint name="gripper" value="wide"/></group_state>
    <group_state name="up" group="none"><joint name="gripper" value="1"/></group_state>)");
  EXPECT_THAT(srdf.groups.at(0).states, ElementsAre(Pair("up", ElementsAre(0.1, 1))));
  EXPECT_THAT(srdf.group_warnings,
              ElementsAre(HasSubstr("twin.srdf:5: <passive_joint> does not count: the URDF of "
                                    "robot 'twin' has no joint 'gripper'"),
                          HasSubstr("group 'none' is left out"),
                          AllOf(HasSubstr("twin.srdf:6: state 'up': <joint> does not count"),
                                HasSubstr("no joint 'left'; did you mean 'lift'?")),
                          AllOf(HasSubstr("twin.srdf:7: state 'up'"), HasSubstr("'gripper'")),
                          AllOf(HasSubstr("twin.srdf:6"), HasSubstr("defaults: lift at 0.1")),
                          AllOf(HasSubstr("twin.srdf:8: state 'up'"), HasSubstr("'gripper'"))));
}

TEST(ParseSrdf, StatesOfNoGroupAndEffectorsOnNothingAreNamedAndLeftOut) {
  const Srdf srdf = Parse(R"(
    <group name="left"><chain base_link="base" tip_link="l2"/></group>
    <group name="hand"><link name="f1"/></group>
    <group_state name="open" group="hnad"><joint name="fj1" value="0"/></group_state>
    <end_effector name="tool" group="hand" parent_link="plam" parent_group="left"/>
    <end_effector name="claw" group="hand" parent_link="palm" parent_group="right"/>)");
  EXPECT_THAT(srdf.end_effectors, IsEmpty());
  EXPECT_THAT(
      srdf.group_warnings,
      ElementsAre(AllOf(HasSubstr("twin.srdf:6: end effector 'tool' is left out"),
                        HasSubstr("no link 'plam'; did you mean 'palm'?")),
                  AllOf(HasSubstr("twin.srdf:7: end effector 'claw' is left out"),
                        HasSubstr("there is no group 'right'")),
                  "twin.srdf:5: state 'open' is left out: there is no group 'hnad'; did you mean "
                  "'hand'?"));
}

TEST(ParseSrdf, AFixedVirtualJointMayHaveTheNameOfAFixedOne) {
  const Srdf srdf = Parse(
      "<virtual_joint name='mount' type='fixed' parent_frame='world' child_link='base'/>"
      "<group name='a'><joint name='mount'/><joint name='lift'/></group>");
  EXPECT_EQ(srdf.virtual_joints.size(), 1u);
  EXPECT_THAT(JointNames(srdf.groups.at(0)), ElementsAre("lift"));
  EXPECT_THAT(srdf.warnings, IsEmpty());
}

TEST(ParseSrdf, XmlThatIsNoUsualOneIsRead) {
  const Srdf srdf = ParseSrdf(
      "\xEF\xBB\xBF<?xml version='1.0' encoding='UTF-8'?><?xml-model href='a<b' type=\"x>y<z>\"?>\n"
      "<!----><!-- <group> - -> <!DOCTYPE robot [ --->\n"
      "<!DOCTYPE robot PUBLIC '-//a[1]//EN' \"robot.dtd\">\n"
      "<robot name = 'twin' xmlns:x='http://x' x:name='a > b'\n\txsi:schemaLocation=\"it's /\" >"
      "<!--> <group> --><group name='a'><![CDATA[</robot> <b]]>it's > \"<joint name='lift' />"
      "</group ></robot ><!-- <robot> -->\n",
      "twin.srdf", Twin());
  EXPECT_EQ(srdf.groups.size(), 1u);
  EXPECT_THAT(srdf.warnings, IsEmpty());
}

TEST(ParseSrdf, PairsOfUnknownLinksAreNamedOnce) {
  const Srdf srdf = Parse(R"(
    <disable_collisions link1="l1" link2="base" reason="Never"/>
    <disable_collisions link1="base" link2="l1" reason="Never"/>
    <disable_collisions link1="ghost" link2="l1"/><disable_collisions link1="l2" link2="ghost"/>
    <disable_collisions link1="l2" link2="bogey"/>
    <disable_default_collisions link="f1"/>
    <enable_collisions link1="f2" link2="f1"/><unheard of="it"/>)");
  const RobotModel model = Twin();
  EXPECT_EQ(srdf.disabled_pairs.size(), 1u + 7u) << "the first twice, and f1 with all but f2";
  EXPECT_THAT(srdf.disabled_pairs,
              testing::Contains(std::minmax(model.FindLink("base"), model.FindLink("l1"))));
  EXPECT_THAT(
      srdf.disabled_pairs,
      testing::Not(testing::Contains(std::minmax(model.FindLink("f1"), model.FindLink("f2")))));
  EXPECT_THAT(srdf.warnings,
              ElementsAre(HasSubstr("twin.srdf:8: <unheard>"),
                          AllOf(HasSubstr("twin.srdf:5: 3 of 5 <disable_collisions>"),
                                HasSubstr("bogey, ghost"))));
}

TEST(ParseSrdf, EachKindOfPairIsCountedApart) {
  const Srdf srdf = Parse(R"(
    <disable_collisions link1="l1" link2="base"/>
    <disable_default_collisions link="f3"/>
    <enable_collisions link1="r1" link2="l2"/>
    <enable_collisions link1="r1" link2="r3"/>)");
  EXPECT_THAT(srdf.warnings,
              ElementsAre(AllOf(HasSubstr("twin.srdf:4: 1 of 1 <disable_default_collisions>"),
                                HasSubstr("no link f3")),
                          AllOf(HasSubstr("twin.srdf:6: 1 of 2 <enable_collisions>"),
                                HasSubstr("no link r3"))));
}

class CheckedPairsTest : public testing::Test {
 protected:
  using Pairs = std::vector<std::pair<int, int>>;
  std::pair<int, int> Links(const char* a, const char* b) const {
    const int link_a = model_.FindLink(a);
    const int link_b = model_.FindLink(b);
    return std::minmax(link_a, link_b);
  }
  const RobotModel model_ = Twin();
};

TEST_F(CheckedPairsTest, WithoutPairsLinksThatAJointConnectsAreNotChecked) {
  const Srdf srdf = Parse("");
  EXPECT_THAT(srdf.checked_pairs, IsEmpty());
  EXPECT_THAT(srdf.enabled_pairs, IsEmpty());
  EXPECT_EQ(Parse("<enable_collisions link1='l2' link2='l1'/>").checked_pairs,
            Pairs{Links("l1", "l2")});
}

TEST_F(CheckedPairsTest, AFileThatDisablesPairsSaysAllThatAreNotChecked) {
  const Srdf srdf = Parse(R"(
    <disable_default_collisions link="palm"/><disable_default_collisions link="torso"/>
    <disable_collisions link1="l1" link2="l2"/><enable_collisions link1="torso" link2="l1"/>)");
  EXPECT_EQ(srdf.checked_pairs, Pairs{Links("torso", "l1")})
      << "r1 and r2 are checked anyway: their joint is floating";
  EXPECT_EQ(srdf.enabled_pairs, Pairs{Links("torso", "l1")});
  EXPECT_THAT(srdf.warnings, IsEmpty());
}

TEST_F(CheckedPairsTest, WhatCannotBeAsTheFileSaysIsNamed) {
  const Srdf srdf = Parse(R"(
    <enable_collisions link1="l2" link2="palm"/><enable_collisions link1="l1" link2="l2"/>
    <disable_collisions link1="l2" link2="l1"/>)");
  EXPECT_THAT(srdf.enabled_pairs, IsEmpty());
  EXPECT_EQ(srdf.disabled_pairs, Pairs{Links("l1", "l2")});
  EXPECT_THAT(srdf.warnings, ElementsAre(HasSubstr("twin.srdf:3: l2 and palm are rigid"),
                                         HasSubstr("twin.srdf:4: l2 and l1 are not checked")));
}

TEST(ParseSrdf, UnknownElementsAndAttributesAreNamedWhereverTheyStand) {
  const Srdf srdf = Parse(R"(
    <group name="left" nam="l"><chain base_link="torso" tip_link="palm"/>
      <joints name="lift"/></group>
    <group_state name="up" group="left"><joint name="lj1" value="1"/>
      <Joint name="lj2" value="1"/><joint name="lj2" value="2" unit="deg"/></group_state>
    <link_sphere_approximation link="l1" xmlns:x="y" x:z="1"><sphere center="0 1 0" radius="0.2"/>
      <ball><sphere/></ball></link_sphere_approximation>)");
  EXPECT_THAT(srdf.warnings,
              ElementsAre(HasSubstr("twin.srdf:3: the attribute 'nam' of <group> is not known"),
                          HasSubstr("twin.srdf:4: <joints> is not known in <group>"),
                          HasSubstr("twin.srdf:6: <Joint> is not known in <group_state>"),
                          HasSubstr("twin.srdf:6: the attribute 'unit' of <joint>"),
                          HasSubstr("twin.srdf:8: <ball> is not known in "
                                    "<link_sphere_approximation>")));
  EXPECT_THAT(JointNames(srdf.groups.at(0)), ElementsAre("lj1", "lj2"));
}

TEST(ParseSrdf, AGroupOfFollowersAloneSaysWhomTheyFollow) {
  const Srdf srdf = Parse("<group name='hand'><joint name='fj2'/></group>");
  EXPECT_THAT(srdf.left_out, ElementsAre(AllOf(HasSubstr("twin.srdf:2: group 'hand' is left out"),
                                               HasSubstr("fj2 follows fj1"))));
}

TEST(ParseSrdf, SphereApproximations) {
  const Srdf srdf = Parse(R"(
    <link_sphere_approximation link="l1"><sphere center="0 1 0" radius="0.2"/>
      <sphere center="0 2 0" radius="0.1"/></link_sphere_approximation>
    <link_sphere_approximation link="base"><sphere center="0 0 0" radius="0"/>
    </link_sphere_approximation>)");
  ASSERT_EQ(srdf.spheres.size(), 2u);
  EXPECT_EQ(srdf.spheres[1].link, Twin().FindLink("l1"));
  EXPECT_EQ(srdf.spheres[1].p_LS, Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(srdf.spheres[1].radius, 0.1);
  EXPECT_THAT(srdf.sphere_warnings, IsEmpty());
}

TEST(ParseSrdf, SpheresOfUnknownLinksAreNamedOnce) {
  const Srdf srdf = Parse(R"(
    <link_sphere_approximation link="toe"><sphere center="0 1 0" radius="0.2"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="l1"><sphere center="0 2 0" radius="0.1"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="heel"/>)");
  ASSERT_EQ(srdf.spheres.size(), 1u);
  EXPECT_EQ(srdf.spheres[0].link, Twin().FindLink("l1"));
  EXPECT_THAT(srdf.warnings, IsEmpty());
  EXPECT_THAT(srdf.sphere_warnings,
              ElementsAre("twin.srdf:3: 2 of 3 <link_sphere_approximation> do not count: the URDF "
                          "of robot 'twin' has no link heel, toe"));
}

TEST(ParseSrdf, ThePandasFileSaysWhatItSays) {
  PLANBENCH_NEED_SHARED_DATA("panda_description/panda.srdf");
  const RobotModel model =
      RobotModel::FromUrdf(ReadText(SharedData("panda_description/panda_spherized.urdf")), "urdf");
  const Srdf srdf =
      ParseSrdf(ReadText(SharedData("panda_description/panda.srdf")), "panda.srdf", model);
  ASSERT_EQ(srdf.groups.size(), 2u) << "the fingers are fixed, so that the hand is no group";
  EXPECT_EQ(srdf.groups[0].space.size(), 7);
  EXPECT_EQ(srdf.groups[0].states.at("ready")[3], -2.356);
  EXPECT_EQ(model.links()[static_cast<std::size_t>(srdf.groups[0].tip_link)].name, "panda_link8");
  EXPECT_EQ(srdf.disabled_pairs.size(), 34u);
  EXPECT_THAT(srdf.warnings, IsEmpty());
}

struct MalformedSrdf {
  std::string name;
  std::string elements;
  std::vector<std::string> message;
};
void PrintTo(const MalformedSrdf& malformed, std::ostream* out) { *out << malformed.name; }

class MalformedSrdfTest : public testing::TestWithParam<MalformedSrdf> {};

TEST_P(MalformedSrdfTest, IsRefusedWithFileAndLine) {
  std::vector<std::string> parts = GetParam().message;
  parts.push_back("twin.srdf:");
  ExpectInputError([] { Parse(GetParam().elements); }, parts);
}

INSTANTIATE_TEST_SUITE_P(
    ParseSrdf, MalformedSrdfTest,
    testing::Values(
        MalformedSrdf{"no_name", "\n<group/>", {":3", "attribute 'name' is missing"}},
        MalformedSrdf{"twice",
                      "<group name='a'><joint name='lift'/></group>\n<group name='a'/>",
                      {":3", "'a' occurs twice"}},
        MalformedSrdf{"unknown_joint",
                      "<group name='a'>\n<joint name='knee'/></group>",
                      {":3", "no joint 'knee'"}},
        MalformedSrdf{"misspelt_joint",
                      "<group name='a'>\n<joint name='left'/></group>",
                      {":3", "no joint 'left'; did you mean 'lift'?"}},
        MalformedSrdf{"unknown_tip",
                      "<group name='a'><chain base_link='base' tip_link='toe'/></group>",
                      {":2", "no link 'toe'"}},
        MalformedSrdf{
            "unknown_group", "<group name='a'><group name='b'/></group>", {":2", "no group 'b'"}},
        MalformedSrdf{
            "parts_of_each_other",
            "<group name='a'><group name='b'/></group><group name='b'><group name='a'/></group>",
            {":2", "a, b, a"}},
        MalformedSrdf{"effector_of_no_group",
                      "<end_effector name='e' group='g' parent_link='l1'/>",
                      {":2", "no group 'g'"}},
        MalformedSrdf{"effector_of_a_misspelt_group",
                      "<group name='hand'><joint name='lift'/></group>\n"
                      "<end_effector name='e' group='hnad' parent_link='l1'/>",
                      {":3", "no group 'hnad'; did you mean 'hand'?"}},
        MalformedSrdf{"virtual_joint_of_no_link",
                      "<virtual_joint name='v' type='fixed' parent_frame='w' child_link='toe'/>",
                      {":2", "no link 'toe'"}},
        MalformedSrdf{"virtual_type",
                      "<virtual_joint name='v' type='hinge' parent_frame='w' child_link='base'/>",
                      {":2", "type", "hinge"}},
        MalformedSrdf{
            "state_value",
            "<group name='a'><joint name='lift'/></group>\n<group_state name='s' group='a'>"
            "<joint name='lift' value='high'/></group_state>",
            {":3", "value", "high"}},
        MalformedSrdf{"state_twice",
                      "<group name='a'><joint name='lift'/></group>"
                      "<group_state name='s' group='a'/>\n<group_state name='s' group='a'/>",
                      {":3", "state 's' of group 'a' occurs twice"}},
        MalformedSrdf{"value_twice",
                      "<group name='a'><joint name='lift'/></group><group_state name='s' "
                      "group='a'><joint name='lift' value='.2'/>\n<joint name='lift' "
                      "value='.3'/></group_state>",
                      {":3", "state 's'", "'lift' twice"}},
        MalformedSrdf{"virtual_joint_twice",
                      "<virtual_joint name='v' type='fixed' parent_frame='w' child_link='base'/>\n"
                      "<virtual_joint name='v' type='planar' parent_frame='w' child_link='base'/>",
                      {":3", "'v' occurs twice"}},
        MalformedSrdf{
            "virtual_joint_of_the_urdf",
            "<virtual_joint name='lj1' type='planar' parent_frame='w' child_link='base'/>",
            {":2", "'lj1'", "joint of the URDF"}},
        MalformedSrdf{
            "planar_joint_of_the_urdf",
            "<virtual_joint name='mount' type='planar' parent_frame='w' child_link='base'/>",
            {":2", "'mount'", "joint of the URDF"}},
        MalformedSrdf{"fixed_joint_that_the_urdf_moves",
                      "<virtual_joint name='lj1' type='fixed' parent_frame='w' child_link='base'/>",
                      {":2", "'lj1'", "joint of the URDF"}},
        MalformedSrdf{"sphere_centre",
                      "<link_sphere_approximation link='l1'><sphere center='0 0' radius='1'/>"
                      "</link_sphere_approximation>",
                      {":2", "center", "3 numbers", "'0 0'"}},
        MalformedSrdf{"sphere_radius",
                      "<link_sphere_approximation link='l1'><sphere center='0 0 0' radius='-1'/>"
                      "</link_sphere_approximation>",
                      {":2", "radius", "-1"}},
        MalformedSrdf{"group_that_turns_direction",
                      "\n<group name='\xe2\x81\xa6' />",
                      {":3", "<group>", "control character"}},
        MalformedSrdf{"state_of_two_lines",
                      "<group name='a'><joint name='lift'/></group>\n"
                      "<group_state name='up\ndown' group='a'/>",
                      {":3", "<group_state>", "one line"}},
        MalformedSrdf{"not_closed", "<group name='a'>", {":", "<group>"}},
        MalformedSrdf{"xacro", "<xacro:include filename='x'/>", {":2", "xacro"}},
        MalformedSrdf{"substitution",
                      "<group name='a'><joint name='lift'/></group>\n<group_state "
                      "name='s' group='$(arg group)'/>",
                      {":3", "<group_state>", "'$(arg group)' is xacro"}},
        MalformedSrdf{"substitution_within",
                      "<group name='a'>\n<joint name='${prefix}lift'/></group>",
                      {":3", "<joint>", "'${prefix}' is xacro"}}),
    [](const auto& test) { return test.param.name; });

TEST(ParseSrdf, TheSrdfOfAnotherRobotIsToldByItsName) {
  ExpectInputError([] { Parse("<group name='a'><joint name='knee'/></group>", "walker"); },
                   {"twin.srdf:2", "'twin' has no joint 'knee'", "SRDF of 'walker'"});
  EXPECT_THAT(
      Parse("<group name='a'><joint name='lift'/></group>", "walker").warnings,
      ElementsAre(AllOf(HasSubstr("twin.srdf:1"), HasSubstr("'walker'"), HasSubstr("'twin'"))));
}

TEST(ParseSrdf, ATextThatIsNoneIsRefused) {
  const auto parse = [](const std::string& text) { ParseSrdf(text, "x.srdf", Twin()); };
  ExpectInputError([&] { parse(""); }, {"x.srdf:"});
  ExpectInputError([&] { parse("<scene/>"); }, {"x.srdf:1", "<robot>"});
  ExpectInputError([&] { parse("<robot/>"); }, {"x.srdf:1", "'name'"});
}

}  // namespace
}  // namespace planbench
