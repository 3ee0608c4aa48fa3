#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scene/frame_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

// Frames that virtual joints place, or have the robot stand in.

TEST(Frames, AVirtualJointPlacesTheRobot) {
  for (const char* frame : {"odom", "/odom"}) {
    const std::string state = "robot_state:\n" + RootAt(frame, "0, 1, 0", kQuarter);
    ExpectAt(Ball(BallIn("odom", state)), -1, -1, 0);
    ExpectAt(Ball(BallIn("", state)), -1, -1, 0);
    ExpectAt(Ball(BallIn("base_link", state)), 1, 0, 0);
    ExpectAt(Ball(BallIn("gripper_link", state)), 0, 2, 0);
    ExpectAt(Ball(BallIn("camera", state + kTransforms + Transform("camera", "odom", "0, 0, 5"))),
             -1, -1, 5);
  }
  // In a frame without a name.
  ExpectAt(Ball(BallIn("", "robot_state:\n" + RootAt("", "1, 0, 0"))), 0, 0, 0);
  ExpectAt(Ball(BallIn("base_link", "robot_state:\n" + RootAt("", "1, 0, 0"))), 1, 0, 0);
  // At the identity in whatever frame.
  ExpectAt(Ball(BallIn("base_link", "robot_state:\n" + RootAt("base_link", "0, 0, 0"))), 1, 0, 0);
  ExpectAt(Ball(BallIn("odom", "robot_state:\n" + RootAt("odom", "0, 0, 0"))), 1, 0, 0);
}

TEST(Frames, TheRequestsVirtualJointComesFirst) {
  const std::string request =
      Replaced(kBallRequest, "start_state: {joint_state: {name",
               "start_state:\n" + RootAt("odom", "0, 0, -2") + "  joint_state: {name");
  ExpectAt(Ball(BallIn("odom", "robot_state:\n" + RootAt("odom", "0, 0, 9")),
                Replaced(request, "0]}}", "0]}")),
           1, 0, 2);
}

// Robot and world objects are where the scene has them in its planning frame; then the robot goes
// to the start.
TEST(Frames, TheWorldStandsStillWhereTheRequestPlacesTheRobotElsewhere) {
  const std::string request =
      Replaced(Replaced(kBallRequest, "start_state: {joint_state: {name",
                        "start_state:\n" + RootAt("odom", "0, 0, -2") + "  joint_state: {name"),
               "0]}}", "0]}");
  const std::string state = "robot_state:\n" + RootAt("odom", "0, 0, 9") +
                            "  joint_state: {name: [a_joint], position: [0]}\n";
  ExpectAt(Ball(BallIn("gripper_link", state), request), 2, 0, 11);
  ExpectAt(Ball(BallIn("base_link", state), request), 1, 0, 11);
  ExpectAt(Ball(BallIn("odom", state), request), 1, 0, 2);
  ExpectInputError(
      [&] { Ball(BallIn("odom", Replaced(state, "'odom'", "'map'")), request); },
      {"request.yaml:6: start_state.multi_dof_joint_state.transforms[0]: places the robot in the "
       "frame 'odom', but the other file in 'map'"});
}

TEST(Frames, TheFrameThatTheStartPlacesTheRobotInMustBeKnownInTheScenesStateToo) {
  const std::string request =
      Replaced(Replaced(kBallRequest, "start_state: {joint_state: {name",
                        "start_state:\n" + RootAt("map", "0, 0, 1") + "  joint_state: {name"),
               "0]}}", "0]}");
  const std::string scene =
      BallIn("base_link", "robot_state:\n" + RootAt("", "0, 0, 0") + kTransforms +
                              Transform("base_link", "base_link", "0, 0, 0"));
  ExpectInputError(
      [&] { Ball(scene, request); },
      {"request.yaml:6: start_state.multi_dof_joint_state.transforms[0]: has the robot "
       "stand in the frame 'map', which is unknown"});
  EXPECT_NO_THROW(Ball(Replaced(scene, "''}\n    joint_names", "map}\n    joint_names"), request));
}

