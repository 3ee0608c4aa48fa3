#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "robot_model/full_positions.h"
#include "robot_model/referee_misfits.h"
#include "robot_model/robot_folder.h"
#include "tests/robot_model/small_robot.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(LoadRefereeRobot, TakesAFolderWithOneUrdf) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  folder.Write("small_description/other_name.urdf", kSmallUrdf);
  folder.Write("small_description/meshes/arm.stl", "");
  const Robot planning = LoadRobot(folder.path() / "small");
  const Robot referee = LoadRefereeRobot(folder.path() / "small_description", planning);
  ASSERT_EQ(referee.groups.size(), 1u);
  EXPECT_EQ(referee.groups[0].name, "all");
  EXPECT_EQ(referee.groups[0].space.joint(0).name, "turn");
  EXPECT_EQ(referee.allowed_pairs, planning.allowed_pairs);
  EXPECT_EQ(referee.resources.Resolve("package://small_description/meshes/arm.stl"),
            folder.path() / "small_description/meshes/arm.stl");
  EXPECT_EQ(referee.content_id.size(), 32u);
  EXPECT_NE(referee.content_id, planning.content_id);
}

TEST(LoadRefereeRobot, TheUrdfMayLieInAFolderUrdf) {
  const TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  const Robot planning = LoadRobot(folder / "small");
  const fs::path description = folder / "small_description";
  folder.Write("small_description/urdf/arm.urdf", kSmallUrdf);
  folder.Write("small_description/urdf/arm.urdf.xacro", "");
  folder.Write("small_description/meshes/arm.stl", "");
  const Robot referee = LoadRefereeRobot(description, planning);
  EXPECT_EQ(referee.folder, description);
  EXPECT_EQ(referee.resources.Resolve("package://small_description/meshes/arm.stl"),
            description / "meshes/arm.stl");
  EXPECT_TRUE(fs::equivalent(referee.resources.Resolve("../meshes/arm.stl"),
                             description / "meshes/arm.stl"));
  // One beside it comes first.
  std::string other = kSmallUrdf;
  folder.Write("small_description/arm.urdf", other.replace(other.find("small"), 5, "other"));
  EXPECT_EQ(LoadRefereeRobot(description, planning).name, "other");
}

TEST(LoadRefereeRobot, ARobotThatShipsIsFoundByItsName) {
  const Robot panda = LoadRobot("panda");
  EXPECT_EQ(LoadRefereeRobot("panda", panda).content_id, panda.content_id);
  ExpectInputError([&] { LoadRefereeRobot("pando", panda); },
                   {"pando: no such folder", "fetch, panda, ur5e"});
}

TEST(LoadRefereeRobot, TakesARobotFolderToo) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  WriteSmallRobot(folder, "exact");
  folder.Write("exact/robot.yaml",
               "name: exact\nurdf: small.urdf\n"
               "groups: [{name: own, joints: [turn], tip_link: arm}]\n");
  const Robot planning = LoadRobot(folder.path() / "small");
  const Robot referee = LoadRefereeRobot(folder.path() / "exact", planning);
  EXPECT_EQ(referee.name, "exact");
  EXPECT_EQ(referee.Group("").name, "own");
  EXPECT_EQ(referee.Group("all").space.joint(0).name, "turn");  // To judge the planner's paths by.
}

