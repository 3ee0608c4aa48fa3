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