TEST(Frames, AVirtualJointAndATransformMustAgree) {
  const std::string joint = "robot_state:\n" + RootAt("odom", "0, 0, -2");
  ExpectAt(Ball(BallIn("odom", joint + kTransforms + Transform("odom", "base_link", "0, 0, -2"))),
           1, 0, 2);
  ExpectInputError(
      [&] {
        Ball(BallIn("odom", joint + kTransforms + Transform("odom", "base_link", "0, 0, 1")));
      },
      {"scene.yaml:6: robot_state.multi_dof_joint_state.transforms[0]", "'odom'"});
  for (const char* link : {"base_link", "gripper_link"}) {
    ExpectInputError([&] { Ball(BallIn("", "robot_state:\n" + RootAt(link, "0, 0, 1"))); },
                     {"transforms[0]: places the robot's link 'base_link' in the frame", link});
  }
}

TEST(Frames, OfAFixedVirtualJoint) {
  Robot robot = TextRobot();
  robot.virtual_joints = {
      {"stand", JointType::kFixed, "/world", robot.model.FindLink("base_link")}};
  const auto ball = [&](const std::string& scene) {
    const Scene read = ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                                    YamlNode::Parse(kBallRequest, "request.yaml"), robot, {})
                           .scene;
    return PlaceOf(read.objects.at(0));
  };
  for (const char* frame : {"world", "/world", ""}) ExpectAt(ball(BallIn(frame)), 1, 0, 0);
  // Whatever frame the file is in.
  for (const char* planning_frame : {"base_link", "gripper_link", "map", "world"}) {
    const std::string state =
        std::string("robot_state: {joint_state: {header: {frame_id: ") + planning_frame + "}}}\n";
    ExpectAt(ball(BallIn("world", state)), 1, 0, 0);
  }
  // Transforms lead on from there, and it is no frame of theirs that the robot stands at.
  const std::string camera = kTransforms + Transform("world", "camera", "0, 0, 3");
  ExpectAt(ball(BallIn("camera", camera)), 1, 0, 3);
  ExpectAt(ball(BallIn("world", camera)), 1, 0, 0);
  ExpectAt(ball(BallIn("", camera)), 1, 0, 0);
  // The file may say otherwise.
  ExpectAt(ball(BallIn("world", kTransforms + Transform("base_link", "world", "0, 5, 0"))), 1, -5,
           0);
  // An object of that name does not.
  ExpectAt(ball(Replaced(BallIn("world"), "world:\n  collision_objects:\n",
                         "world:\n  collision_objects:\n    - {id: world, header: {frame_id: "
                         "gripper_link}, primitives: [{type: sphere, dimensions: [1]}], "
                         "primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]}\n")),
           0, 1, 0);
}

// A floating joint has the gripper in `odom`, a planar one the base in `map`.
Eigen::Vector3d BallOfFloatingGripper(const std::string& scene,
                                      const std::string& request = kBallRequest) {
  Robot robot = TextRobot();
  robot.virtual_joints = {
      {"fly", JointType::kFloating, "/odom", robot.model.FindLink("gripper_link")},
      {"drive", JointType::kPlanar, "map", robot.model.FindLink("base_link")}};
  return PlaceOf(ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                              YamlNode::Parse(request, "request.yaml"), robot, {})
                     .scene.objects.at(0));
}

std::string PosesOf(const std::string& header, const std::string& joints,
                    const std::string& transforms) {
  return "  multi_dof_joint_state: {header: {frame_id: '" + header + "'}, joint_names: [" + joints +
         "], transforms: [" + transforms + "]}\n";
}

constexpr const char* kAtFive = "{translation: [5, 0, 0], rotation: [0, 0, 0, 1]}";
constexpr const char* kAtSeven = "{translation: [0, 7, 0], rotation: [0, 0, 0, 1]}";