TEST(LoadRefereeRobot, RefusesRobotsThatDoNotFit) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  const Robot planning = LoadRobot(folder.path() / "small");
  const auto load = [&](const char* name) {
    return [&planning, path = folder.path() / name] { LoadRefereeRobot(path, planning); };
  };
  ExpectInputError(load("nowhere"), {"nowhere", "no such folder"});

  folder.Write("none/readme", "");
  ExpectInputError(load("none"), {"none", "exactly one .urdf", "found 0"});
  folder.Write("two/a.urdf", kSmallUrdf);
  folder.Write("two/b.urdf", kSmallUrdf);
  ExpectInputError(load("two"), {"two", "exactly one .urdf", "found 2"});
  folder.Write("below/urdf/a.urdf", kSmallUrdf);
  folder.Write("below/urdf/b.urdf", kSmallUrdf);
  ExpectInputError(load("below"), {"below", "in its folder urdf", "found 2"});

  folder.Write("joint/a.urdf", R"(<robot name="r"><link name="base"/><link name="arm"/>
    <joint name="spin" type="continuous"><parent link="base"/><child link="arm"/></joint>
    </robot>)");
  ExpectInputError(load("joint"), {"joint/a.urdf", "small", "'turn' is unknown"});
  folder.Write("link/a.urdf", R"(<robot name="r"><link name="base"/><link name="limb"/>
    <joint name="turn" type="continuous"><parent link="base"/><child link="limb"/></joint>
    </robot>)");
  ExpectInputError(load("link"), {"link/a.urdf", "small", "'arm' is unknown"});

  folder.Write("group/a.urdf", R"(<robot name="r"><link name="base"/><link name="arm"/>
    <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
    <link name="hand"/>
    <joint name="grip" type="continuous"><parent link="arm"/><child link="hand"/></joint>
    </robot>)");
  folder.Write("group/robot.yaml",
               "name: group\nurdf: a.urdf\n"
               "groups: [{name: all, joints: [grip], tip_link: hand}]\n");
  ExpectInputError(load("group"), {"group/robot.yaml", "group 'all'", "other joints"});
}

TEST(LoadRefereeRobot, MustHaveAPlaceRelativeToThePlanningRobot) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  const Robot planning = LoadRobot(folder.path() / "small");
  const auto load = [&](const std::string& name, const std::string& links) {
    folder.Write(name + "/a.urdf", "<robot name='r'>" + links +
                                       "<link name='arm'/><joint name='turn' type='continuous'>"
                                       "<parent link='trunk'/><child link='arm'/></joint></robot>");
    return LoadRefereeRobot(folder.path() / name, planning);
  };
  const std::string fixed = "' type='fixed'><parent link='";
  EXPECT_NO_THROW(load("below",
                       "<link name='world'/><link name='base'/><link name='trunk'/>"
                       "<joint name='a" +
                           fixed +
                           "world'/><child link='base'/></joint>"
                           "<joint name='b" +
                           fixed + "base'/><child link='trunk'/></joint>"));
  ExpectInputError([&] { load("none", "<link name='trunk'/>"); },
                   {"none: cannot be placed where the robot 'small' is", "'trunk'", "'base'"});
  ExpectInputError(
      [&] {
        load("moves", "<link name='trunk'/><link name='base'/><joint name='b" + fixed +
                          "arm'/><child link='base'/></joint>");
      },
      {"moves: cannot be placed"});
}

// An arm and two fingers, the second of which follows the first; no group moves them.
constexpr char kHandUrdf[] = R"(<robot name="hand">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="left"/><link name="right"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="0.1" upper="0.5" velocity="1" effort="1"/></joint>
  <joint name="turn" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.3 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="lower"/><child link="left"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
  <joint name="other_grip" type="prismatic"><parent link="lower"/><child link="right"/>
    <axis xyz="0 -1 0"/><limit lower="0" upper="0.08" velocity="1" effort="1"/>
    <mimic joint="grip"/></joint>
</robot>)";

class OtherReferee : public testing::Test {
 protected:
  using Change = std::pair<std::string, std::string>;  // a part of the URDF, and what it is instead

  static std::string Urdf(const std::vector<Change>& changes) {
    std::string urdf = kHandUrdf;
    for (const auto& [from, to] : changes) urdf.replace(urdf.find(from), from.size(), to);
    return urdf;
  }
  // A planning robot of such a URDF, and a referee of another.
  std::pair<Robot, Robot> Load(const std::vector<Change>& of_planning,
                               const std::vector<Change>& changes) {
    folder_.Write("hand/hand.urdf", Urdf(of_planning));
    folder_.Write("hand/robot.yaml",
                  "name: hand\nurdf: hand.urdf\n"
                  "groups: [{name: arm, joints: [lift, turn], tip_link: lower}]\n");
    folder_.Write("judge/judge.urdf", Urdf(changes));
    Robot hand = LoadRobot(folder_ / "hand");
    Robot referee = LoadRefereeRobot(folder_ / "judge", hand);
    return {std::move(hand), std::move(referee)};
  }
  // What is said of the referee.
  std::string Warnings(const std::vector<Change>& changes,
                       const std::vector<Change>& of_planning = {}) {
    return fmt::format("{}", fmt::join(Load(of_planning, changes).second.warnings, "\n"));
  }
  // The fingers, fixed.
  static std::vector<Change> FixedAt(const std::string& origin) {
    const std::string fixed = "type='fixed'><origin xyz='";
    return {{"\"grip\" type=\"prismatic\">", "'grip' " + fixed + origin + "'/>"},
            {"\"other_grip\" type=\"prismatic\">", "'other_grip' " + fixed + "0 -0.02 0'/>"}};
  }

