#include "robot_tools/make_robot.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/read_text.h"
#include "robot_model/robot_folder.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::HasSubstr;

// Three joints, a box, a cylinder, a sphere and a mesh-free hand whose second finger follows.
constexpr char kCraneUrdf[] = R"(<robot name="crane">
  <link name="base"><collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="mast"><collision><origin xyz="0 0 0.5"/><geometry>
    <cylinder radius="0.05" length="1"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.6 0 0"/><geometry>
    <cylinder radius="0.05" length="0.2"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="eye"/>
  <joint name="slew" type="continuous"><parent link="base"/><child link="mast"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>
  <joint name="luff" type="revolute"><parent link="mast"/><child link="boom"/>
    <origin xyz="0.1 0 1"/><axis xyz="0 1 0"/><limit lower="-1" upper="1.2" velocity="1" effort="1"/>
  </joint>
  <joint name="reel" type="prismatic"><parent link="boom"/><child link="hook"/>
    <origin xyz="0.9 0 -0.2"/><axis xyz="0 0 -1"/>
    <limit lower="0" upper="0.6" velocity="1" effort="1"/></joint>
  <joint name="ring" type="fixed"><parent link="hook"/><child link="eye"/></joint>
</robot>)";

constexpr char kSrdf[] = R"(<robot name="crane">
  <group name="jib"><chain base_link="base" tip_link="eye"/></group>
  <group_state name="parked" group="jib"><joint name="luff" value="-0.5"/></group_state>
  <group_state name="bent" group="jib"><joint name="luff" value="3"/></group_state>
  <virtual_joint name="yard" type="fixed" parent_frame="world" child_link="base"/>
  <disable_collisions link1="base" link2="mast" reason="Adjacent"/>
  <disable_collisions link1="mast" link2="boom" reason="Adjacent"/>
  <disable_collisions link1="boom" link2="hook" reason="Adjacent"/>
  <disable_collisions link1="base" link2="boom" reason="Never"/>
  <disable_collisions link1="base" link2="wheel" reason="Never"/>
</robot>)";

class MakeRobotTest : public testing::Test {
 protected:
  MakeRobotTest() {
    folder_.Write("in/crane.urdf", kCraneUrdf);
    folder_.Write("in/crane.srdf", kSrdf);
    flags_.urdf = folder_.path() / "in/crane.urdf";
    flags_.out = folder_.path() / "out";
    flags_.samples = 500;
    flags_.protrusion_m = 0.1;
  }
  std::string Make() {
    std::string report;
    MakeRobot(flags_, [&](const std::string& line) { report += line + "\n"; });
    return report;
  }
  void MakeSilently() {
    MakeRobot(flags_, [](const std::string&) {});
  }
  void Srdf(const std::string& text = kSrdf) {
    folder_.Write("in/crane.srdf", text);
    flags_.srdf = folder_.path() / "in/crane.srdf";
  }
  void ExpectRefused(const std::vector<std::string>& parts) {
    ExpectInputError([&] { MakeSilently(); }, parts);
    EXPECT_FALSE(std::filesystem::exists(flags_.out)) << "something was written";
  }

  TemporaryFolder folder_;
  MakeRobotFlags flags_;
};

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

TEST_F(MakeRobotTest, LinksThatAJointConnectsAreCheckedUnlessTheSrdfDisablesThem) {
  // The boom meets the mast where it hangs.
  folder_.Write("in/spheres.yaml",
                "links:\n  mast: [{center: [0.1, 0, 0.8], radius: 0.1}]\n"
                "  boom: [{center: [0.3, 0, 0], radius: 0.15}]\n");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  const std::string group = "<robot name='crane'><group name='jib'><joint name='luff'/></group>";
  Srdf(group + "<disable_collisions link1='base' link2='boom'/></robot>");
  EXPECT_THAT(Make(), AllOf(HasSubstr("checked, though a joint connects them, as the SRDF does not "
                                      "disable them: base and mast; mast and boom; boom and hook"),
                            testing::Not(HasSubstr("jib: 1000 of 1000"))));
  const Robot robot = LoadRobot(flags_.out);
  EXPECT_EQ(robot.checked_pairs.size(), 3u);
  EXPECT_TRUE(robot.ChecksLinks(robot.model.FindLink("mast"), robot.model.FindLink("boom")));
  // An SRDF without disabled pairs says nothing of them.
  Srdf(group + "</robot>");
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(testing::Not(HasSubstr("though a joint connects them")),
                            HasSubstr("jib: 1000 of 1000")));
  EXPECT_TRUE(LoadRobot(flags_.out).checked_pairs.empty());
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

