#include "planner_ara/motion_primitives.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "common/read_text.h"
#include "planner_ara/arms.h"
#include "planner_ara/default_primitives.h"
#include "support/expect_input_error.h"
#include "support/planning_problems.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/two_arm_robot.h"

namespace planbench {
namespace {

using Rows = std::vector<std::vector<int>>;

MotionPrimitives Parse(const std::string& text) {
  return ParseMotionPrimitives(text, "arm.mprim", 2);
}

MotionPrimitives Load(const std::filesystem::path& file, const JointSpace& space,
                      const std::vector<double>& cells) {
  return PrimitivesOfFile({file, ReadText(file)}, space, cells);
}

TEST(MotionPrimitives, LastRowsAreTheShortOnes) {
  const MotionPrimitives primitives =
      Parse("Motion_Primitives(degrees): 3 2 1\n  15 0\n\t0 -15\r\n\n8 8\n\n");
  EXPECT_EQ(primitives.long_moves, (Rows{{15, 0}, {0, -15}}));
  EXPECT_EQ(primitives.short_moves, (Rows{{8, 8}}));
}

TEST(MotionPrimitives, AllOrNoneMayBeShort) {
  EXPECT_EQ(Parse("Motion_Primitives(degrees): 1 2 0\n1 0").long_moves, (Rows{{1, 0}}));
  EXPECT_EQ(Parse("Motion_Primitives(degrees): 1 2 1\n1 0").short_moves, (Rows{{1, 0}}));
}

TEST(MotionPrimitives, RefusesWhatDoesNotHoldTogether) {
  struct Case {
    std::string text;
    std::vector<std::string> message;
  };
  const std::string header = "Motion_Primitives(degrees): ";
  const std::vector<Case> cases = {
      {"", {"arm.mprim:1:", "Motion_Primitives(degrees):"}},
      {"\n8 0\n", {"arm.mprim:2:", "Motion_Primitives(degrees):"}},
      {"Motion_Primitives(radians): 1 2 0\n8 0\n", {"arm.mprim:1:", "expected"}},
      {header + "1 2\n8 0\n", {"arm.mprim:1:", "three numbers", "found 2"}},
      {header + "1 2 0 0\n8 0\n", {"arm.mprim:1:", "found 4"}},
      {header + "one 2 0\n8 0\n", {"arm.mprim:1:", "'one'"}},
      {header + "0 2 0\n", {"arm.mprim:1:", "0 rows"}},
      {header + "-1 2 0\n", {"arm.mprim:1:", "-1 rows"}},
      {header + "99999999 2 0\n", {"arm.mprim:1:", "99999999 rows"}},
      {header + "16001 2 0\n", {"arm.mprim:1:", "16001 rows", "16000"}},
      {header + "99999999999 2 0\n", {"arm.mprim:1:", "'99999999999'"}},
      {header + "1 2 2\n8 0\n", {"arm.mprim:1:", "2 short primitives of 1"}},
      {header + "1 2 -1\n8 0\n", {"arm.mprim:1:", "-1 short"}},
      {header + "1 3 0\n8 0 0\n", {"arm.mprim:1:", "3 columns", "2 joints"}},
      {header + "2 2 0\n8 0\n", {"arm.mprim:2:", "2 rows announced, 1 found"}},
      {header + "1 2 0\n8 0\n0 8\n", {"arm.mprim:3:", "after the 1 rows"}},
      {header + "1 2 0\n8\n", {"arm.mprim:2:", "expected 2 numbers, found 1"}},
      {header + "1 2 0\n\n8 0 0\n", {"arm.mprim:3:", "expected 2 numbers, found 3"}},
      {header + "1 2 0\n8 far\n", {"arm.mprim:2:", "'far'"}},
      {header + "1 2 0\n8 1.5\n", {"arm.mprim:2:", "'1.5'"}},
      {header + "2 2 0\n8 0\n0 0\n", {"arm.mprim:3:", "zeros"}},
      {header + "1 2 0\n40000 0\n", {"arm.mprim:2:", "40000"}},
  };
  for (const Case& test : cases) {
    SCOPED_TRACE(test.text);
    ExpectInputError([&] { Parse(test.text); }, test.message);
  }
}

// A continuous, a bounded and a prismatic joint.
JointSpace ThreeJoints() {
  return JointSpace({{"roll", true, false, -std::numbers::pi, std::numbers::pi, 1},
                     {"flex", false, false, -2, 2, 1},
                     {"lift", false, true, 0, 0.4, 1}});
}
const std::vector<double> kCells = {std::numbers::pi / 180, 0.1, 0.005};

TEST(MotionPrimitives, YamlNamesJointsAndUnits) {
  const auto read = [](const std::string& text) {
    return ReadMotionPrimitives(YamlNode::Parse(text, "arm.yaml"), ThreeJoints(), kCells);
  };
  const MotionPrimitives degrees = read(
      "angle_unit: deg\nlength_unit: mm\nlong:\n  - {roll: 20, lift: -40}\nshort:\n  - {roll: "
      "-5}\n");
  EXPECT_EQ(degrees.long_moves, (Rows{{20, 0, -8}}));
  EXPECT_EQ(degrees.short_moves, (Rows{{-5, 0, 0}}));
  const MotionPrimitives radians =
      read("{angle_unit: rad, length_unit: m, long: [{flex: 0.3}, {lift: 0.1}]}");
  EXPECT_EQ(radians.long_moves, (Rows{{0, 3, 0}, {0, 0, 20}}));
  EXPECT_TRUE(radians.short_moves.empty());
}

TEST(MotionPrimitives, YamlErrorsNameFileLineAndKey) {
  const std::string units = "angle_unit: rad\nlength_unit: m\n";
  struct Case {
    std::string text;
    std::vector<std::string> message;
  };
  for (const Case& test : std::vector<Case>{
           {"length_unit: m\nlong: [{flex: 0.1}]", {"arm.yaml:1", "angle_unit"}},
           {"angle_unit: grad\nlength_unit: m", {"arm.yaml:1: angle_unit:", "deg or rad", "grad"}},
           {units, {"arm.yaml:1", "no motion primitive"}},
           {units + "long: []", {"arm.yaml:1", "no motion primitive"}},
           {units + "long: [{knee: 1}]", {"arm.yaml:3: long[0].knee:", "no joint"}},
           {units + "long: [{flex: far}]", {"arm.yaml:3: long[0].flex:", "number"}},
           {units + "long:\n  - {flex: 0.1}\n  - {flex: 0.15}",
            {"arm.yaml:5: long[1].flex:", "1.5 cells", "whole number"}},
           {units + "long: [{flex: 0}]", {"arm.yaml:3: long[0]:", "moves nothing"}},
           {units + "long: [{}]", {"arm.yaml:3: long[0]:", "moves nothing"}},
           {units + "short: [{flex: 1e9}]", {"arm.yaml:3: short[0].flex:", "beyond"}},
           {units + "short: {flex: 1}", {"arm.yaml:3: short:", "sequence"}},
           {units + "speed: 3", {"arm.yaml:3", "speed"}}}) {
    SCOPED_TRACE(test.text);
    ExpectInputError(
        [&] {
          ReadMotionPrimitives(YamlNode::Parse(test.text, "arm.yaml"), ThreeJoints(), kCells);
        },
        test.message);
  }
}

TEST(MotionPrimitives, BothListsOfYamlTogetherHaveNoMoreMovesThanThereIsRoomFor) {
  const auto list = [](std::size_t num) {
    std::string text;
    for (std::size_t i = 0; i < num; ++i) text += "{flex: 0.1}, ";
    return text;
  };
  const auto read = [&](std::size_t num_long, std::size_t num_short) {
    const std::string text = "angle_unit: rad\nlength_unit: m\nlong: [" + list(num_long) +
                             "]\nshort: [" + list(num_short) + "]\n";
    return ReadMotionPrimitives(YamlNode::Parse(text, "arm.yaml"), ThreeJoints(), kCells).size();
  };
  EXPECT_EQ(read(kMostPrimitives - 2, 2), kMostPrimitives);
  ExpectInputError([&] { read(kMostPrimitives - 2, 3); },
                   {"arm.yaml:4: short[2]:", "16000", "together"});
}

TEST(MotionPrimitives, TheNameOfAFileTellsItsForm) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "arm.yaml")
      << "{angle_unit: rad, length_unit: m, long: [{flex: 0.2}]}";
  std::ofstream(folder.path() / "arm.mprim") << "Motion_Primitives(degrees): 1 3 0\n0 2 0\n";
  for (const char* name : {"arm.yaml", "arm.mprim"}) {
    EXPECT_EQ(Load(folder / name, ThreeJoints(), kCells).long_moves, (Rows{{0, 2, 0}}));
  }
}

