#include "robot_model/srdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
              ElementsAre(HasSubstr("twin.srdf:4: group 'mount' has no joint"),
                          AllOf(HasSubstr("twin.srdf:5: group 'right'"), HasSubstr("lift, rj2")),
                          AllOf(HasSubstr("twin.srdf:6: group 'rolling'"), HasSubstr("lift")),
                          HasSubstr("twin.srdf:6: group 'rolling' has no joint")));
}

TEST(ParseSrdf, StatesEffectorsAndVirtualJoints) {
  const Srdf srdf = Parse(R"(
    <group name="left"><chain base_link="base" tip_link="l2"/></group>
    <group name="hand"><link name="f1"/></group>
    <group_state name="home" group="left"><joint name="lj2" value="-1.5"/></group_state>
    <group_state name="odd" group="left"><joint name="lift" value=" 0.2 "/><joint name="rj1" value="1"/>
    </group_state>
    <end_effector name="hand" group="hand" parent_link="palm" parent_group="left"/>
    <virtual_joint name="world" type="floating" parent_frame="map" child_link="base"/>)");
  EXPECT_THAT(srdf.groups[0].states, ElementsAre(Pair("home", ElementsAre(0.1, 0, -1.5)),
                                                 Pair("odd", ElementsAre(0.2, 0, 0))));
  EXPECT_THAT(srdf.left_out, ElementsAre(AllOf(HasSubstr("twin.srdf:6"), HasSubstr("rj1"))));
  ASSERT_EQ(srdf.end_effectors.size(), 1u);
  EXPECT_EQ(srdf.end_effectors[0].parent_link, "palm");
  EXPECT_EQ(srdf.end_effectors[0].parent_group, "left");
  ASSERT_EQ(srdf.virtual_joints.size(), 1u);
  EXPECT_EQ(srdf.virtual_joints[0].parent_frame, "map");
  EXPECT_EQ(srdf.virtual_joints[0].type, "floating");
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
  EXPECT_THAT(srdf.warnings, ElementsAre(HasSubstr("<unheard>"),
                                         AllOf(HasSubstr("3 of 5"), HasSubstr("bogey, ghost"))));
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
        MalformedSrdf{"empty_group", "<group name='a'/>", {":2", "'a' has no joints"}},
        MalformedSrdf{"no_name", "\n<group/>", {":3", "attribute 'name' is missing"}},
        MalformedSrdf{"twice",
                      "<group name='a'><joint name='lift'/></group>\n<group name='a'/>",
                      {":3", "'a' occurs twice"}},
        MalformedSrdf{"unknown_joint",
                      "<group name='a'>\n<joint name='knee'/></group>",
                      {":3", "no joint 'knee'"}},
        MalformedSrdf{"unknown_tip",
                      "<group name='a'><chain base_link='base' tip_link='toe'/></group>",
                      {":2", "no link 'toe'"}},
        MalformedSrdf{"no_chain",
                      "<group name='a'><chain base_link='l1' tip_link='r1'/></group>",
                      {":2", "no chain of joints", "'l1'", "'r1'"}},
        MalformedSrdf{
            "unknown_group", "<group name='a'><group name='b'/></group>", {":2", "no group 'b'"}},
        MalformedSrdf{
            "parts_of_each_other",
            "<group name='a'><group name='b'/></group><group name='b'><group name='a'/></group>",
            {":2", "a, b, a"}},
        MalformedSrdf{
            "state_of_no_group", "<group_state name='s' group='g'/>", {":2", "no group 'g'"}},
        MalformedSrdf{"effector_of_no_group",
                      "<end_effector name='e' group='g' parent_link='l1'/>",
                      {":2", "no group 'g'"}},
        MalformedSrdf{"effector_on_no_link",
                      "<end_effector name='e' group='g' parent_link='toe'/>",
                      {":2", "no link 'toe'"}},
        MalformedSrdf{"virtual_type",
                      "<virtual_joint name='v' type='hinge' parent_frame='w' child_link='base'/>",
                      {":2", "type", "hinge"}},
        MalformedSrdf{
            "state_value",
            "<group name='a'><joint name='lift'/></group>\n<group_state name='s' group='a'>"
            "<joint name='lift' value='high'/></group_state>",
            {":3", "value", "high"}},
        MalformedSrdf{"sphere_of_no_link",
                      "<link_sphere_approximation link='toe'><sphere center='0 0 0' radius='1'/>"
                      "</link_sphere_approximation>",
                      {":2", "no link 'toe'"}},
        MalformedSrdf{"sphere_centre",
                      "<link_sphere_approximation link='l1'><sphere center='0 0' radius='1'/>"
                      "</link_sphere_approximation>",
                      {":2", "center", "3 numbers", "'0 0'"}},
        MalformedSrdf{"sphere_radius",
                      "<link_sphere_approximation link='l1'><sphere center='0 0 0' radius='-1'/>"
                      "</link_sphere_approximation>",
                      {":2", "radius", "-1"}},
        MalformedSrdf{"not_closed", "<group name='a'>", {":", "<group>"}},
        MalformedSrdf{"xacro", "<xacro:include filename='x'/>", {":2", "xacro"}}),
    [](const auto& test) { return test.param.name; });

TEST(ParseSrdf, TheSrdfOfAnotherRobotIsToldByItsName) {
  ExpectInputError([] { Parse("<group name='a'><joint name='knee'/></group>", "walker"); },
                   {"twin.srdf:2", "'twin' has no joint 'knee'", "SRDF of 'walker'"});
}

TEST(ParseSrdf, ATextThatIsNoneIsRefused) {
  const auto parse = [](const std::string& text) { ParseSrdf(text, "x.srdf", Twin()); };
  ExpectInputError([&] { parse(""); }, {"x.srdf:"});
  ExpectInputError([&] { parse("<scene/>"); }, {"x.srdf:1", "<robot>"});
  ExpectInputError([&] { parse("<robot/>"); }, {"x.srdf:1", "'name'"});
}

}  // namespace
}  // namespace planbench