TEST_F(MakeRobotTest, NoPairThatTheSrdfEnablesIsExempt) {
  const std::string group = "<robot name='crane'><group name='jib'><joint name='luff'/></group>";
  Srdf(group + "<enable_collisions link1='boom' link2='base'/></robot>");
  EXPECT_THAT(Make(), HasSubstr("met in none of"));
  const Robot apart = LoadRobot(flags_.out);
  EXPECT_TRUE(apart.ChecksLinks(apart.model.FindLink("base"), apart.model.FindLink("boom")));
  // A ball of the boom about its joint is always in that of the mast.
  folder_.Write("in/spheres.yaml",
                "links:\n  mast: [{center: [0.1, 0, 1], radius: 0.1}]\n"
                "  boom: [{center: [0, 0, 0], radius: 0.1}]\n");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  flags_.replace = true;
  const std::string disabled = "<disable_collisions link1='base' link2='boom'/>";
  Srdf(group + disabled + "</robot>");
  EXPECT_THAT(Make(), HasSubstr("not checked either: mast and boom"));
  Srdf(group + disabled + "<enable_collisions link1='boom' link2='mast'/></robot>");
  EXPECT_THAT(Make(), AllOf(HasSubstr("checked, though in contact in nearly all configurations, as "
                                      "the SRDF enables them: mast and boom"),
                            testing::Not(HasSubstr("not checked either"))));
  const Robot together = LoadRobot(flags_.out);
  EXPECT_TRUE(
      together.ChecksLinks(together.model.FindLink("mast"), together.model.FindLink("boom")));
}

TEST_F(MakeRobotTest, AHandOfSpheresThatAlwaysTouchIsExempt) {
  folder_.Write(
      "in/spheres.yaml",
      "links:\n  base: [{center: [0, 0, 0], radius: 0.3}]\n"
      "  boom: [{center: [0, 0, -1], radius: 1.5}]\n  hook: [{center: [0, 0, 0], radius: 0.01}]\n");
  Srdf(
      "<robot name='crane'><group name='jib'><joint name='slew'/></group>"
      "<disable_collisions link1='hook' link2='boom'/></robot>");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  const std::string report = Make();
  EXPECT_THAT(report, HasSubstr("not checked either: base and boom"));
  EXPECT_THAT(report, HasSubstr("so that they are not checked: mast"));
  EXPECT_EQ(LoadRobot(flags_.out).allowed_pairs.size(), 2u);
  EXPECT_TRUE(LoadRobot(flags_.out).warnings.empty()) << "robot.yaml names the link";
}

TEST_F(MakeRobotTest, WhatTouchesByDefaultWhileNoGroupMovesItIsExempt) {
  // The hook hangs at the boom's foot unless it is let down.
  folder_.Write("in/spheres.yaml",
                "links:\n  mast: [{center: [0, 0, 1], radius: 0.1}]\n"
                "  hook: [{center: [-0.9, 0, 0.2], radius: 0.1}]\n");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  Srdf(
      "<robot name='crane'><group name='foot'><joint name='slew'/></group>"
      "<disable_collisions link1='hook' link2='boom'/></robot>");
  EXPECT_THAT(Make(),
              HasSubstr("moved one against the other by no group, so that they are not checked "
                        "either: mast and hook"));
  Srdf(
      "<robot name='crane'><group name='jib'><joint name='reel'/></group>"
      "<disable_collisions link1='hook' link2='boom'/></robot>");
  flags_.replace = true;
  EXPECT_THAT(Make(), testing::Not(HasSubstr("by no group")));
}

// The mast's ball about the boom's joint holds the hook unless that is let down; the base's meets
// the boom in half of the directions that the crane can face.
constexpr char kTightSpheres[] =
    "links:\n  base: [{center: [0.7, 0, 1.2], radius: 1}]\n"
    "  mast: [{center: [0.1, 0, 1], radius: 0.45}]\n"
    "  boom: [{center: [0.6, 0, 0], radius: 0.05}]\n"
    "  hook: [{center: [-0.9, 0, -0.3], radius: 0.1}]\n";