std::vector<std::vector<char>> AllOnOneArm(std::size_t num_joints) {
  return std::vector(num_joints, std::vector<char>(num_joints, 1));
}

TEST(DefaultPrimitives, FollowFromLimitsAndReaches) {
  const JointSpace space = ThreeJoints();
  const std::vector<char> major =
      MajorJoints(space, std::vector<double>{1.0, 0.4, 1.0}, Arms{1, {0, 0, 0}, {0}});
  EXPECT_EQ(major, (std::vector<char>{1, 0, 1}));
  std::vector<double> cells;
  for (const JointSpace::Joint& joint : space.joints()) cells.push_back(DefaultCell(joint));
  EXPECT_DOUBLE_EQ(cells[0], std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(cells[2], 0.005);
  const MotionPrimitives primitives = DefaultPrimitives(space, cells, major, AllOnOneArm(3));
  // A third of 4 rad is more than the 40 degrees of a joint of short reach.
  EXPECT_EQ(primitives.long_moves, (Rows{{20, 0, 0}, {0, 40, 0}, {0, 0, 20}}));
  EXPECT_EQ(primitives.short_moves, (Rows{{10, 0, 0}, {0, 20, 0}, {0, 0, 10}}));
}

TEST(DefaultPrimitives, RailsMoveFurtherThanOtherSlidesAndTogetherWithOtherJoints) {
  const auto slide = [](double travel) {
    return JointSpace::Joint{.name = "slide", .prismatic = true, .lower = -1, .upper = travel - 1};
  };
  const JointSpace space({slide(1),
                          slide(1.25),
                          slide(4),
                          {"pan", false, false, -3, 3, 1},
                          {"wrist", false, false, -3, 3, 1}});
  const std::vector<double> cells = {0.005, 0.005, 0.005, std::numbers::pi / 180,
                                     std::numbers::pi / 180};
  const MotionPrimitives primitives =
      DefaultPrimitives(space, cells, std::vector<char>{1, 1, 1, 1, 0}, AllOnOneArm(5));
  EXPECT_EQ(primitives.long_moves, (Rows{{20, 0, 0, 0, 0},
                                         {0, 50, 0, 0, 0},
                                         {0, 0, 60, 0, 0},
                                         {0, 0, 0, 20, 0},
                                         {0, 0, 0, 0, 40},
                                         {0, 50, 60, 0, 0},
                                         {0, 50, -60, 0, 0},
                                         {0, 50, 0, 20, 0},
                                         {0, 50, 0, -20, 0},
                                         {0, 0, 60, 20, 0},
                                         {0, 0, 60, -20, 0}}));
  EXPECT_EQ(primitives.short_moves.size(), 5u);
}

TEST(DefaultPrimitives, DivideTheCircleWhereADivisorIsNear) {
  const JointSpace space({{"a", true, false, -std::numbers::pi, std::numbers::pi, 1},
                          {"b", true, false, -std::numbers::pi, std::numbers::pi, 1}});
  const double cell = 2 * std::numbers::pi / 100;  // 20 degrees are 5.6 cells
  const MotionPrimitives primitives = DefaultPrimitives(space, std::vector<double>{cell, cell},
                                                        std::vector<char>{1, 1}, AllOnOneArm(2));
  EXPECT_EQ(primitives.long_moves, (Rows{{5, 0}, {0, 5}, {5, 5}, {5, -5}}));
  EXPECT_EQ(primitives.short_moves, (Rows{{2, 0}, {0, 2}}));
}

TEST(DefaultPrimitives, JointsOfTwoArmsDoNotMoveTogether) {
  const Robot robot = MakeTwoArmRobot();
  const PlanningGroup& group = robot.groups.front();
  const auto on_one_arm = JointsOnOneArm(robot.model, group);
  EXPECT_EQ(on_one_arm, (std::vector<std::vector<char>>{
                            {1, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, 1, 1}}));
  const MotionPrimitives primitives =
      DefaultPrimitives(group.space, std::vector<double>(4, std::numbers::pi / 180),
                        std::vector<char>(4, 1), on_one_arm);
  // 4 single ones, and 2 a pair of an arm.
  EXPECT_EQ(primitives.long_moves.size(), 8u);
  for (const std::vector<int>& move : primitives.long_moves) {
    EXPECT_TRUE((move[0] == 0 && move[1] == 0) || (move[2] == 0 && move[3] == 0));
  }
}

TEST(DefaultPrimitives, ATorsosReachIsNoMeasureForTheArmsItCarries) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const PlanningGroup& group = robot.groups.front();
  const std::vector<double> reaches = JointReaches(robot, group);
  ASSERT_LT(reaches[2], reaches[0] / 2);  // an elbow, the torso
  EXPECT_EQ(
      MajorJoints(group.space, std::vector<double>{3, 1, 0.6, 1, 0.4}, ArmsOf(robot.model, group)),
      (std::vector<char>{1, 1, 1, 1, 0}));
}

