#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/numbers.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A gripper on a cart: `drive` holds a pose, `wrist` is planned with, `f2` follows `f1` and `weld`
// is fixed at 0.065.
constexpr const char* kUrdf = R"(<robot name="cart">
  <link name="floor"/><link name="cart"/><link name="hand"/><link name="left"/><link name="right"/>
  <link name="pad"/>
  <joint name="drive" type="planar"><parent link="floor"/><child link="cart"/></joint>
  <joint name="wrist" type="revolute"><parent link="cart"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="f1" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
  <joint name="f2" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" velocity="1" effort="1"/><mimic joint="f1"/></joint>
  <joint name="weld" type="fixed"><parent link="right"/><child link="pad"/>
    <origin xyz="0 0.065 0"/><axis xyz="0 1 0"/></joint>
</robot>)";

Robot CartRobot() {
  Robot robot;
  robot.name = "cart";
  robot.model = RobotModel::FromUrdf(kUrdf, "cart.urdf");
  robot.groups = {robot.model.MakeGroup("wrist", {"wrist"}, "hand"),
                  robot.model.MakeGroup("grip", {"wrist", "f1"}, "hand")};
  return robot;
}

Problem Parse(const std::string& scene_state, const std::string& start_state,
              const std::string& goals = "{joint_name: wrist, position: 1}",
              const std::string& group = "wrist") {
  return ParseProblem(
      YamlNode::Parse("robot_model_name: cart\nrobot_state: {" + scene_state + "}\n", "scene.yaml"),
      YamlNode::Parse("group_name: " + group + "\nstart_state: {" + start_state +
                          "}\ngoal_constraints: [{joint_constraints: [" + goals + "]}]\n",
                      "request.yaml"),
      CartRobot(), {});
}

TEST(StartState, OverlaysTheScenes) {
  const Problem problem =
      Parse("joint_state: {name: [f1, wrist], position: [0.01, 0.2]}",
            "joint_state: {name: [wrist, weld], position: [0.3, 0], velocity: [.nan, .inf]}");
  EXPECT_THAT(problem.start.names, ElementsAre("f1", "wrist", "weld"));
  EXPECT_THAT(problem.start.positions, ElementsAre(0.01, 0.3, 0));
}

TEST(StartState, PutsFollowersWhereTheyAre) {
  Problem problem = Parse("joint_state: {name: [f1, f2, wrist], position: [0.01, 0.01, 0]}",
                          "joint_state: {name: [f1], position: [0.03]}");
  EXPECT_THAT(problem.start.names, ElementsAre("f1", "f2", "wrist"));
  EXPECT_THAT(problem.start.positions, ElementsAre(0.03, 0.03, 0));
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("'f2' is given at 0.01")));

  problem = Parse("", "joint_state: {name: [f2, wrist], position: [0.02, 0]}");
  EXPECT_THAT(problem.start.positions, ElementsAre(0.02, 0));
  EXPECT_THAT(problem.warnings, IsEmpty());
}

TEST(StartState, AContradictionIsNamedOnceWhereItIsGiven) {
  const auto warnings = [](const std::string& of_scene, const std::string& of_start) {
    const Problem problem =
        Parse("joint_state: {name: [f1, f2, wrist], position: [" + of_scene + ", 0]}",
              "joint_state: {name: [" + of_start + "]}");
    EXPECT_EQ(problem.start.positions[1], problem.start.positions[0]);
    return problem.warnings;
  };
  const std::string f2 = "joint 'f2' is given at 0.03, but follows joint 'f1', which puts it at ";
  const std::string in_scene = "scene.yaml:2: robot_state: " + f2;
  EXPECT_THAT(warnings("0.01, 0.0105", "wrist], position: [0"), IsEmpty()) << "measured";
  EXPECT_THAT(warnings("0.01, 0.03", "wrist], position: [0"), ElementsAre(in_scene + "0.01"));
  EXPECT_THAT(warnings("0.01, 0.03", "f1, f2], position: [0.01, 0.03"),
              ElementsAre(in_scene + "0.01"))
      << "both files say it";
  EXPECT_THAT(warnings("0.01, 0.03", "f1, f2], position: [0.02, 0.02"),
              ElementsAre(in_scene + "0.01"))
      << "where the scene's things are is said so";
  EXPECT_THAT(warnings("0.01, 0.01", "f1, f2], position: [0.02, 0.03"),
              ElementsAre("request.yaml:2: start_state: " + f2 + "0.02"));
}

