#include "problem_generator/problem_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <regex>

#include "common/read_text.h"
#include "common/write_file.h"
#include "tests/problem_generator/generator_support.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/two_arm_robot.h"

namespace planbench {
namespace {

TEST(ProblemSpec, ReadsWhatTheFileSays) {
  const Robot fetch = LoadFetch();
  const SpecFolder folder;
  const ProblemSpec spec = folder.Load(kCanOnTable, fetch);
  EXPECT_EQ(spec.name, "spec");
  EXPECT_EQ(spec.group, "arm_with_torso");
  EXPECT_EQ(spec.time_limit_s, 60);
  EXPECT_EQ(spec.rest.names.size(), 15);
  EXPECT_TRUE(spec.allowed_collisions.Allowed("laser_link", "base_link"));
  EXPECT_FALSE(spec.allowed_collisions.Allowed("gripper_link", "base_link"));
  EXPECT_EQ(spec.clearance_m, 0.005);
  EXPECT_EQ(spec.object_gap_m, 0.02);
  EXPECT_EQ(spec.min_joint_distance, 1);
  EXPECT_EQ(spec.effort.scenes, 20);
  ASSERT_EQ(spec.objects.size(), 2);
  const ObjectSpec& can = spec.objects[1];
  EXPECT_EQ(can.parent, 0);
  EXPECT_EQ(can.support_part, 0);
  EXPECT_EQ(can.position[0].low, -0.3);
  EXPECT_EQ(can.position[0].high, -0.3);
  EXPECT_EQ(can.position[1].low, -0.2);
  EXPECT_EQ(can.position[1].high, 0.2);
  EXPECT_EQ(can.parts[0].kind, PartKind::kCylinder);
  ASSERT_EQ(spec.queries.size(), 1);
  ASSERT_TRUE(spec.queries[0].start.configuration);
  EXPECT_EQ(spec.queries[0].start.configuration->front(), 0.1);
  EXPECT_EQ(spec.queries[0].goal.gripper.objects, std::vector<int>{1});
  EXPECT_EQ(spec.queries[0].goal.gripper.position_tolerance_m, 0.01);
}

TEST(ProblemSpec, ThoseThatShipLoad) {
  const Robot fetch = LoadFetch();
  for (const char* name : {"shelf_zero_test", "shelf_height_test", "shelf_height_rot_test", "box",
                           "cage", "table_pick", "table_under_pick", "shelf_thin"}) {
    const ProblemSpec spec =
        LoadProblemSpec(ShippedProblems() / (std::string(name) + ".yaml"), fetch);
    EXPECT_EQ(spec.name, name);
    EXPECT_GE(spec.queries.size(), 2);
  }
}

TEST(ProblemSpec, SharesItsAllowedCollisionsWithTheShippedProblems) {
  // problems/README.md says so.
  const Robot fetch = LoadFetch();
  const ProblemSpec spec = LoadProblemSpec(ShippedProblems() / "box.yaml", fetch);
  const ProblemFiles files = ListProblemSet(ShippedProblems() / "shelf_demo").problems.front();
  EXPECT_EQ(spec.allowed_collisions.Simplified(),
            ReadProblem(files.scene, files.request, fetch).scene.allowed_collisions);
}

TEST(ProblemSpec, LinksThatAJointConnectsMayTouchThoughOthersOfThemAreNamed) {
  Robot fetch = LoadFetch();
  const SpecFolder folder;
  std::string setup = ReadText(folder.path() / "fetch_setup.yaml");
  setup.resize(setup.find("allowed_collisions:"));
  WriteFile(
      folder.path() / "fetch_setup.yaml",
      setup + "allowed_collisions: {base_link: [laser_link], torso_lift_link: [estop_link]}\n");
  const auto load = [&] { return folder.Load(kCanOnTable, fetch).allowed_collisions; };
  // The file of a scene says of every two links that it names whether they may touch.
  EXPECT_EQ(load().Entry("base_link", "torso_lift_link"), std::optional(true));
  EXPECT_EQ(load().entries().size(), 3u);
  fetch.checked_pairs = {
      {fetch.model.FindLink("base_link"), fetch.model.FindLink("torso_lift_link")}};
  EXPECT_EQ(load().Entry("base_link", "torso_lift_link"), std::nullopt);
}

TEST(ProblemSpec, JointsThatTheSetupHasTurnedTooFarAreTold) {
  const Robot fetch = LoadFetch();
  const SpecFolder folder;
  EXPECT_TRUE(folder.Load(kCanOnTable, fetch).warnings.empty());
  const std::string setup = ReadText(folder.path() / "fetch_setup.yaml");
  const auto warnings = [&](const std::string& position) {
    const std::string line = "wrist_roll_joint: " + position;
    WriteFile(folder.path() / "fetch_setup.yaml",
              std::regex_replace(setup, std::regex("wrist_roll_joint: *[-0-9.]+"), line));
    return folder.Load(kCanOnTable, fetch).warnings;
  };
  EXPECT_THAT(warnings("9"), testing::Contains(testing::ContainsRegex(
                                 "fetch_setup.yaml:[0-9]+: .*wrist_roll_joint: is at 9 rad, 1.43 "
                                 "turns; degrees[?]$")));
  EXPECT_THAT(warnings("6"), testing::IsEmpty());
}

struct BadSpec {
  const char* name;
  const char* text;         // In kCanOnTable ...
  const char* replacement;  // ... replaced by this.
  std::vector<std::string> message;
};

class BadSpecTest : public testing::TestWithParam<BadSpec> {};

TEST_P(BadSpecTest, IsRefusedByFileLineAndKey) {
  const Robot fetch = LoadFetch();
  const SpecFolder folder;
  const std::string spec = CanOnTableWith(GetParam().text, GetParam().replacement);
  ExpectInputError([&] { folder.Load(spec, fetch); }, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSpecTest,
    testing::Values(
        BadSpec{
            "NoSuchSetup", "fetch_setup.yaml", "other.yaml", {"spec.yaml:1: setup", "other.yaml"}},
        BadSpec{"UnknownKey",
                "clearance: 0.005",
                "clearance: 0.005\nclearence: 1",
                {"spec.yaml:3: clearence"}},
        BadSpec{"MissingKey", "object_gap: 0.02", "", {"spec.yaml:1", "object_gap"}},
        BadSpec{"NegativeClearance",
                "clearance: 0.005",
                "clearance: -1",
                {"spec.yaml:2: clearance", "negative"}},
        BadSpec{"NoEffort", "scenes: 20", "scenes: 0", {"spec.yaml:5: effort.scenes"}},
        BadSpec{
            "UnknownEffort", "scenes: 20", "scenes: 20, tries: 3", {"spec.yaml:5: effort.tries"}},
        BadSpec{"NegativeSize",
                "[0.12, 0.03]",
                "[0.12, -0.03]",
                {"spec.yaml:15: objects[1].parts[0].cylinder", "greater than zero"}},
        BadSpec{"ZeroSize",
                "[1.0, 1.0, 0.04]",
                "[1.0, [0, 1], 0.04]",
                {"spec.yaml:11: objects[0].parts[0].box"}},
        BadSpec{"TooFewSizes",
                "[0.12, 0.03]",
                "[0.12]",
                {"spec.yaml:15: objects[1].parts[0].cylinder", "height, radius"}},
        BadSpec{"NoPrimitive",
                "cylinder: [0.12, 0.03]",
                "name: a",
                {"spec.yaml:15: objects[1].parts[0]", "box, cylinder or sphere"}},
        BadSpec{"TwoPrimitives",
                "cylinder: [0.12, 0.03]",
                "sphere: 1, cylinder: [0.12, 0.03]",
                {"spec.yaml:15: objects[1].parts[0]"}},
        BadSpec{"NoParts",
                "[{cylinder: [0.12, 0.03]}]",
                "[]",
                {"spec.yaml:15: objects[1].parts", "at least one"}},
        BadSpec{"RangeTheWrongWayRound",
                "[-0.2, 0.2]",
                "[0.2, -0.2]",
                {"spec.yaml:14: objects[1].position", "[low, high]"}},
        BadSpec{"NotANumber", "[-0.2, 0.2]", "wide", {"spec.yaml:14: objects[1].position"}},
        BadSpec{"StandsAtThreeNumbers",
                "[-0.3, [-0.2, 0.2]]",
                "[-0.3, 0, 0.1]",
                {"spec.yaml:14: objects[1].position", "x, y"}},
        BadSpec{"SameId", "id: can", "id: table", {"spec.yaml:12: objects[1].id"}},
        BadSpec{"IdWithADot", "id: can", "id: can.1", {"spec.yaml:12: objects[1].id", "dot"}},
        BadSpec{"NoId", "id: can", "id: ''", {"spec.yaml:12: objects[1].id", "empty"}},
        BadSpec{"IdOfTwoLines",
                "id: can",
                "id: \"can\\n1\"",
                {"spec.yaml:12: objects[1].id", "one line"}},
        BadSpec{"IdWithATab", "id: can", "id: \"can\\t1\"", {"spec.yaml:12: objects[1].id"}},
        BadSpec{"IdOfALink",
                "id: can",
                "id: gripper_link",
                {"spec.yaml:12: objects[1].id", "name of a link, 'gripper_link'"}},
        BadSpec{"TooLarge",
                "[0.12, 0.03]",
                "[[0.12, 2e9], 0.03]",
                {"spec.yaml:15: objects[1].parts[0].cylinder", "more than 1000000000 m"}},
        BadSpec{"TooFar",
                "position: [1.0, 0, [0.6, 0.8]]",
                "position: [1.0, -2e9, [0.6, 0.8]]",
                {"spec.yaml:10: objects[0].position", "beyond 1000000000 m"}},
        BadSpec{"StandsTooFar",
                "[-0.3, [-0.2, 0.2]]",
                "[-0.3, [-0.2, 2e9]]",
                {"spec.yaml:14: objects[1].position", "beyond"}},
        BadSpec{"UnknownSupport",
                "stands_on: table.top",
                "stands_on: shelf.top",
                {"spec.yaml:13: objects[1].stands_on", "shelf"}},
        BadSpec{"UnknownPart",
                "stands_on: table.top",
                "stands_on: table.side",
                {"spec.yaml:13: objects[1].stands_on", "side"}},
        BadSpec{"StandsOnACylinder",
                "box: [1.0, 1.0, 0.04]",
                "cylinder: [0.04, 1.0]",
                {"spec.yaml:13: objects[1].stands_on", "boxes"}},
        BadSpec{"UnknownFrame",
                "stands_on: table.top",
                "relative_to: shelf",
                {"spec.yaml:13: objects[1].relative_to", "shelf"}},
        BadSpec{"BothSupportAndFrame",
                "stands_on: table.top",
                "stands_on: table.top\n    relative_to: table",
                {"spec.yaml:14: objects[1].relative_to"}},
        BadSpec{"StandsTilted",
                "stands_on: table.top",
                "stands_on: table.top\n    rpy: [0, 0, 1]",
                {"spec.yaml:14: objects[1].rpy", "yaw"}},
        BadSpec{"StandsTurnedAboutTheBase",
                "stands_on: table.top",
                "stands_on: table.top\n    about_base: 1",
                {"spec.yaml:14: objects[1].about_base"}},
        BadSpec{"YawWithoutSupport",
                "id: table",
                "id: table\n    yaw: 1",
                {"spec.yaml:10: objects[0].yaw", "rpy"}},
        BadSpec{"ImpossibleProbability",
                "id: table",
                "id: table\n    probability: 1.5",
                {"spec.yaml:10: objects[0].probability"}},
        BadSpec{"UnknownConfiguration",
                "configuration: tuck",
                "configuration: stretched",
                {"spec.yaml:18: queries[0].start.configuration", "stretched"}},
        BadSpec{"UnknownObjectInQuery",
                "object: can",
                "object: cup",
                {"spec.yaml:19: queries[0].goal.gripper.object", "cup"}},
        BadSpec{"NoObjectsInQuery",
                "object: can",
                "object: []",
                {"spec.yaml:19: queries[0].goal.gripper.object"}},
        BadSpec{"NegativeTolerance",
                "position_tolerance: 0.01",
                "position_tolerance: -0.01",
                {"spec.yaml:19: queries[0].goal.gripper.position_tolerance", "from 0"}},
        BadSpec{"ToleranceTooWideToDrawFrom",
                "position_tolerance: 0.01",
                "orientation_tolerance: 1e200",
                {"spec.yaml:19: queries[0].goal.gripper.orientation_tolerance", "from 0"}},
        BadSpec{"RangeTooWideToDrawFrom",
                "position_tolerance: 0.01",
                "around: [-1e308, 1e308]",
                {"spec.yaml:19: queries[0].goal.gripper.around", "too wide"}},
        BadSpec{"NoEnd",
                "{configuration: tuck}",
                "{}",
                {"spec.yaml:18: queries[0].start", "configuration, gripper"}},
        BadSpec{"NoWeight",
                "name: approach",
                "name: approach\n    weight: 0",
                {"spec.yaml:18: queries[0].weight"}},
        BadSpec{
            "WeightsThatAddUpToInfinity",
            "queries:",
            "queries:\n"
            "  - {name: a, weight: 1e308, start: {configuration: tuck}, goal: {gripper: {object: "
            "can, position: [0, 0, 1]}}}\n"
            "  - {name: b, weight: 1e308, start: {configuration: tuck}, goal: {gripper: {object: "
            "can, position: [0, 0, 1]}}}",
            {"spec.yaml:18: queries[1]", "infinity"}},
        BadSpec{"NamelessQuery",
                "name: approach",
                "name: ''",
                {"spec.yaml:17: queries[0].name", "empty"}},
        BadSpec{"QueryOfTwoLines",
                "name: approach",
                "name: \"approach\\nit\"",
                {"spec.yaml:17: queries[0].name", "one line"}},
        BadSpec{"NothingToPlan",
                "{gripper: {object: can, position: [-0.0335, 0, 0.03], "
                "position_tolerance: 0.01}}",
                "{configuration: tuck}",
                {"spec.yaml:17: queries[0]", "both"}}),
    [](const auto& info) { return info.param.name; });

TEST(ProblemSpec, RefusesTheNameOfALinkThatTheSetupAllowsCollisions) {
  const Robot fetch = LoadFetch();
  const auto load = [&](const std::string& partner) {
    const TemporaryFolder folder;
    folder.Write(
        "fetch_setup.yaml",
        "robot: fetch\ngroup: arm_with_torso\nconfigurations:\n  tuck: {torso_lift_joint: 0, "
        "shoulder_pan_joint: 0, shoulder_lift_joint: 0, upperarm_roll_joint: 0, "
        "elbow_flex_joint: 0, forearm_roll_joint: 0, wrist_flex_joint: 0, "
        "wrist_roll_joint: 0}\nallowed_collisions: {base_link: [" +
            partner + "]}\n");
    // This link has no body, and its name would do otherwise.
    const std::string spec =
        "setup: fetch_setup.yaml\nclearance: 0\nobject_gap: 0\nmin_joint_distance: 0\n"
        "effort: {scenes: 1, poses: 1, solutions: 1, ik_starts: 1}\nobjects:\n"
        "  - {id: head_camera_link, position: [1, 0, 1], parts: [{sphere: 0.1}]}\n"
        "queries: [{name: reach, start: {configuration: tuck}, goal: {gripper: {object: "
        "head_camera_link, position: [0, 0, 1]}}}]\n";
    return LoadProblemSpec(folder.Write("spec.yaml", spec), fetch);
  };
  ExpectInputError([&] { load("head_camera_link"); },
                   {"spec.yaml:7: objects[0].id", "'head_camera_link'", "the setup allows"});
  EXPECT_EQ(load("laser_link").objects.size(), 1);
}

TEST(ProblemSpec, RefusesAStateOfTheRobotThatIsOutsideItsLimits) {
  Robot fetch = LoadFetch();
  const SpecFolder folder;
  std::vector<double>& bent = fetch.groups.front().states["bent"];
  bent = *folder.Load(kCanOnTable, fetch).queries[0].start.configuration;
  const std::string spec = CanOnTableWith("configuration: tuck", "configuration: bent");
  EXPECT_EQ(folder.Load(spec, fetch).queries[0].start.configuration, bent);
  bent[0] = 0.5;
  ExpectInputError([&] { folder.Load(spec, fetch); },
                   {"spec.yaml:18: queries[0].start.configuration: the robot's state 'bent' of "
                    "group 'arm_with_torso' cannot be used: joint 'torso_lift_joint' at 0.5 is "
                    "outside its limits [0, 0.38615]"});
  EXPECT_NO_THROW(folder.Load(kCanOnTable, fetch)) << "nobody asks for it";
}

TEST(ProblemSpec, OfSeveralTipsOneIsNamed) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const TemporaryFolder folder;
  const auto load = [&](const std::string& tip) {
    const auto spec = LoadProblemSpec(WriteTwoArmSpec(folder, tip), robot);
    return robot.model.links()[static_cast<std::size_t>(spec.queries[0].goal.gripper.tip_link)]
        .name;
  };
  EXPECT_EQ(load("tip: left_hand, "), "left_hand");
  EXPECT_EQ(load("tip: right_hand, "), "right_hand");
  const std::string tips = "the group 'both' has the tips left_hand, right_hand";
  ExpectInputError([&] { load(""); },
                   {"two_arms.yaml:11: queries[0].goal.gripper: needs the key tip: " + tips});
  ExpectInputError([&] { load("tip: chest, "); },
                   {"two_arms.yaml:11: queries[0].goal.gripper.tip: 'chest' is no tip: " + tips});
}

struct BadSetup {
  const char* name;
  const char* text;
  std::vector<std::string> message;
};

class BadSetupTest : public testing::TestWithParam<BadSetup> {};

TEST_P(BadSetupTest, IsRefusedByFileLineAndKey) {
  const Robot fetch = LoadFetch();
  const TemporaryFolder folder;
  folder.Write("fetch_setup.yaml", GetParam().text);
  const auto spec = folder.Write("spec.yaml", kCanOnTable);
  ExpectInputError([&] { LoadProblemSpec(spec, fetch); }, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSetupTest,
    testing::Values(
        BadSetup{"OtherRobot", "robot: pr2\ngroup: arm\n", {"fetch_setup.yaml:1: robot", "pr2"}},
        BadSetup{"UnknownGroup", "robot: fetch\ngroup: legs\n", {"fetch_setup.yaml:2: group"}},
        BadSetup{"UnknownKey",
                 "robot: fetch\ngroup: arm_with_torso\ntime_limit: 1\n",
                 {"fetch_setup.yaml:3: time_limit"}},
        BadSetup{"UnknownJoint",
                 "robot: fetch\ngroup: arm_with_torso\nrest: {knee: 1}\n",
                 {"fetch_setup.yaml:3: rest.knee"}},
        BadSetup{"FixedJoint",
                 "robot: fetch\ngroup: arm_with_torso\nrest: {gripper_axis: 1}\n",
                 {"fetch_setup.yaml:3: rest.gripper_axis", "fixed"}},
        BadSetup{"OutsideLimits",
                 "robot: fetch\ngroup: arm_with_torso\nrest: {bellows_joint: 0.5}\n",
                 {"fetch_setup.yaml:3: rest.bellows_joint", "limits"}},
        BadSetup{"JointOutsideTheGroup",
                 "robot: fetch\ngroup: arm_with_torso\n"
                 "configurations:\n  tuck: {head_pan_joint: 0}\n",
                 {"fetch_setup.yaml:4: configurations.tuck.head_pan_joint", "group"}},
        BadSetup{"IncompleteConfiguration",
                 "robot: fetch\ngroup: arm_with_torso\n"
                 "configurations:\n  tuck: {wrist_flex_joint: 0}\n",
                 {"fetch_setup.yaml:4: configurations.tuck", "torso_lift_joint"}},
        BadSetup{"WorkspaceTheWrongWayRound",
                 "robot: fetch\ngroup: arm_with_torso\n"
                 "workspace: {min_corner: [0, 0, 1], max_corner: [1, 1, 0]}\n",
                 {"fetch_setup.yaml:3: workspace.max_corner", "greater than min_corner"}},
        BadSetup{"UnknownLink",
                 "robot: fetch\ngroup: arm_with_torso\n"
                 "allowed_collisions:\n  base_link: [laser_link, tail]\n",
                 {"fetch_setup.yaml:4: allowed_collisions.base_link[1]"}},
        BadSetup{"PairGivenTwice",
                 "robot: fetch\ngroup: arm_with_torso\n"
                 "allowed_collisions:\n  base_link: [laser_link]\n  laser_link: [base_link]\n",
                 {"fetch_setup.yaml:5: allowed_collisions.laser_link[0]",
                  "laser_link and base_link is given twice"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace planbench