TEST(DefaultPrimitives, OfTheFetchMoveItsArmInPairsAndItsWristByMore) {
  const Robot fetch = LoadFetch();
  const PlanningGroup& group = fetch.groups.front();
  std::vector<double> cells;
  for (const JointSpace::Joint& joint : group.space.joints()) cells.push_back(DefaultCell(joint));
  const MotionPrimitives primitives = DefaultPrimitives(
      group.space, cells, MajorJoints(group.space, JointReaches(fetch, group), OneArm(group)),
      JointsOnOneArm(fetch.model, group));
  const std::vector<int> moves = {20, 20, 20, 20, 20, 40, 40, 40};  // torso to wrist roll
  Rows long_moves;
  Rows short_moves;
  const auto single = [](std::size_t j, int size) {
    std::vector<int> row(8, 0);
    row[j] = size;
    return row;
  };
  for (std::size_t j = 0; j < moves.size(); ++j) {
    long_moves.push_back(single(j, moves[j]));
    short_moves.push_back(single(j, moves[j] / 2));
  }
  for (std::size_t a = 1; a <= 4; ++a) {
    for (std::size_t b = a + 1; b <= 4; ++b) {
      for (const int sign : {1, -1}) {
        std::vector<int> row = single(a, 20);
        row[b] = 20 * sign;
        long_moves.push_back(row);
      }
    }
  }
  EXPECT_EQ(primitives.long_moves, long_moves);
  EXPECT_EQ(primitives.short_moves, short_moves);
}