  TemporaryFolder folder_;
};

TEST_F(OtherReferee, IsToldByTheFirstLinkThatIsElsewhere) {
  EXPECT_EQ(Warnings({}), "");
  EXPECT_THAT(Warnings({{"0.3 0 0", "0.4 0 0"}}),
              AllOf(HasSubstr("judge: as the referee's robot: it is another robot: link 'lower', "
                              "beyond joint 'turn', is up to 100.0 mm from where the robot 'hand'"),
                    Not(HasSubstr("rad"))));
  EXPECT_THAT(Warnings({{"0 1 0", "0 -1 0"}}), AllOf(HasSubstr("link 'lower', beyond joint 'turn'"),
                                                     HasSubstr(" rad from"), Not(HasSubstr(" mm"))))
      << "by default it is where it should be";
  EXPECT_EQ(Warnings({{"0.3 0 0", "0.30005 0 0"}}), "") << "rounded otherwise";
  // A frame may be laid otherwise into the same link, but for those that problems speak of.
  EXPECT_EQ(Warnings({{"0 -1 0", "0 1 0"},
                      {"\"other_grip\" type=\"prismatic\">",
                       "'other_grip' type='prismatic'><origin rpy='0 0 3.14159265'/>"}}),
            "");
  EXPECT_THAT(Warnings({{"\"0.3 0 0\"", "'0.3 0 0' rpy='0 0.5 0'"}}),
              HasSubstr("link 'lower', beyond joint 'turn', is up to 0.5 rad"));
  // What is told of is where a root in common has it.
  const std::string stand =
      "<link name='world'/><joint name='stand' type='fixed'><parent link='world'/>"
      "<child link='base'/><origin xyz='1 2 3' rpy='0 0 1'/></joint></robot>";
  EXPECT_EQ(Warnings({{"</robot>", stand}}), "");
  EXPECT_EQ(Warnings({}, {{"</robot>", stand}}), "");
  EXPECT_THAT(Warnings({{"</robot>", stand}, {"0.3 0 0", "0.4 0 0"}}), HasSubstr("'lower'"));
}

TEST_F(OtherReferee, KnowsItsMisfitsOfWhichItWarns) {
  EXPECT_EQ(Load({}, {}).second.referee_misfits, "");
  const auto [hand, referee] = Load({}, {{"0.3 0 0", "0.4 0 0"}});
  EXPECT_EQ(referee.referee_misfits, RefereeMisfits(hand, referee));
  EXPECT_THAT(referee.warnings, testing::ElementsAre(testing::EndsWith("as the referee's robot: " +
                                                                       referee.referee_misfits)));
  EXPECT_EQ(hand.referee_misfits, "");
}

TEST_F(OtherReferee, JointsThatFollowOthersCountWhereBothHaveThem) {
  EXPECT_THAT(Warnings({{"<mimic joint=\"grip\"/>", "<mimic joint='grip' multiplier='2'/>"}}),
              HasSubstr("link 'right', beyond joint 'other_grip'"));
  const Change free = {"<mimic joint=\"grip\"/>", ""};
  EXPECT_EQ(Warnings({free}), "");
  EXPECT_EQ(Warnings({}, {free}), "");
}

TEST_F(OtherReferee, AJointThatItHasFixedIsWhereItHasIt) {
  EXPECT_EQ(Warnings(FixedAt("0 0.02 0")), "");
  EXPECT_EQ(Warnings({}, FixedAt("0 0.02 0")), "");
  EXPECT_THAT(Warnings(FixedAt("0 0.02 0.005")),
              HasSubstr("link 'left', beyond joint 'grip', is up to 5.0 mm"));
}