TEST(StartState, PlanarAndFloatingJointsHoldTheirPose) {
  const std::string pose =
      "multi_dof_joint_state: {joint_names: [drive], transforms: [{translation: {x: 1, y: 2, z: "
      "0}, "
      "rotation: {x: 0, y: 0, z: 1, w: 0}}]}";
  const std::string wrist = "joint_state: {name: [wrist], position: [0]}";
  for (const Problem& problem : {Parse(pose, wrist), Parse("", pose + ", " + wrist)}) {
    const auto x =
        std::find(problem.start.names.begin(), problem.start.names.end(), "drive/trans_x");
    ASSERT_NE(x, problem.start.names.end());
    const std::size_t at = static_cast<std::size_t>(x - problem.start.names.begin());
    EXPECT_EQ(problem.start.positions[at], 1);
    EXPECT_EQ(problem.start.positions[at + 1], 2);
    EXPECT_EQ(std::abs(problem.start.positions[at + 5]), 1);
    EXPECT_EQ(problem.start.positions[at + 6], 0);
  }
  EXPECT_EQ(
      Parse("", "joint_state: {name: [drive/trans_x, wrist], position: [3, 0]}").start.positions[0],
      3);
}

TEST(StartState, APlanarJointsVariablesMayBeNamedAsInMoveIt) {
  const auto state = [](const std::string& names, const std::string& positions) {
    return Parse("", "joint_state: {name: [" + names + "], position: [" + positions + "]}");
  };
  const Problem problem = state("drive/theta, wrist, drive/x, drive/y", "1, 0.5, 3, 4");
  EXPECT_THAT(problem.warnings, IsEmpty());
  EXPECT_THAT(problem.start.names,
              ElementsAre("drive/rot_z", "drive/rot_w", "wrist", "drive/trans_x", "drive/trans_y",
                          "drive/rot_x", "drive/rot_y"));
  EXPECT_THAT(problem.start.positions, ElementsAre(std::sin(0.5), std::cos(0.5), 0.5, 3, 4, 0, 0));
  ExpectInputError([&] { state("wrist, drive/x, drive/trans_x", "0, 1, 1"); },
                   {"joint_state.name[2]: the joint 'drive/trans_x' is named twice"});
  ExpectInputError([&] { state("wrist, drive/rot_w, drive/theta", "0, 1, 1"); },
                   {"joint_state.name[2]: the joint 'drive/rot_w' is named twice"});
  ExpectInputError([&] { state("wrist, drive/z", "0, 1"); }, {"'drive/z' is unknown"});
}

TEST(StartState, RefusesWhatTheRobotCannotDo) {
  const auto refuse = [](const std::string& state, const std::string& says) {
    ExpectInputError([&] { Parse("", state); }, {"request.yaml:2: start_state.", says});
  };
  refuse("joint_state: {name: [wrist, weld], position: [0, 0.1]}",
         "joint_state.name[1]: the joint 'weld' is fixed and cannot be at 0.1");
  refuse("joint_state: {name: [wrist, drive], position: [0, 0]}", "'drive' takes a pose");
  refuse("joint_state: {name: [wrist, elbow], position: [0, 0]}", "'elbow' is unknown");
  refuse(
      "multi_dof_joint_state: {joint_names: [wrist], transforms: [{translation: [0, 0, 0], "
      "rotation: [0, 0, 0, 1]}]}",
      "'wrist' is not one that takes a pose");
  refuse(
      "multi_dof_joint_state: {joint_names: [drive, drive], transforms: [{translation: "
      "[0, 0, 0], rotation: [0, 0, 0, 1]}, {translation: [0, 0, 0], rotation: [0, 0, 0, 1]}]}",
      "'drive' is named twice");
}