TEST_F(MakeRobotTest, WhatAGroupMovesIsCheckedThoughItTouchesWhereOthersAreHeld) {
  folder_.Write("in/spheres.yaml", kTightSpheres);
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  // The reel, in no group, is wound up by default; where a problem lets the hook down, the luffing
  // boom may meet the mast with it or not.
  Srdf(
      "<robot name='crane'><group name='tip'><joint name='luff'/></group>"
      "<group name='foot'><joint name='slew'/></group>"
      "<group_state name='back' group='foot'><joint name='slew' value='3.14'/></group_state>"
      "<disable_collisions link1='base' link2='hook'/></robot>");
  const std::string report = Make();
  EXPECT_THAT(report, AllOf(testing::Not(HasSubstr("by no group")),
                            HasSubstr("tip: 0 of 1000 random configurations are free"),
                            HasSubstr("mast and hook (100 %)")));
  const Robot robot = LoadRobot(flags_.out);
  EXPECT_TRUE(robot.ChecksLinks(robot.model.FindLink("mast"), robot.model.FindLink("hook")));
  // Turning the crane does not move them against each other: that is no reason to exempt them.
  EXPECT_THAT(report, AllOf(HasSubstr("foot: 0 of 1000 random configurations are free"),
                            HasSubstr("the group does not move these, which touch as other joints "
                                      "stand by default: mast and hook; give those another"),
                            testing::Not(HasSubstr("state 'back'"))));
}

TEST_F(MakeRobotTest, SelfCollisionIsThatOfTheGroupsJointsAndNamesItsPairs) {
  folder_.Write("in/spheres.yaml", kTightSpheres);
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  Srdf(
      "<robot name='crane'><group name='foot'><joint name='slew'/></group>"
      "<disable_collisions link1='mast' link2='hook'/>"
      "<disable_collisions link1='base' link2='hook'/></robot>");
  const std::string report = Make();
  EXPECT_THAT(report,
              testing::ContainsRegex("foot: [0-9]+ of 1000 random configurations are free"));
  EXPECT_THAT(report, HasSubstr("most often in contact: base and boom ("));
  EXPECT_THAT(report, testing::Not(HasSubstr("--protrusion"))) << "of spheres that were given";
  // With the boom held elsewhere nothing is in its way.
  Srdf(
      "<robot name='crane'><group name='reel'><joint name='reel'/></group>"
      "<disable_collisions link1='mast' link2='hook'/><disable_collisions link1='base' "
      "link2='boom'/>"
      "<disable_collisions link1='base' link2='hook'/></robot>");
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(HasSubstr("reel: 1000 of 1000 random"),
                            testing::Not(HasSubstr("most often in contact"))));
}

// A ball of the base's holds the hand in most directions.
constexpr char kBallUrdf[] = R"(<robot name='crane'><link name='mast'/><link name='base'>
  <collision><origin xyz='1 0 0'/><geometry><sphere radius='1.2'/></geometry></collision></link>
  <link name='hand'><collision><origin xyz='0.5 0 0'/><geometry>{}</geometry></collision></link>
  <joint name='a' type='continuous'><parent link='base'/><child link='mast'/></joint>
  <joint name='b' type='continuous'><parent link='mast'/><child link='hand'/><axis xyz='0 0 1'/>
  </joint></robot>)";

TEST_F(MakeRobotTest, CloserSpheresAreProposedWhereSpheresWereFitted) {
  const auto contact = HasSubstr("most often in contact: base and hand (");
  const auto proposal = HasSubstr("--protrusion makes closer");
  folder_.Write("in/crane.urdf", fmt::format(kBallUrdf, "<box size='0.1 0.1 0.1'/>"));
  EXPECT_THAT(Make(), AllOf(contact, proposal));
  folder_.Write("in/crane.urdf", fmt::format(kBallUrdf, "<sphere radius='0.1'/>"));
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(contact, testing::Not(proposal)));
}

