#include "robot_tools/make_robot.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/read_text.h"
#include "robot_model/robot_folder.h"
#include "tests/robot_tools/make_robot_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;

TEST_F(MakeRobotTest, WithoutAnSrdfGroupsAreProposedAndPairsSampled) {
  const std::string report = Make();
  const Robot robot = LoadRobot(flags_.out);
  EXPECT_TRUE(robot.warnings.empty());
  EXPECT_EQ(robot.name, "crane");
  ASSERT_EQ(robot.groups.size(), 1u);
  EXPECT_EQ(robot.groups[0].name, "arm");
  EXPECT_EQ(robot.groups[0].space.size(), 3);
  EXPECT_EQ(robot.groups[0].tip_link, robot.model.FindLink("eye"));
  EXPECT_GE(robot.spheres.size(), 4u);
  EXPECT_THAT(robot.allowed_pairs, testing::Contains(std::minmax(robot.model.FindLink("base"),
                                                                 robot.model.FindLink("boom"))));
  EXPECT_LE(robot.edge_resolution_m, 0.02);
  EXPECT_THAT(report, HasSubstr("500 random configurations"));
  EXPECT_THAT(report, HasSubstr("arm: 3 joints, tip eye"));
  EXPECT_THAT(report, HasSubstr("enclose"));
  EXPECT_THAT(ReadText(flags_.out / "robot.yaml"), HasSubstr("from crane.urdf."));
}

TEST_F(MakeRobotTest, AnSrdfSaysGroupsStatesAndPairs) {
  Srdf();
  const std::string report = Make();
  const Robot robot = LoadRobot(flags_.out);
  ASSERT_EQ(robot.groups.size(), 1u);
  EXPECT_EQ(robot.groups[0].name, "jib");
  EXPECT_EQ(robot.groups[0].states.at("parked"), (std::vector<double>{0, -0.5, 0}));
  EXPECT_EQ(robot.allowed_pairs.size(), 4u);
  EXPECT_TRUE(robot.checked_pairs.empty());
  EXPECT_THAT(report, HasSubstr("crane.srdf:10: 1 of 5 <disable_collisions>"));
  EXPECT_THAT(report, HasSubstr("wheel"));
  EXPECT_THAT(report, HasSubstr("state 'bent': joint 'luff' at 3 is outside its limits"));
  EXPECT_THAT(report, HasSubstr("base stands at world by the fixed joint 'yard'"));
  ASSERT_EQ(robot.virtual_joints.size(), 1u);
  EXPECT_EQ(robot.virtual_joints[0].name, "yard");
  EXPECT_EQ(robot.virtual_joints[0].type, JointType::kFixed);
  EXPECT_EQ(robot.virtual_joints[0].parent_frame, "world");
  EXPECT_EQ(robot.virtual_joints[0].child_link, robot.model.FindLink("base"));
}

TEST_F(MakeRobotTest, AGroupThatIsNoneIsLeftOutAndSaid) {
  Srdf(
      "<robot name='crane'>\n<group name='none'/><group name='jib'><joint name='slew'/></group>"
      "</robot>");
  EXPECT_THAT(Make(), HasSubstr("crane.srdf:2: group 'none' is left out: it has no joint"));
  EXPECT_EQ(LoadRobot(flags_.out).groups.size(), 1u);
  flags_.out = folder_.path() / "nothing";
  Srdf("<robot name='crane'>\n<group name='none'/></robot>");
  ExpectRefused({"crane.srdf has no group", "crane.srdf:2", "'none'", "proposed without --srdf"});
  Srdf(
      "<robot name='crane'><link_sphere_approximation link='hook'>"
      "<sphere center='0 0 0' radius='0.1'/></link_sphere_approximation></robot>");
  ExpectRefused({"crane.srdf has no group", "give it by --spheres instead"});
}

TEST_F(MakeRobotTest, TheWrittenRobotIsTheOneThatItWasMadeFrom) {
  Srdf();
  Make();
  const Robot once = LoadRobot(flags_.out);
  // Made again from what was written, with an SRDF's part taken from robot.yaml's own text.
  flags_.urdf = flags_.out / "crane.urdf";
  flags_.spheres = flags_.out / "spheres.yaml";
  flags_.out = folder_.path() / "again";
  Make();
  const Robot again = LoadRobot(flags_.out);
  EXPECT_EQ(again.content_id, once.content_id) << ReadText(flags_.out / "robot.yaml");
}

