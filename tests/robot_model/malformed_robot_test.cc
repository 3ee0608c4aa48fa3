#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

constexpr char kTinyUrdf[] = R"(<robot name="tiny">
  <link name="base"/><link name="arm"/><link name="hand"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="weld" type="fixed"><parent link="arm"/><child link="hand"/></joint>
</robot>)";

constexpr char kSpheres[] = R"(links:
  arm:
    - {center: [0, 0, 0], radius: 0.1}
)";

constexpr char kTinyRobot[] = R"(name: tiny
urdf: tiny.urdf
spheres: spheres.yaml
edge_resolution_m: 0.05
groups:
  - name: all
    joints: [turn]
    tip_link: hand
allowed_pairs: [[base, hand]]
planners: {ara: ara.yaml}
voxels: {resolution_m: 0.1, lower: [-1, -1, 0], upper: [1, 1, 2], walls: true}
)";

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// A change of robot.yaml (or spheres.yaml) and what the message must name: line and field.
struct MalformedFolder {
  std::string name;
  std::string what;
  std::string by;
  std::vector<std::string> message;
};

void PrintTo(const MalformedFolder& malformed, std::ostream* out) { *out << malformed.name; }

class MalformedFolderTest : public testing::TestWithParam<MalformedFolder> {
 protected:
  void ExpectRefused(const std::string& robot_yaml, const std::string& spheres_yaml,
                     std::vector<std::string> parts) {
    folder_.Write("tiny.urdf", kTinyUrdf);
    folder_.Write("robot.yaml", robot_yaml);
    folder_.Write("spheres.yaml", spheres_yaml);
    parts.push_back(folder_.path().string());
    ExpectInputError([this] { LoadRobot(folder_.path()); }, parts);
  }

  TemporaryFolder folder_;
};

class MalformedRobotYamlTest : public MalformedFolderTest {};
class MalformedSpheresYamlTest : public MalformedFolderTest {};

TEST_P(MalformedRobotYamlTest, IsRefusedWithFileLineAndField) {
  std::vector<std::string> parts = GetParam().message;
  parts.push_back("robot.yaml");
  ExpectRefused(Replaced(kTinyRobot, GetParam().what, GetParam().by), kSpheres, parts);
}

TEST_P(MalformedSpheresYamlTest, IsRefusedWithFileLineAndField) {
  std::vector<std::string> parts = GetParam().message;
  parts.push_back("spheres.yaml");
  ExpectRefused(kTinyRobot, Replaced(kSpheres, GetParam().what, GetParam().by), parts);
}