TEST(StartState, OneJointThatNothingDescribesMayJoinTheRobotToItsSurroundings) {
  const auto poses = [](const std::string& names, const std::string& transforms) {
    return Parse("",
                 "joint_state: {name: [wrist], position: [0]}, multi_dof_joint_state: "
                 "{joint_names: [" +
                     names + "], transforms: [" + transforms + "]}");
  };
  const std::string pose = "{translation: [1, 0, 0], rotation: [0, 0, 0, 1]}";
  for (const char* name : {"virtual_joint", "world_joint", "odom"}) {
    EXPECT_THAT(poses(name, pose).warnings, IsEmpty());
  }
  ExpectInputError([&] { poses("odom, virtual_joint", pose + ", " + pose); },
                   {"joint_names[1]: the robot has no joint 'virtual_joint', and another"});
  ExpectInputError(
      [&] { poses("dirve", pose); },
      {"joint_names[0]: the robot has no joint 'dirve'; did you mean 'drive'?", "virtual_joints"});
}

TEST(StartState, PlanarAndFixedJointsTakeNoPoseThatTheyCannotHave) {
  Robot robot = CartRobot();
  robot.virtual_joints = {{"wheels", JointType::kPlanar, "odom", 0},
                          {"bolt", JointType::kFixed, "world", 0},
                          {"wings", JointType::kFloating, "sky", 0}};
  const auto state = [&](const std::string& joint, const std::string& translation,
                         const std::string& rotation = "0, 0, 0, 1") {
    ParseProblem(YamlNode::Parse("robot_model_name: cart\n", "scene.yaml"),
                 YamlNode::Parse("start_state:\n  joint_state: {name: [wrist], position: [0]}\n"
                                 "  multi_dof_joint_state:\n    joint_names: [" +
                                     joint + "]\n    transforms:\n      - {translation: [" +
                                     translation + "], rotation: [" + rotation +
                                     "]}\ngoal_constraints: "
                                     "[{joint_constraints: [{joint_name: wrist, position: 1}]}]\n",
                                 "request.yaml"),
                 robot, {});
  };
  const auto refuse = [&](const std::string& joint, const std::string& says,
                          const std::string& translation,
                          const std::string& rotation = "0, 0, 0, 1") {
    ExpectInputError(
        [&] { state(joint, translation, rotation); },
        {"request.yaml:6: start_state.multi_dof_joint_state.transforms[0]: the joint '" + joint +
         "' " + says});
  };
  for (const char* joint : {"drive", "wheels"}) {
    state(joint, "1, 2, 0", "0, 0, 1, 0");
    state(joint, "1, 2, 0.00005", "0.00002, 0, 0, 1");
    refuse(joint, "is planar and cannot be off its plane, at z = 0.3", "1, 2, 0.3");
    refuse(joint, "is planar and cannot be tilted, here by 0.2 rad", "1, 2, 0",
           "0.0998334166468, 0, 0, 0.9950041652780");
    refuse(joint, "is planar and cannot be tilted, here by 3.142 rad", "0, 0, 0", "1, 0, 0, 0");
  }
  for (const char* joint : {"weld", "bolt"}) {
    state(joint, "0, 0, 0");
    refuse(joint, "is fixed", "0.01, 0, 0");
  }
  state("wings", "1, 2, 3", "1, 0, 0, 0");
  ExpectInputError(
      [&] { Parse("", "joint_state: {name: [wrist, drive/trans_z], position: [0, 1]}"); },
      {"request.yaml:2: start_state.joint_state.name[1]", "planar"});
}

