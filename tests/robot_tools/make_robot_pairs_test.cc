#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "robot_model/robot_folder.h"
#include "tests/robot_tools/make_robot_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;

// Which pairs of links a made robot checks.

TEST_F(MakeRobotTest, LinksThatAJointConnectsAreCheckedUnlessTheSrdfDisablesThem) {
  // The boom meets the mast where it hangs.
  Spheres(
      "links:\n  mast: [{center: [0.1, 0, 0.8], radius: 0.1}]\n"
      "  boom: [{center: [0.3, 0, 0], radius: 0.15}]\n");
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

TEST_F(MakeRobotTest, NoPairThatTheSrdfEnablesIsExempt) {
  const std::string group = "<robot name='crane'><group name='jib'><joint name='luff'/></group>";
  Srdf(group + "<enable_collisions link1='boom' link2='base'/></robot>");
  EXPECT_THAT(Make(), HasSubstr("met in none of"));
  const Robot apart = LoadRobot(flags_.out);
  EXPECT_TRUE(apart.ChecksLinks(apart.model.FindLink("base"), apart.model.FindLink("boom")));
  // A ball of the boom about its joint is always in that of the mast.
  Spheres(
      "links:\n  mast: [{center: [0.1, 0, 1], radius: 0.1}]\n"
      "  boom: [{center: [0, 0, 0], radius: 0.1}]\n");
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
  Spheres(
      "links:\n  base: [{center: [0, 0, 0], radius: 0.3}]\n"
      "  boom: [{center: [0, 0, -1], radius: 1.5}]\n  hook: [{center: [0, 0, 0], radius: 0.01}]\n");
  Srdf(
      "<robot name='crane'><group name='jib'><joint name='slew'/></group>"
      "<disable_collisions link1='hook' link2='boom'/></robot>");
  const std::string report = Make();
  EXPECT_THAT(report, HasSubstr("not checked either: base and boom"));
  EXPECT_THAT(report, HasSubstr("so that they are not checked: mast"));
  EXPECT_EQ(LoadRobot(flags_.out).allowed_pairs.size(), 2u);
  EXPECT_TRUE(LoadRobot(flags_.out).warnings.empty()) << "robot.yaml names the link";
}

TEST_F(MakeRobotTest, WhatTouchesByDefaultWhileNoGroupMovesItIsExempt) {
  // The hook hangs at the boom's foot unless it is let down.
  Spheres(
      "links:\n  mast: [{center: [0, 0, 1], radius: 0.1}]\n"
      "  hook: [{center: [-0.9, 0, 0.2], radius: 0.1}]\n");
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
  Spheres(kTightSpheres);
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
  Spheres(kTightSpheres);
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