const JointSpace kEight(std::vector<JointSpace::Joint>(8));
const std::vector<double> kEightCells(8, 0.1);

TEST(MotionPrimitives, FetchMovesAreThoseOfTheStudy) {
  const MotionPrimitives primitives =
      Load(PLANBENCH_SOURCE_DIR "/robots/fetch/fetch.mprim", kEight, kEightCells);
  ASSERT_EQ(primitives.long_moves.size(), 5U);
  ASSERT_EQ(primitives.short_moves.size(), 8U);
  for (std::size_t j = 0; j < 8; ++j) {
    std::vector<int> row(8, 0);
    row[j] = 8;
    EXPECT_EQ(primitives.short_moves[j], row);
    row[j] = 15;
    if (j < 5) {
      EXPECT_EQ(primitives.long_moves[j], row);
    }
  }
}

TEST(MotionPrimitives, ReadsThePublishedFile) {
  PLANBENCH_NEED_SHARED_DATA("paper/fetch.mprim");
  const MotionPrimitives published = Load(SharedData("paper/fetch.mprim"), kEight, kEightCells);
  const MotionPrimitives own =
      Load(PLANBENCH_SOURCE_DIR "/robots/fetch/fetch.mprim", kEight, kEightCells);
  EXPECT_EQ(published.long_moves, own.long_moves);
  EXPECT_EQ(published.short_moves, own.short_moves);
}

}  // namespace
}  // namespace planbench