TEST(StartState, PartsOfAPoseAreHeldToWhatAPoseIsHeldTo) {
  const auto state = [](const std::string& names, const std::string& positions,
                        const std::string& more = "") {
    return Parse(
        "", "joint_state: {name: [wrist, " + names + "], position: [0, " + positions + "]}" + more);
  };
  const auto position = [](const Problem& problem, const std::string& name) {
    const auto at = std::find(problem.start.names.begin(), problem.start.names.end(), name);
    if (at == problem.start.names.end()) return -1e3;
    return problem.start.positions[static_cast<std::size_t>(at - problem.start.names.begin())];
  };
  const Problem turned = state("drive/rot_w, drive/rot_z", "0, 1");
  EXPECT_THAT(turned.warnings, IsEmpty());
  EXPECT_EQ(position(turned, "drive/rot_z"), 1);
  EXPECT_EQ(position(turned, "drive/rot_w"), 0);
  EXPECT_EQ(position(turned, "drive/rot_x"), 0) << "a rotation is told whole";

  const Problem zero = state("drive/rot_w", "0");
  EXPECT_THAT(zero.warnings,
              ElementsAre("request.yaml:2: start_state.joint_state.name[1]: the rotation of joint "
                          "'drive' is all zero; taken as no rotation"));
  EXPECT_EQ(position(zero, "drive/rot_w"), 1);
  const Problem rounded = state("drive/rot_z, drive/rot_w", "0.72, 0.72");
  EXPECT_THAT(rounded.warnings, ElementsAre(HasSubstr("length 1.01823; normalised")));
  EXPECT_NEAR(position(rounded, "drive/rot_w"), std::sqrt(0.5), 1e-12);

  ExpectInputError([&] { state("drive/rot_w, drive/rot_z", "2, 2"); },
                   {"joint_state.name[2]: the rotation of joint 'drive' is no unit quaternion "
                    "(length 2.82843)"});
  ExpectInputError([&] { state("drive/trans_x", "1e300"); },
                   {"joint_state.name[1]: is beyond 1000000000 m"});
  for (const char* part : {"trans_x", "trans_y", "rot_w"}) {
    ExpectInputError(
        [&] {
          state("drive/" + std::string(part), "1",
                ", multi_dof_joint_state: {joint_names: [drive], transforms: [{translation: [1, "
                "0, 0], rotation: [0, 0, 0, 1]}]}");
        },
        {"joint_names[0]: the joint 'drive' is named twice, here and as 'drive/", part});
  }
}

TEST(StartState, APoseInAnotherFrameThanTheJointsIsRefused) {
  const auto in = [](const std::string& header, const std::string& translation = "1, 2, 0",
                     const std::string& more = "", const std::string& more_poses = "",
                     const std::string& header_of_joints = "") {
    Parse("", "joint_state: {header: {frame_id: '" + header_of_joints +
                  "'}, name: [wrist], position: [0]}, multi_dof_joint_state: {header: {frame_id: " +
                  header + "}, joint_names: [drive" + more + "], transforms: [{translation: [" +
                  translation + "], rotation: [0, 0, 0, 1]}" + more_poses + "]}");
  };
  EXPECT_NO_THROW(in("''"));
  EXPECT_NO_THROW(in("/floor"));
  EXPECT_NO_THROW(in("nowhere", "0, 0, 0")) << "it makes no difference";
  EXPECT_NO_THROW(in("map", "1, 2, 0", "", "", "map")) << "the frame of the whole state";
  EXPECT_NO_THROW(
      in("odom", "1, 2, 0", ", world_joint", ", {translation: [1, 0, 0], rotation: [0, 0, 0, 1]}"));
  for (const char* frame : {"nowhere", "hand"}) {
    ExpectInputError([&] { in(frame); },
                     {"request.yaml:2: start_state.multi_dof_joint_state.header.frame_id: the pose "
                      "of the joint 'drive' is one in its own frame on 'floor', not in '" +
                      std::string(frame) + "'"});
  }
}