TEST_F(MakeRobotTest, MeshesAreEnclosedAndCopied) {
  const std::string mesh = std::string(kCraneUrdf)
                               .replace(std::string(kCraneUrdf).find("<sphere radius=\"0.06\"/>"),
                                        23, "<mesh filename=\"package://crane/hook.obj\"/>");
  folder_.Write("in/crane.urdf", mesh);
  ExpectRefused({"crane.urdf:7", "link 'hook'", "package://crane/hook.obj"});
  flags_.without_spheres = true;
  ExpectRefused({"crane.urdf:7", "link 'hook'", "package://crane/hook.obj"});

  folder_.Write("in/spheres.yaml", "links: {hook: [{center: [0, 0, 0], radius: 0.1}]}");
  flags_.without_spheres = false;
  flags_.replace = true;
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  EXPECT_THAT(Make(), AllOf(HasSubstr("1 mesh file missing"), HasSubstr("hook.obj")));

  folder_.Write("in/crane/hook.obj", MeshAsObj(TorusMesh(0.1, 0.03, 20, 10)));
  flags_.spheres.clear();
  EXPECT_THAT(Make(), AllOf(HasSubstr("1 mesh file copied"),
                            HasSubstr("meshes, boxes and cylinders of 4 links")));
  EXPECT_TRUE(std::filesystem::exists(flags_.out / "crane/hook.obj"));
  const Robot robot = LoadRobot(flags_.out);
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const Eigen::Vector3d p(0.125 * std::cos(angle), 0.125 * std::sin(angle), 0);
    EXPECT_TRUE(std::any_of(robot.spheres.begin(), robot.spheres.end(), [&](const LinkSphere& s) {
      return s.link == robot.model.FindLink("hook") && (p - s.p_LS).norm() <= s.radius;
    }));
  }
}

// The crane with a mesh of that name for its hook and another for its base.
std::string MeshCrane(const std::string& hook, const std::string& base) {
  std::string urdf = kCraneUrdf;
  const auto replace = [&](const std::string& shape, const std::string& mesh) {
    urdf.replace(urdf.find(shape), shape.size(), "<mesh filename=\"" + mesh + "\"/>");
  };
  replace("<sphere radius=\"0.06\"/>", hook);
  replace("<box size=\"0.4 0.4 0.2\"/>", base);
  return urdf;
}

TEST_F(MakeRobotTest, AWrittenFolderCanBeMovedWhateverTheUrdfCallsItsMeshes) {
  namespace fs = std::filesystem;
  flags_.without_spheres = true;
  const fs::path outer = folder_.path() / "pkg";
  const std::string hook = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  const std::string base = MeshAsObj(TorusMesh(0.2, 0.05, 20, 10));
  const std::vector<std::pair<std::string, std::string>> names = {
      {"../meshes/a.obj", "../meshes/base/a.obj"},
      {"package://pkg/meshes/a.obj", (outer / "meshes/base/a.obj").string()},
      {"file://" + (outer / "meshes/a.obj").string(), "package://pkg/meshes/base/a.obj"},
      {"package://pkg/meshes/sp%20ace&amp;.obj", "../meshes/base/a.obj"},
      {"meshes/a.obj", "../meshes/base/a.obj"}};
  for (const auto& [of_hook, of_base] : names) {
    SCOPED_TRACE(of_hook);
    folder_.Write("pkg/meshes/a.obj", hook);
    folder_.Write("pkg/meshes/sp ace&.obj", hook);
    folder_.Write("pkg/urdf/meshes/a.obj", hook);
    folder_.Write("pkg/meshes/base/a.obj", base);
    flags_.urdf = folder_.Write("pkg/urdf/crane.urdf", MeshCrane(of_hook, of_base));
    Make();
    fs::rename(flags_.out, folder_.path() / "moved");
    fs::remove_all(outer);
    const Robot robot = LoadRobot(folder_.path() / "moved");
    const auto text_of = [&](const char* link) {
      const auto& shape = robot.model.links()[robot.model.FindLink(link)].collision[0].shape;
      return ReadText(robot.resources.Resolve(std::get<Mesh>(shape).resource));
    };
    EXPECT_EQ(text_of("hook"), hook);
    EXPECT_EQ(text_of("base"), base);
    fs::remove_all(folder_.path() / "moved");
  }
}