const MalformedFolder kMalformedRobots[] = {
    {"NoYaml", "[turn]", "[turn", {"robot.yaml:"}},
    {"NoMap", kTinyRobot, "- robot", {"expected a map"}},
    {"UnknownKey", "edge_resolution_m", "edge_resolution", {":4:", "edge_resolution", "unknown"}},
    {"RepeatedKey", "edge_resolution_m: 0.05", "name: tiny", {"'name' occurs twice"}},
    {"NoName", "name: tiny\n", "", {"'name' is missing"}},
    {"EmptyName", "name: tiny", "name: ''", {":1:", "name", "empty"}},
    {"NoUrdf", "urdf: tiny.urdf\n", "", {"'urdf' is missing"}},
    {"UrdfNotThere", "tiny.urdf", "huge.urdf", {":2:", "urdf", "huge.urdf: cannot be opened"}},
    {"SpheresNotThere",
     "spheres.yaml",
     "balls.yaml",
     {":3:", "spheres", "balls.yaml: cannot be opened"}},
    {"ResolutionNoNumber", "0.05", "fine", {":4:", "edge_resolution_m", "'fine'"}},
    {"ResolutionZero", "0.05", "0", {":4:", "edge_resolution_m", "from 1e-06 to 1"}},
    {"ResolutionTooCoarse", "0.05", "1e300", {":4:", "edge_resolution_m", "1e+300"}},
    {"ResolutionTooFine", "0.05", "1e-320", {":4:", "edge_resolution_m", "1e-320"}},
    {"NoGroups",
     "groups:\n  - name: all\n    joints: [turn]\n    tip_link: hand\n",
     "",
     {"'groups' is missing"}},
    {"GroupsEmpty",
     "groups:\n  - name: all\n    joints: [turn]\n    tip_link: hand\n",
     "groups: []\n",
     {":5:", "groups", "at least one"}},
    {"GroupsNoList",
     "  - name: all\n    joints",
     "    name: all\n    joints",
     {":6:", "groups", "expected a sequence"}},
    {"GroupUnknownKey", "tip_link: hand", "tip: hand", {":8:", "groups[0]", "unknown key 'tip'"}},
    {"GroupWithoutName", "name: all\n    joints", "joints", {"groups[0]", "'name' is missing"}},
    {"UnknownJoint", "[turn]", "[spin]", {":6:", "groups[0]", "joint 'spin' is unknown"}},
    {"FixedJoint", "[turn]", "[weld]", {":6:", "groups[0]", "joint 'weld' is fixed"}},
    {"UnknownTip", "tip_link: hand", "tip_link: claw", {":6:", "groups[0]", "'claw' is unknown"}},
    {"TipTwice",
     "tip_link: hand",
     "tip_link: [hand, hand]",
     {":6:", "groups[0]", "group 'all'", "tip 'hand' is repeated"}},
    {"TipElsewhere",
     "tip_link: hand",
     "tip_link: [hand, base]",
     {":8:", "groups[0].tip_link", "none of the joints of group 'all' moves the link 'base'"}},
    {"RepeatedGroup",
     "allowed_pairs:",
     "  - {name: all, joints: [turn], tip_link: arm}\nallowed_pairs:",
     {":9:", "groups[1].name", "twice"}},
    {"PairNoPair", "[[base, hand]]", "[[base]]", {":9:", "allowed_pairs[0]", "pair"}},
    {"PairUnknownLink", "[[base, hand]]", "[[base, claw]]", {":9:", "allowed_pairs[0]", "'claw'"}},
    {"CheckedPairOfRigidLinks",
     "allowed_pairs: [[base, hand]]",
     "checked_pairs: [[arm, hand]]",
     {":9:", "checked_pairs[0]", "rigid to each other"}},
    {"CheckedPairThatNoJointConnects",
     "allowed_pairs: [[base, hand]]",
     "checked_pairs: [[hand, base]]",
     {":9:", "checked_pairs[0]", "no joint keeps the two"}},
    {"CheckedPairOfUnknownLink",
     "allowed_pairs: [[base, hand]]",
     "checked_pairs: [[base, claw]]",
     {":9:", "checked_pairs[0]", "'claw'"}},
    {"CheckedPairThatIsAllowed",
     "[[base, hand]]",
     "[[base, arm]]\nchecked_pairs: [[arm, base]]",
     {":10:", "checked_pairs[0]", "never checked"}},
    {"PairOfOne", "[[base, hand]]", "[[base, base]]", {":9:", "allowed_pairs[0]", "same"}},
    {"PlannersNoMap", "{ara: ara.yaml}", "[ara.yaml]", {":10:", "planners", "expected a map"}},
    {"PlannerNoText", "{ara: ara.yaml}", "{ara: [a]}", {":10:", "planners.ara", "expected text"}},
    {"VoxelsNoMap",
     "{resolution_m: 0.1, lower: [-1, -1, 0], upper: [1, 1, 2], walls: true}",
     "[0.1]",
     {":11:", "voxels", "expected a map"}},
    {"VoxelsUnknownKey", "walls: true", "wall: true", {":11:", "voxels", "unknown key 'wall'"}},
    {"VoxelsNoWalls", ", walls: true", "", {":11:", "voxels", "'walls' is missing"}},
    {"VoxelsWallsNoBool", "walls: true", "walls: 2", {":11:", "voxels.walls", "'2'"}},
    {"VoxelsNoResolution", "resolution_m: 0.1, ", "", {":11:", "'resolution_m' is missing"}},
    {"VoxelResolutionZero",
     "resolution_m: 0.1,",
     "resolution_m: 0,",
     {":11:", "voxels.resolution_m", "greater than zero"}},
    {"VoxelResolutionNegative",
     "resolution_m: 0.1,",
     "resolution_m: -0.1,",
     {":11:", "voxels.resolution_m", "greater than zero"}},
    {"VoxelsShortCorner", "[-1, -1, 0]", "[-1, -1]", {":11:", "voxels.lower", "3 numbers"}},
    {"VoxelsEmptyBox", "[1, 1, 2]", "[1, -1, 2]", {":11:", "voxels", "along y"}},
    {"VoxelsTurnedBox", "[1, 1, 2]", "[1, 1, -2]", {":11:", "voxels", "along z"}},
    {"TooManyVoxels", "resolution_m: 0.1", "resolution_m: 0.004", {":11:", "voxels", "125000000"}},
    {"TooManyVoxelsInARow",
     "resolution_m: 0.1",
     "resolution_m: 1e-9",
     {":11:", "voxels", "along x", "2048"}},
};

const MalformedFolder kMalformedSpheres[] = {
    {"NoYaml", "[0, 0, 0]", "[0, 0, 0", {"spheres.yaml:"}},
    {"NoLinks", "links:", "robots:", {"unknown key 'robots'"}},
    {"Empty", kSpheres, "", {"links"}},
    {"UnknownLink", "arm:", "leg:", {":3:", "links.leg", "no link 'leg'"}},
    {"RepeatedLink", "links:", "links:\n  arm: []", {"links", "'arm' occurs twice"}},
    {"NoList", "- {center", "{center", {":3:", "links.arm", "expected a sequence"}},
    {"UnknownKey", "radius: 0.1", "radius: 0.1, name: s", {":3:", "links.arm[0]", "'name'"}},
    {"NoRadius", ", radius: 0.1", "", {":3:", "links.arm[0]", "'radius' is missing"}},
    {"NegativeRadius", "0.1", "-0.1", {":3:", "links.arm[0].radius", "greater than zero"}},
    {"RadiusNan", "0.1", ".nan", {":3:", "links.arm[0].radius", "finite"}},
    {"ShortCenter", "[0, 0, 0]", "[0, 0]", {":3:", "links.arm[0].center", "expected 3 numbers"}},
    {"CenterNoNumber", "[0, 0, 0]", "[0, x, 0]", {":3:", "links.arm[0].center[1]", "'x'"}},
};

