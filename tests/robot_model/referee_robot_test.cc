#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "robot_model/robot_folder.h"
#include "tests/robot_model/small_robot.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

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

TEST(LoadRefereeRobot, JudgesTheFetchByTheManufacturersDescription) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description");
  const Robot fetch = LoadRobot(FetchFolder());
  const Robot referee = LoadRefereeRobot(SharedData("fetch_description"), fetch);
  EXPECT_EQ(referee.Group("").name, "arm_with_torso");
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