TEST_F(MakeRobotTest, FilesOfTheUrdfsOwnFolderAreKept) {
  flags_.without_spheres = true;
  const std::string hook = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  folder_.Write("else/a.obj", hook);
  folder_.Write("in/meshes/a.obj", "another");
  folder_.Write("in/base.obj", hook);
  const std::string urdf = MeshCrane("../else/a.obj", "base.obj");
  flags_.urdf = folder_.Write("in/crane.urdf", urdf);
  flags_.out = folder_.path() / "in";
  ExpectInputError([&] { MakeSilently(); }, {"in/crane.urdf", "written over", "--out"});
  EXPECT_EQ(ReadText(flags_.urdf), urdf);
  flags_.name = "crane2";
  EXPECT_THAT(Make(), AllOf(HasSubstr("2 mesh files copied"),
                            HasSubstr("../else/a.obj is meshes/a_2.obj in the URDF")));
  EXPECT_EQ(ReadText(flags_.urdf), urdf);
  EXPECT_EQ(ReadText(flags_.out / "meshes/a.obj"), "another");
  EXPECT_EQ(ReadText(flags_.out / "meshes/a_2.obj"), hook);
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

TEST_F(MakeRobotTest, ShapesInMillimetresAreNamed) {
  std::string urdf = kCraneUrdf;
  urdf.replace(urdf.find("0.06"), 4, "60");
  folder_.Write("in/crane.urdf", urdf);
  EXPECT_THAT(Make(), HasSubstr("link 'hook': a shape is 120 m large"));
}

TEST_F(MakeRobotTest, SizesAreToldWithoutSpheresToo) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  folder_.Write("in/base.obj", MeshAsObj(TorusMesh(0.1, 0.03, 20, 10)));
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  flags_.without_spheres = true;
  EXPECT_THAT(Make(), HasSubstr("link 'hook', hook.obj: is 260 m large"));
}

TEST_F(MakeRobotTest, SizesAreToldWhereverTheSpheresComeFrom) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "nowhere.obj"));
  folder_.Write("in/spheres.yaml", "links: {hook: [{center: [0, 0, 0], radius: 0.1}]}");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
  EXPECT_THAT(Make(), AllOf(HasSubstr("link 'hook', hook.obj: is 260 m large"),
                            HasSubstr("1 mesh file missing")));

  folder_.Write("in/base.obj", "no mesh");
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  Srdf(
      "<robot name='crane'><group name='jib'><joint name='slew'/></group>"
      "<link_sphere_approximation link='hook'><sphere center='0 0 0' radius='0.1'/>"
      "</link_sphere_approximation></robot>");
  flags_.spheres.clear();
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(HasSubstr("the SRDF's approximations"),
                            HasSubstr("link 'hook', hook.obj: is 260 m large"),
                            testing::ContainsRegex("crane.urdf:[0-9]+: .*base.obj")));
}

TEST_F(MakeRobotTest, SpheresThatReachFurtherThanAskedAreNamed) {
  folder_.Write("in/crane.urdf",
                "<robot name='crane'><link name='base'><collision><geometry>"
                "<box size='0.2 0.2 0.2'/></geometry></collision></link><link name='mast'/>"
                "<joint name='slew' type='continuous'><parent link='base'/><child link='mast'/>"
                "</joint></robot>");
  EXPECT_THAT(Make(), testing::Not(HasSubstr("further than --protrusion")));
  flags_.protrusion_m = 1e-3;
  flags_.replace = true;
  EXPECT_THAT(Make(), HasSubstr("further than --protrusion 0.001: no link gets more than 100"));
}

TEST_F(MakeRobotTest, SizesAreToldBeforeAnythingIsFitted) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  std::string open_mesh = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  open_mesh.resize(open_mesh.rfind("f "));
  folder_.Write("in/base.obj", open_mesh);
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  std::vector<std::string> told;
  const auto say = [&](const std::string& line) {
    if (line.starts_with("link '")) told.push_back(line);
    if (line.find("holes are filled") != std::string::npos) throw InputError("enough");
  };
  ExpectInputError([&] { MakeRobot(flags_, say); }, {"enough"});
  EXPECT_THAT(told, testing::ElementsAre(HasSubstr("link 'hook', hook.obj: is 260 m large"),
                                         HasSubstr("link 'base', base.obj: small holes")));
}