INSTANTIATE_TEST_SUITE_P(Table, MalformedRobotYamlTest, testing::ValuesIn(kMalformedRobots),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Table, MalformedSpheresYamlTest, testing::ValuesIn(kMalformedSpheres),
                         [](const auto& test) { return test.param.name; });

TEST(MalformedFolder, TheUnchangedFilesAreFine) {
  TemporaryFolder folder;
  folder.Write("tiny.urdf", kTinyUrdf);
  folder.Write("robot.yaml", kTinyRobot);
  folder.Write("spheres.yaml", kSpheres);
  const Robot robot = LoadRobot(folder.path());
  EXPECT_EQ(robot.name, "tiny");
  EXPECT_EQ(robot.edge_resolution_m, 0.05);
  EXPECT_EQ(robot.allowed_pairs, (std::vector<std::pair<int, int>>{{0, 2}}));
  ASSERT_TRUE(robot.voxels.has_value());
  EXPECT_EQ(robot.voxels->resolution_m, 0.1);
  EXPECT_EQ(robot.voxels->lower, Eigen::Vector3d(-1, -1, 0));
  EXPECT_EQ(robot.voxels->upper, Eigen::Vector3d(1, 1, 2));
  EXPECT_TRUE(robot.voxels->walls);
}

TEST(MalformedFolder, NamesStatesThatAreTurnedMoreThanOnce) {
  const TemporaryFolder folder;
  folder.Write("arm.urdf",
               "<robot name='arm'><link name='base'/><link name='tip'/><joint name='turn' "
               "type='continuous'><parent link='base'/><child link='tip'/></joint></robot>");
  folder.Write("robot.yaml",
               "name: arm\nurdf: arm.urdf\ngroups:\n  - name: all\n    joints: [turn]\n"
               "    tip_link: tip\n    states:\n      back: [3.5]\n      up: [90]\n");
  const Robot robot = LoadRobot(folder.path());
  EXPECT_THAT(robot.warnings,
              testing::ElementsAre(testing::EndsWith("robot.yaml:9: groups[0].states.up: joint "
                                                     "'turn' is at 90 rad, 14.3 turns; degrees?")));
  EXPECT_EQ(robot.groups[0].states.at("back"), std::vector<double>{WrapAngle(3.5)});
}

TEST(MalformedFolder, NamesStatesOutsideTheLimitsThatAreLeft) {
  const TemporaryFolder folder;
  folder.Write("arm.urdf",
               "<robot name='arm'><link name='base'/><link name='tip'/>"
               "<joint name='turn' type='revolute'><parent link='base'/><child link='tip'/>"
               "<limit lower='-3' upper='3' velocity='1' effort='1'/><safety_controller "
               "soft_lower_limit='-1' soft_upper_limit='1' k_velocity='1'/></joint></robot>");
  folder.Write("robot.yaml",
               "name: arm\nurdf: arm.urdf\ngroups:\n  - name: all\n    joints: [turn]\n"
               "    tip_link: tip\n    states:\n      ready: [1]\n      bent: [1.5]\n");
  EXPECT_THAT(LoadRobot(folder.path()).warnings,
              testing::ElementsAre(
                  testing::HasSubstr("soft limits (safety_controller) narrow: turn"),
                  testing::EndsWith("robot.yaml:9: groups[0].states.bent: joint 'turn' at 1.5 is "
                                    "outside its limits [-1, 1]")));
  folder.Write("arm.srdf",
               "<robot name='arm'>\n<group name='all'><joint name='turn'/></group>\n<group_state "
               "name='bent' group='all'><joint name='turn' value='-2'/></group_state></robot>");
  folder.Write("robot.yaml", "name: arm\nurdf: arm.urdf\nsrdf: arm.srdf\n");
  EXPECT_THAT(LoadRobot(folder.path()).warnings,
              testing::Contains(testing::EndsWith("arm.srdf:3: state 'bent': joint 'turn' at -2 is "
                                                  "outside its limits [-1, 1]")));
}

TEST(MalformedFolder, FoldersAndFilesThatAreMissingAreNamed) {
  TemporaryFolder folder;
  ExpectInputError([&] { LoadRobot(folder.path() / "nowhere"); }, {"nowhere", "no such folder"});
  ExpectInputError([&] { LoadRobot(folder.path()); }, {"robot.yaml", "no such file", "make_robot"});
}

}  // namespace
}  // namespace planbench