TEST(Frames, AVirtualJointPlacesItsOwnChildLink) {
  const std::string fly = "robot_state:\n" + PosesOf("odom", "fly", kAtFive);
  // The gripper, at (0, 1, 0) and turned by a quarter, is at (5, 0, 0) of odom.
  ExpectAt(BallOfFloatingGripper(BallIn("odom", fly)), 0, -3, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("", fly)), 0, -3, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("gripper_link", fly)), 0, 2, 0);
  // The other stands at its child link, which nothing says otherwise of.
  ExpectAt(BallOfFloatingGripper(BallIn("map", fly)), 1, 0, 0);
  // Of each its own.
  const std::string both =
      "robot_state:\n" + PosesOf("map", "fly, drive", std::string(kAtFive) + ", " + kAtSeven);
  ExpectAt(BallOfFloatingGripper(BallIn("odom", both)), 0, -3, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("map", both)), 1, -7, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("", both)), 1, -7, 0);
}

TEST(Frames, WhatAVirtualJointHoldsStandsStillWhileTheRootMoves) {
  // With the mast at 0 in the scene the gripper has the axes of odom, and the ball is at (-4, 0, 0)
  // of it; at the start it is there too, but along y.
  const std::string fly = "robot_state:\n" + PosesOf("odom", "fly", kAtFive) +
                          "  joint_state: {name: [a_joint, b_joint], position: [0, 0]}\n";
  ExpectAt(BallOfFloatingGripper(BallIn("odom", fly)), 0, -3, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("gripper_link", fly)), 0, 2, 0);
  // The base is at (4, 0, 0) of odom in the scene, so that the ball is at the gripper.
  ExpectAt(BallOfFloatingGripper(BallIn("base_link", fly)), 0, 1, 0);
}

TEST(Frames, OfVirtualJointsWithoutAPoseAreAtTheirChildLinks) {
  ExpectAt(BallOfFloatingGripper(BallIn("odom")), 0, 2, 0);
  ExpectAt(BallOfFloatingGripper(BallIn("map")), 1, 0, 0);
}

TEST(Frames, VirtualJointsThatContradictAreNamed) {
  const auto refuse = [](const std::string& state, const std::vector<std::string>& says) {
    ExpectInputError([&] { BallOfFloatingGripper(BallIn("odom", "robot_state:\n" + state)); },
                     says);
  };
  refuse(PosesOf("odom", "fly", kAtFive) + kTransforms + Transform("odom", "base_link", "0, 0, 0"),
         {"scene.yaml:3: robot_state.multi_dof_joint_state.transforms[0]",
          "'gripper_link' in the frame 'odom', which has another pose already"});
  refuse(PosesOf("odom", "fly, fly", std::string(kAtFive) + ", " + kAtFive),
         {"joint_names[1]: the joint 'fly' is named twice"});
  refuse(PosesOf("hall", "fly", kAtFive),
         {"multi_dof_joint_state.header.frame_id: the pose of the joint 'fly' is one in '/odom', "
          "not in 'hall'"});
  refuse(PosesOf("odom", "flyy", kAtFive),
         {"joint_names[0]: the robot has no joint 'flyy'; did you mean 'fly'?"});
  refuse(PosesOf("odom", "world_joint", kAtFive),
         {"no joint 'world_joint'; its virtual joints are 'fly', 'drive'"});
}

TEST(Frames, VirtualJointsHaveNoPositions) {
  for (const char* name : {"fly", "fly/trans_x"}) {
    ExpectInputError(
        [&] {
          BallOfFloatingGripper(BallIn("odom", "robot_state:\n  joint_state: {name: [" +
                                                   std::string(name) + "], position: [0]}\n"));
        },
        {"scene.yaml:3: robot_state.joint_state.name[0]: '" + std::string(name) +
             "' is of the virtual joint 'fly'",
         "multi_dof_joint_state"});
  }
}

}  // namespace
}  // namespace planbench