TEST(StartState, WarnsOfHeldJointsOutsideTheirLimits) {
  const auto warnings = [](const std::string& f1, const std::string& group) {
    return Parse("joint_state: {name: [f1, wrist], position: [" + f1 + ", 0.2]}", "",
                 "{joint_name: wrist, position: 1}, {joint_name: f1, position: 0.01}", group)
        .warnings;
  };
  Problem problem = Parse("", "joint_state: {name: [f1, wrist], position: [0.5, 0.2]}");
  EXPECT_THAT(problem.warnings,
              ElementsAre("request.yaml:2: start_state: held joints are outside their limits: 'f1' "
                          "at 0.5 of [0, 0.04]"));
  EXPECT_EQ(problem.start.positions[0], 0.5) << "it is held there";
  problem = Parse("", "joint_state: {name: [f2, wrist], position: [0.5, 0.2]}");
  EXPECT_THAT(problem.warnings,
              ElementsAre(HasSubstr("limits: 'f1', where 'f2' has it, at 0.5 of [0, 0.04]")));
  problem = Parse("", "joint_state: {name: [f1, wrist], position: [0.0405, 0.2]}");
  EXPECT_THAT(problem.warnings, IsEmpty()) << "measured";
  EXPECT_THAT(warnings("0.5", "grip"), IsEmpty()) << "planners say it of the group's own";
}

TEST(Goals, OfOtherJointsMayOnlySayWhatIsSo) {
  const std::string start = "joint_state: {name: [wrist, f1], position: [0, 0.02]}";
  const auto goals = [&](const std::string& more, const std::string& group = "wrist") {
    return Parse("", start, "{joint_name: wrist, position: 1}, " + more, group).goal.size();
  };
  EXPECT_EQ(goals("{joint_name: weld, position: 0}"), 1u);
  EXPECT_EQ(goals("{joint_name: f1, position: 0.02}, {joint_name: f2, position: 0.02}"), 1u);
  EXPECT_EQ(goals("{joint_name: f1, position: 0.03, tolerance_below: 0.02}"), 1u);
  EXPECT_EQ(goals("{joint_name: f2, position: 0.04}, {joint_name: f1, position: 0.04}", "grip"),
            2u);
  const auto refuse = [&](const std::string& more, const std::string& says,
                          const std::string& group = "wrist") {
    ExpectInputError([&] { goals(more, group); },
                     {"request.yaml:3: goal_constraints[0].joint_constraints", says});
  };
  refuse("{joint_name: weld, position: 0.1}", "'weld' is fixed and cannot be at 0.1");
  refuse("{joint_name: f1, position: 0.03}", "'f1' is not in group 'wrist' and stays at 0.02");
  refuse("{joint_name: f2, position: 0.03}", "'f2' is not in group 'wrist' and stays at 0.02");
  refuse("{joint_name: drive, position: 0}", "'drive' has a pose");
  refuse("{joint_name: f2, position: 0.04}", "'f2' follows 'f1'; give a goal for that", "grip");
  refuse("{joint_name: f1, position: 0.04}, {joint_name: f2, position: 0}",
         "the joint 'f2' follows 'f1', whose goal puts it at 0.04", "grip");
}

TEST(Goals, OfAFixedJointAreTakenWhereAStartMayNameIt) {
  const auto warnings = [](const std::string& weld) {
    return Parse("", "joint_state: {name: [wrist], position: [0]}",
                 "{joint_name: wrist, position: 1}, {joint_name: weld, position: " + weld + "}")
        .warnings;
  };
  EXPECT_THAT(warnings("0.065"), IsEmpty());
  EXPECT_THAT(warnings("0.03, tolerance_below: 0.05"), IsEmpty()) << "it is at 0, too";
  EXPECT_THAT(warnings("-0.065"),
              ElementsAre(HasSubstr("joint_constraints[1].position: the joint 'weld' is fixed; "
                                    "-0.065 is a number of its origin")));
}

