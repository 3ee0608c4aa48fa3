#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "robot_model/robot_folder.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

constexpr char kWeldedHand[] = R"(<robot name="small">
  <link name="base"/><link name="arm"/><link name="hand"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="weld" type="fixed"><parent link="arm"/><child link="hand"/></joint>
</robot>)";

TEST(LoadRobot, PairsThatAJointConnectsAreCheckedIfSrdfOrFolderSaysSo) {
  const TemporaryFolder folder;
  folder.Write("small.urdf", kWeldedHand);
  const std::string yaml = "name: small\nurdf: small.urdf\nsrdf: small.srdf\n";
  const auto checks = [&](const std::string& pairs_of_srdf, const std::string& pairs) {
    folder.Write("small.srdf",
                 "<robot name='small'><group name='turning'><joint name='turn'/>"
                 "</group>" +
                     pairs_of_srdf + "</robot>");
    folder.Write("robot.yaml", yaml + pairs);
    const Robot robot = LoadRobot(folder.path());
    const auto link = [&](const char* name) { return robot.model.FindLink(name); };
    EXPECT_FALSE(robot.ChecksLinks(link("arm"), link("hand"))) << "rigid to each other";
    EXPECT_EQ(robot.ChecksLinks(link("arm"), link("base")),
              robot.ChecksLinks(link("base"), link("arm")));
    return robot.ChecksLinks(link("base"), link("arm"));
  };
  EXPECT_FALSE(checks("", ""));
  EXPECT_TRUE(checks("", "checked_pairs: [[arm, base]]\n"));
  EXPECT_TRUE(checks("<enable_collisions link1='base' link2='arm'/>", ""));
  EXPECT_TRUE(checks("<disable_collisions link1='base' link2='hand'/>", ""));
  EXPECT_FALSE(checks("<disable_collisions link1='base' link2='arm'/>", ""));
  EXPECT_FALSE(
      checks("<enable_collisions link1='base' link2='arm'/>", "allowed_pairs: [[base, arm]]\n"));
  ExpectInputError(
      [&] {
        checks("<disable_collisions link1='base' link2='arm'/>", "checked_pairs: [[arm, base]]\n");
      },
      {"robot.yaml:4: checked_pairs[0]", "never checked"});
}

TEST(LoadRobot, LinksThatAPlanarOrFloatingJointConnectsAreChecked) {
  const TemporaryFolder folder;
  folder.Write("cart.urdf", R"(<robot name="cart">
    <link name="floor"/><link name="cart"/><link name="tray"/><link name="arm"/>
    <joint name="drive" type="planar"><parent link="floor"/><child link="cart"/></joint>
    <joint name="lie" type="floating"><parent link="cart"/><child link="tray"/></joint>
    <joint name="turn" type="continuous"><parent link="cart"/><child link="arm"/></joint>
  </robot>)");
  const auto load = [&](const std::string& pairs) {
    folder.Write("robot.yaml",
                 "name: cart\nurdf: cart.urdf\ngroups:\n"
                 "  - {name: all, joints: [turn], tip_link: arm}\n" +
                     pairs);
    return LoadRobot(folder.path());
  };
  const auto checks = [&](const std::string& pairs, const char* a, const char* b) {
    const Robot robot = load(pairs);
    return robot.ChecksLinks(robot.model.FindLink(a), robot.model.FindLink(b));
  };
  EXPECT_TRUE(checks("", "floor", "cart"));
  EXPECT_TRUE(checks("", "tray", "cart"));
  EXPECT_FALSE(checks("", "arm", "cart"));
  EXPECT_FALSE(checks("allowed_pairs: [[cart, tray]]\n", "tray", "cart"));
  ExpectInputError([&] { load("checked_pairs: [[cart, tray]]\n"); },
                   {"robot.yaml:5: checked_pairs[0]", "they are checked unless allowed_pairs"});

  const std::string srdf = "<robot name='cart'><disable_collisions link1='tray' link2='";
  folder.Write("cart.srdf", srdf + "cart'/></robot>");
  EXPECT_FALSE(checks("srdf: cart.srdf\n", "tray", "cart"));
  folder.Write("cart.srdf", srdf + "floor'/></robot>");
  EXPECT_TRUE(checks("srdf: cart.srdf\n", "tray", "cart"));
}

TEST(LoadRobot, PairsThatAnSrdfLeavesCheckedAreNamed) {
  std::string urdf = "<robot name='row'><link name='frame'/>";
  std::string from = "frame";
  for (int i = 1; i <= 8; ++i) {
    const std::string link = fmt::format("l{}", i);
    urdf += "<link name='" + link +
            "'><collision><geometry><sphere radius='1'/></geometry></collision></link>"
            "<joint name='j" +
            link + "' type='continuous'><parent link='" + from + "'/><child link='" + link +
            "'/></joint>";
    from = link;
  }
  const TemporaryFolder folder;
  folder.Write("row.urdf", urdf + "</robot>");
  folder.Write("row.srdf",
               "<robot name='row'><group name='all'><joint name='jl1'/></group>"
               "<enable_collisions link1='l1' link2='l2'/>"
               "<disable_collisions link1='l2' link2='l3'/></robot>");
  const auto warnings = [&](const std::string& pairs) {
    folder.Write("robot.yaml", "name: row\nurdf: row.urdf\nsrdf: row.srdf\n" + pairs);
    return LoadRobot(folder.path()).warnings;
  };
  EXPECT_THAT(warnings(""), testing::ElementsAre(testing::AllOf(
                                testing::HasSubstr("robot.yaml:3: srdf"),
                                testing::HasSubstr(": l3 and l4; l4 and l5; l5 and l6; l6 and l7; "
                                                   "l7 and l8; if that is meant"))));
  EXPECT_THAT(warnings("checked_pairs: [[l4, l3], [l4, l5], [l5, l6]]\n"
                       "allowed_pairs: [[l7, l6], [l7, l8]]\n"),
              testing::IsEmpty());
  folder.Write("row.srdf",
               "<robot name='row'><group name='all'><joint name='jl1'/></group>"
               "<disable_collisions link1='l1' link2='l3'/></robot>");
  EXPECT_THAT(warnings(""), testing::ElementsAre(testing::HasSubstr("l5 and l6; 2 more; if")));
}

TEST(LoadRefereeRobot, ChecksThePairsThatThePlanningRobotChecks) {
  const TemporaryFolder folder;
  folder.Write("small/small.urdf", kWeldedHand);
  folder.Write("small/robot.yaml",
               "name: small\nurdf: small.urdf\ngroups:\n"
               "  - {name: all, joints: [turn], tip_link: arm}\n");
  folder.Write("description/other_name.urdf", kWeldedHand);
  Robot planning = LoadRobot(folder.path() / "small");
  const auto referee = [&] { return LoadRefereeRobot(folder.path() / "description", planning); };
  const std::string id = referee().content_id;
  planning.checked_pairs = {{planning.model.FindLink("base"), planning.model.FindLink("arm")}};
  EXPECT_EQ(referee().checked_pairs, planning.checked_pairs);
  EXPECT_NE(referee().content_id, id);
}

}  // namespace
}  // namespace planbench