TEST_F(MakeRobotTest, RefusesInOneLine) {
  folder_.Write("in/spheres.yaml", "links:\n  toe: [{center: [0, 0, 0], radius: 0.1}]\n");
  flags_.spheres = folder_.path() / "in/spheres.yaml";
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

// A foot and two links of 0.4 m, with balls of 1 cm at elbow and tip.
std::string SlimArm(const std::string& name, double x) {
  const auto joint = [](const std::string& title, const std::string& parent,
                        const std::string& child, double at, const char* axis) {
    return fmt::format(
        "<link name='{1}'><collision><origin xyz='0.4 0 0'/><geometry><sphere radius='0.01'/>"
        "</geometry></collision></link><joint name='{2}' type='revolute'><parent link='{0}'/>"
        "<child link='{1}'/><origin xyz='{3} 0 0'/><axis xyz='{4}'/>"
        "<limit lower='-2.5' upper='2.5' velocity='1' effort='1'/></joint>\n",
        parent, child, title, at, axis);
  };
  const std::string foot = fmt::format(
      "<link name='{0}0'/><joint name='{0}_turn' type='continuous'><parent link='floor'/>"
      "<child link='{0}0'/><origin xyz='{1} 0 0'/><axis xyz='0 0 1'/></joint>\n",
      name, x);
  return foot + joint(name + "_lift", name + "0", name + "1", 0, "0 1 0") +
         joint(name + "_bend", name + "1", name + "2", 0.4, "0 1 0");
}

TEST_F(MakeRobotTest, PairsThatMetInNoSampleAreCheckedIfDescentsBringThemTogether) {
  folder_.Write("in/crane.urdf", "<robot name='crane'><link name='floor'/>" + SlimArm("left", 0) +
                                     SlimArm("right", 1) + SlimArm("far", 9) + "</robot>");
  EXPECT_THAT(Make(), AllOf(HasSubstr("met in none of 500 random configurations of all joints, nor "
                                      "were brought within 5 mm of each other by descents"),
                            HasSubstr("were brought within 5 mm by descents, and are checked: ")));
  const Robot robot = LoadRobot(flags_.out);
  const auto checks = [&](const char* a, const char* b) {
    return robot.ChecksLinks(robot.model.FindLink(a), robot.model.FindLink(b));
  };
  EXPECT_TRUE(checks("left2", "right2"));
  EXPECT_TRUE(checks("left1", "right2"));
  EXPECT_FALSE(checks("left1", "right1")) << "elbows do not reach each other";
  EXPECT_FALSE(checks("left2", "far2"));
}

TEST_F(MakeRobotTest, LinksAcrossAPlanarOrFloatingJointStayChecked) {
  const std::string urdf =
      "<robot name='crane'><link name='floor'/>" + SlimArm("arm", 0) +
      "<link name='cart'><collision><geometry><sphere radius='0.2'/></geometry></collision></link>"
      "<joint name='drive' type='planar'><parent link='floor'/><child link='cart'/>"
      "<origin xyz='3 0 0'/></joint>"
      "<link name='tray'><collision><geometry><sphere radius='0.2'/></geometry></collision></link>"
      "<joint name='lie' type='floating'><parent link='cart'/><child link='tray'/></joint></robot>";
  folder_.Write("in/crane.urdf", urdf);
  const auto checks = [&](const char* a, const char* b) {
    const Robot robot = LoadRobot(flags_.out);
    return robot.ChecksLinks(robot.model.FindLink(a), robot.model.FindLink(b));
  };
  EXPECT_THAT(Make(),
              AllOf(HasSubstr("of all joints but planar and floating ones"),
                    HasSubstr("5 pairs checked, whatever was sampled"), HasSubstr("(drive, lie)")));
  EXPECT_TRUE(checks("arm2", "cart"));
  EXPECT_TRUE(checks("arm1", "tray"));
  EXPECT_TRUE(checks("cart", "tray"));
  // In contact by default, and so in every sample.
  Srdf(
      "<robot name='crane'><group name='jib'><chain base_link='floor' tip_link='arm2'/></group>"
      "<disable_collisions link1='arm1' link2='arm2'/></robot>");
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(testing::Not(HasSubstr("not checked either")),
                            HasSubstr("the group does not move these, which touch as other joints "
                                      "stand by default: cart and tray")));
  EXPECT_TRUE(checks("cart", "tray"));
}

}  // namespace
}  // namespace planbench