TEST(Goals, OfPartsOfAPoseMayOnlySayWhatIsSo) {
  const auto goals = [](const std::string& more) {
    Parse("", "joint_state: {name: [wrist, drive/x, drive/theta], position: [0, 3, 2]}",
          "{joint_name: wrist, position: 1}, " + more);
  };
  for (const char* met :
       {"{joint_name: drive/trans_x, position: 3}", "{joint_name: drive/x, position: 3}",
        "{joint_name: drive/y, position: 0.1, tolerance_below: 0.2}",
        "{joint_name: drive/theta, position: 2}",
        "{joint_name: drive/theta, position: -4.283185307179586}",
        "{joint_name: drive/rot_x, position: 0}"}) {
    EXPECT_NO_THROW(goals(met)) << met;
  }
  ExpectInputError([&] { goals("{joint_name: drive/trans_x, position: 0}"); },
                   {"'drive/trans_x' is not in group 'wrist' and stays at 3"});
  ExpectInputError([&] { goals("{joint_name: drive/theta, position: -2}"); },
                   {"'drive/theta' is not in group 'wrist' and stays at 2"});
  ExpectInputError([&] { goals("{joint_name: drive/z, position: 0}"); }, {"'drive/z' is unknown"});

  const auto turned = [&](double z, double w) {
    goals(
        fmt::format("{{joint_name: drive/rot_w, position: {}}}, {{joint_name: drive/rot_z, "
                    "position: {}}}, {{joint_name: drive/theta, position: 2}}",
                    w, z));
  };
  EXPECT_NO_THROW(turned(std::sin(1.0), std::cos(1.0)));
  EXPECT_NO_THROW(turned(-std::sin(1.0), -std::cos(1.0))) << "the same rotation";
  ExpectInputError([&] { turned(-std::sin(1.0), std::cos(1.0)); }, {"'drive/rot_w' is not in"});
  ExpectInputError([&] { goals("{joint_name: drive/rot_z, position: -0.8414709848078965}"); },
                   {"'drive/rot_z' is not in group 'wrist' and stays at 0.841471"});
}

TEST(UnnamedGroup, IsThatOfTheGoalsJointsAndTheSessionSaysSo) {
  const auto read = [](const std::string& goals) {
    return Parse("", "joint_state: {name: [wrist, f1], position: [0, 0]}", goals, "''");
  };
  constexpr const char* kWrist =
      "{joint_name: wrist, position: 1}, {joint_name: weld, position: 0}";
  Problem problem = read(kWrist);
  EXPECT_EQ(problem.group, "wrist");
  EXPECT_THAT(problem.warnings, ElementsAre("request.yaml:1: group_name: no group_name, so "
                                            "'wrist', of the groups wrist, grip"));
  problem = read("{joint_name: wrist, position: 1}, {joint_name: f1, position: 0.04}");
  EXPECT_EQ(problem.group, "grip") << "the only one that has all";
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("so 'grip', of the groups")));

  ExpectInputError([&] { read("{joint_name: f1, position: 0.04}"); },
                   {"request.yaml:3: goal_constraints[0].joint_constraints: there is no goal for "
                    "joint 'wrist' of group 'grip' (no group_name, so 'grip')"});
  ExpectInputError([&] { Parse("", "joint_state: {name: [f1], position: [0]}", kWrist, "''"); },
                   {"does not name joint 'wrist' of group 'wrist' (no group_name, so 'wrist')"});

  const auto without_name = [&](const Robot& robot) {
    return ParseProblem(
        YamlNode::Parse("robot_model_name: cart\n", "scene.yaml"),
        YamlNode::Parse("start_state: {joint_state: {name: [wrist, f1], position: [0, 0]}}\n"
                        "goal_constraints: [{joint_constraints: [" +
                            std::string(kWrist) + "]}]\n",
                        "request.yaml"),
        robot, {});
  };
  Robot robot = CartRobot();
  std::swap(robot.groups[0], robot.groups[1]);
  problem = without_name(robot);
  EXPECT_EQ(problem.group, "wrist") << "both have the joint, this one no other";
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("no group_name, so 'wrist'")));
  robot.groups.pop_back();
  robot.groups.front() = robot.model.MakeGroup("only", {"wrist"}, "hand");
  problem = without_name(robot);
  EXPECT_EQ(problem.group, "only");
  EXPECT_THAT(problem.warnings, IsEmpty()) << "there is no other";
}