TEST_F(MakeRobotTest, WhatAnSrdfSaysOfLinksAndGroupsThatThereAreNotEndsNothing) {
  const std::string spheres =
      "<link_sphere_approximation link='wheel'><sphere center='0 0 0' radius='1'/>"
      "</link_sphere_approximation>";
  const std::string others =
      "<robot name='crane'><group name='jib'><joint name='luff'/></group>"
      "<end_effector name='claw' group='jib' parent_link='wheel'/>\n"
      "<group_state name='up' group='wheels'/>\n";
  Srdf(others + spheres + "</robot>");
  EXPECT_THAT(Make(),
              AllOf(HasSubstr("crane.srdf:1: end effector 'claw' is left out"),
                    HasSubstr("crane.srdf:2: state 'up' is left out: there is no group 'wheels'"),
                    HasSubstr("crane.srdf:3: 1 of 1 <link_sphere_approximation> do not count: the "
                              "URDF of robot 'crane' has no link wheel"),
                    HasSubstr("the URDF's collision geometry")));
  // As a sphere model of its own it would leave the robot without a body.
  flags_.spheres = flags_.srdf;
  flags_.out = folder_.path() / "other";
  ExpectRefused({"crane.srdf:3", "no link wheel"});
  Srdf(others + spheres +
       "<link_sphere_approximation link='hook'><sphere center='0 0 0' radius='0.1'/>"
       "</link_sphere_approximation></robot>");
  EXPECT_THAT(Make(), AllOf(HasSubstr("crane.srdf:3: 1 of 2 <link_sphere_approximation>"),
                            HasSubstr("spheres: 1 on 1 link, from crane.srdf")));
}

TEST_F(MakeRobotTest, EdgesAreSampledByTheReachOfTurnsAndTheTravelOfSlides) {
  // A bridge over `travel` m, a quill, and a wrist that reaches 0.05 m.
  const auto resolution_of = [&](double travel) {
    folder_.Write(
        "in/crane.urdf",
        fmt::format("<robot name='gantry'><link name='frame'/><link name='bridge'/>"
                    "<link name='quill'/><link name='wrist'><collision><origin xyz='0.04 0 0'/>"
                    "<geometry><sphere radius='0.01'/></geometry></collision></link>"
                    "<joint name='x' type='prismatic'><parent link='frame'/><child link='bridge'/>"
                    "<limit lower='-0.1' upper='{}' velocity='1' effort='1'/></joint>"
                    "<joint name='z' type='prismatic'><parent link='bridge'/><child link='quill'/>"
                    "<axis xyz='0 0 1'/><limit lower='0' upper='0.21' velocity='1' effort='1'/>"
                    "</joint><joint name='turn' type='continuous'><parent link='quill'/>"
                    "<child link='wrist'/><axis xyz='0 0 1'/></joint></robot>",
                    travel - 0.1));
    flags_.replace = true;
    EXPECT_THAT(Make(), HasSubstr("where they are sampled, nothing moves more than"));
    return LoadRobot(flags_.out).edge_resolution_m;
  };
  EXPECT_EQ(resolution_of(0.82), 0.008);
  EXPECT_EQ(resolution_of(9), 0.02);
  EXPECT_EQ(resolution_of(0.11), 0.002) << "the quill's travel";
}

TEST_F(MakeRobotTest, RefusesInOneLine) {
  Spheres("links:\n  toe: [{center: [0, 0, 0], radius: 0.1}]\n");
  ExpectRefused({"spheres.yaml:2", "toe"});
  flags_.spheres.clear();
  Srdf("<robot name='walker'>\n<group name='leg'><joint name='knee'/></group></robot>");
  ExpectRefused({"crane.srdf:2", "'knee'", "SRDF of 'walker'"});
  Srdf("<robot name='crane'><group name='eye'><joint name='ring'/></group></robot>");
  ExpectRefused({"crane.srdf", "no group"});
  flags_.srdf.clear();
  flags_.name = "a/b";
  ExpectRefused({"'a/b'", "--name"});
  flags_.name = "";
  const std::filesystem::path folder = flags_.out;
  flags_.out = flags_.urdf;
  ExpectInputError([&] { MakeSilently(); }, {"--out", "crane.urdf", "is a file"});
  flags_.out = folder;
  flags_.name = "";
  Make();
  ExpectInputError([&] { MakeSilently(); }, {flags_.out.string(), "--replace"});
}

}  // namespace
}  // namespace planbench