TEST_F(OtherReferee, StandsAsThePlanningRobotDoesWhereItsJointsCan) {
  const auto misfits = [this](const std::vector<Change>& changes, double grip = 0.03) {
    const auto robots = Load({}, changes);
    const RobotModel& model = robots.first.model;
    return PostureMisfits(model, FullPositionsWherePossible(model, {"lift", "grip"}, {0.3, grip}),
                          robots.second.model);
  };
  EXPECT_EQ(misfits({}), "");
  EXPECT_EQ(misfits({{"<mimic joint=\"grip\"/>", ""}}), "");
  EXPECT_EQ(misfits({{"<mimic joint=\"grip\"/>", "<mimic joint='grip' multiplier='2'/>"}}),
            "joint 'other_grip' follows 'grip' there, at 0.0600, not at 0.0300");
  EXPECT_EQ(misfits(FixedAt("0 0.02 0")),
            "joint 'grip' is fixed there, at 0.0200, not at 0.0300, "
            "joint 'other_grip' is fixed there, at 0.0200, not at 0.0300");
  EXPECT_EQ(misfits(FixedAt("0 0.02 0"), 0.0205), "") << "rounded otherwise";

  const auto [hand, referee] = Load(FixedAt("0 0.02 0"), {});
  const std::vector<double> positions =
      RefereePositions(hand.model, hand.model.DefaultPositions(), referee.model);
  EXPECT_THAT(referee.model.position_names(), testing::ElementsAre("lift", "turn", "grip"));
  EXPECT_THAT(positions, testing::ElementsAre(0.1, 0, testing::DoubleNear(0.02, 1e-12)))
      << "where that one has it fixed";
}

TEST_F(OtherReferee, ABaseThatItHasFixedIsWhereTheDefaultIs) {
  const std::string cart =
      "<link name='cart'/><joint name='drive' type='floating'><parent link='base'/>"
      "<child link='cart'/></joint></robot>";
  std::string fixed = cart;
  fixed.replace(fixed.find("floating"), 8, "fixed");
  const auto robots = Load({{"</robot>", cart}}, {{"</robot>", fixed}});
  const RobotModel& model = robots.first.model;
  std::vector<double> positions = model.DefaultPositions();
  EXPECT_EQ(PostureMisfits(model, positions, robots.second.model), "");
  PutPositions(model, {"drive/trans_x"}, {0.5}, &positions);
  EXPECT_EQ(PostureMisfits(model, positions, robots.second.model),
            "joint 'drive' is fixed there, at another pose");
}

TEST_F(OtherReferee, LimitsOfItsJointsAreToldWherePathsMayBeBeyond) {
  EXPECT_THAT(Warnings({{"lower=\"0.1\"", "lower='0.2'"}}),
              AllOf(HasSubstr("other limits than those of the robot 'hand': lift [0.2, 0.5], not "
                              "[0.1, 0.5]"),
                    Not(HasSubstr("another robot"))));
  EXPECT_EQ(Warnings({{"lower=\"0.1\"", "lower='0'"}}), "") << "wider";
  EXPECT_THAT(Warnings({{"type=\"continuous\">",
                         "type='revolute'><limit lower='-3' upper='3' "
                         "velocity='1' effort='1'/>"}}),
              HasSubstr("turn [-3, 3], not none"));
  EXPECT_EQ(Warnings({{"upper=\"0.04\"", "upper='0.01'"}}), "") << "in no group";
}

TEST(LoadRefereeRobot, JudgesTheFetchByTheManufacturersDescription) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description");
  const Robot fetch = LoadRobot(FetchFolder());
  const Robot referee = LoadRefereeRobot(SharedData("fetch_description"), fetch);
  EXPECT_EQ(referee.Group("").name, "arm_with_torso");
  EXPECT_THAT(referee.warnings, testing::Each(Not(HasSubstr("as the referee's robot"))));
  int meshes = 0;
  for (const Link& link : referee.model.links()) {
    for (const PlacedShape& placed : link.collision) {
      EXPECT_NO_THROW(referee.resources.Resolve(std::get<Mesh>(placed.shape).resource));
      ++meshes;
    }
  }
  EXPECT_EQ(meshes, 21);
}

}  // namespace
}  // namespace planbench