TEST(ContinuousJoints, AreReadWithoutWholeTurns) {
  const auto read = [](const std::string& start, const std::string& goal) {
    return ParseProblem(kFullScene, Replaced(Replaced(kFullRequest, "position: [0.5, 1]",
                                                      "position: [" + start + ", 1]"),
                                             "position: 1.5,", "position: " + goal + ","));
  };
  Problem problem = read("3.5", "-6");
  EXPECT_NEAR(problem.start.positions[0], 3.5 - 2 * kPi, 1e-12);
  EXPECT_NEAR(problem.goal[0].position, 2 * kPi - 6, 1e-12);
  EXPECT_THAT(problem.warnings, IsEmpty());
  problem = read("3.141592653589793", "-3.141592653589793");
  EXPECT_EQ(problem.start.positions[0], kPi) << "as it is written";
  EXPECT_EQ(problem.goal[0].position, -kPi);
  problem = read("180", "90");
  EXPECT_NEAR(problem.start.positions[0], 180 - 58 * kPi, 1e-12);
  EXPECT_NEAR(problem.goal[0].position, 90 - 28 * kPi, 1e-12);
  EXPECT_THAT(problem.warnings,
              ElementsAre("request.yaml:9: start_state.joint_state.name[0]: the joint 'a_joint' is "
                          "at 180 rad, 28.6 turns; degrees?",
                          "request.yaml:13: goal_constraints[0].joint_constraints[0].position: the "
                          "joint 'a_joint' is at 90 rad, 14.3 turns; degrees?"));
}

TEST(ContinuousJoints, OutsideTheGroupAreWhereTheyAreAtAnyTurn) {
  Robot robot = TextRobot();
  robot.groups = {robot.model.MakeGroup("arm", {"b_joint"}, "gripper_link")};
  const auto read = [&](const std::string& goal, const std::string& start = "0.5") {
    return ParseProblem(
        YamlNode::Parse(kFullScene, "scene.yaml"),
        YamlNode::Parse(
            Replaced(Replaced(kFullRequest, "position: 1.5,", "position: " + goal + ","),
                     "position: [0.5, 1]", "position: [" + start + ", 1]"),
            "request.yaml"),
        robot, {});
  };
  EXPECT_THAT(read("0.5").warnings, IsEmpty());
  EXPECT_THAT(read("133.7", "133.7").warnings, IsEmpty()) << "a wheel that has rolled";
  EXPECT_NO_THROW(read("6.783185307179586"));
  ExpectInputError([&] { read("3.5"); }, {"'a_joint' is not in group 'arm' and stays at 0.5"});
}

TEST(ContinuousJoints, OutsideTheGroupAreAtNoOtherTurnWhereTheirFollowersWouldBeElsewhere) {
  const auto read = [&](double multiplier, const std::string& goal) {
    Robot robot;
    robot.name = "crank";
    robot.model = RobotModel::FromUrdf(
        fmt::format("<robot name='crank'><link name='a'/><link name='b'/><link name='c'/>"
                    "<link name='d'/>"
                    "<joint name='turn' type='continuous'><parent link='a'/><child link='b'/>"
                    "</joint><joint name='gear' type='continuous'><parent link='a'/>"
                    "<child link='c'/><mimic joint='turn' multiplier='{}'/></joint>"
                    "<joint name='lift' type='prismatic'><parent link='a'/><child link='d'/>"
                    "<limit lower='0' upper='2' velocity='1' effort='1'/></joint></robot>",
                    multiplier),
        "crank.urdf");
    robot.groups = {robot.model.MakeGroup("lift", {"lift"}, "d")};
    return ParseProblem(
        YamlNode::Parse("robot_model_name: crank\n", "scene.yaml"),
        YamlNode::Parse("start_state: {joint_state: {name: [lift, turn], position: [0, 0.5]}}\n"
                        "goal_constraints: [{joint_constraints: [{joint_name: lift, position: 1}, "
                        "{joint_name: turn, position: " +
                            goal + "}]}]\n",
                        "request.yaml"),
        robot, {});
  };
  const std::string a_turn_later = "6.783185307179586";
  EXPECT_NO_THROW(read(2, a_turn_later));
  EXPECT_NO_THROW(read(0.5, "0.5"));
  ExpectInputError([&] { read(0.5, a_turn_later); },
                   {"the joint 'turn' is not in group 'lift' and stays at 0.5"});
}

Scene SceneOfOctomap(const std::string& data, const std::string& binary) {
  return ParseProblem(R"(robot_model_name: fetch
fixed_frame_transforms:
  - {header: {frame_id: camera}, child_frame_id: base_link,
     transform: {translation: [0, 0, 1], rotation: [0, 0, 0, 1]}}
world:
  octomap:
    header: {frame_id: camera}
    origin: {position: [0, 2, 0], orientation: [0, 0, 0, 0]}
    octomap: {id: OcTree, resolution: 0.0001, data: )" +
                      data + ", binary: " + binary + "}\n")
      .scene;
}

TEST(Octomap, IsAnObjectOfBoxes) {
  // The root's last child is a leaf of log-odds 1.
  const Scene full = SceneOfOctomap("[0, 0, 0, 0, -128, 0, 0, 128, 63, 0]", "false");
  ASSERT_EQ(full.objects.size(), 1u);
  EXPECT_EQ(full.objects[0].id, "<octomap>");
  ASSERT_EQ(full.objects[0].shapes.size(), 1u);
  EXPECT_TRUE(std::get<Box>(full.objects[0].shapes[0].shape)
                  .size.isApprox(Eigen::Vector3d::Constant(3.2768)));
  EXPECT_TRUE((full.objects[0].X_WO * full.objects[0].shapes[0].X_FS.translation())
                  .isApprox(Eigen::Vector3d(1.6384, 3.6384, 2.6384)));
  EXPECT_EQ(SceneId(SceneOfOctomap("[0, -128]", "true")), SceneId(full));
  EXPECT_EQ(SceneId(SceneOfOctomap("!!binary AIA=", "1")), SceneId(full));
  EXPECT_TRUE(SceneOfOctomap("[]", "true").objects.empty());
  EXPECT_TRUE(SceneOfOctomap("[0, 64]", "true").objects.empty()) << "free only";
  for (const char* data : {"[1]", "[1, 2, 3, 4]", "!!binary AQIDBA==", "4a4b4c"}) {
    try {
      SceneOfOctomap(data, "true");
      FAIL() << data;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("scene.yaml:9: world.octomap.octomap.data"));
      EXPECT_LT(std::string(error.what()).size(), 160u);
    }
  }
}

TEST(Octomap, MayBeAZlibStreamInHexadecimalDigits) {
  const std::string id = SceneId(SceneOfOctomap("[0, -128]", "true"));
  for (const char* digits : {"789C6368000000820081", "789c6368000000820081",
                             "'7801010200FDFF008000820081'"}) {  // The last is stored, not packed.
    EXPECT_EQ(SceneId(SceneOfOctomap(digits, "True")), id) << digits;
  }
  const auto refuse = [](const std::string& digits, const std::string& says) {
    ExpectInputError([&] { SceneOfOctomap(digits, "true"); },
                     {"scene.yaml:9: world.octomap.octomap.data: " + says});
  };
  for (const char* other : {"789C636800000082008", "799C6368000000820081", "789C63680000008200Z1",
                            "AIA=", "''", "78", "789C 6368"}) {
    refuse(other, "expected a sequence of bytes, !!binary, or a zlib stream in hexadecimal digits");
  }
  for (const char* damaged :
       {"789C636800000082", "789C6368000000820082", "789CFFFFFFFF", "789C636800000082008100"}) {
    refuse(damaged, "is no whole zlib stream");
  }
  const std::vector<Bytef> zeros((std::size_t{16} << 20) + 1);
  uLongf size = compressBound(zeros.size());
  std::vector<Bytef> packed(size);
  ASSERT_EQ(compress2(packed.data(), &size, zeros.data(), zeros.size(), 1), Z_OK);
  std::string digits;
  for (std::size_t i = 0; i < size; ++i) digits += fmt::format("{:02X}", packed[i]);
  refuse(digits, "unpacks to more than 16777216 bytes");
}

}  // namespace
}  // namespace planbench
