#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "common/error.h"
#include "scene/frame_tree.h"
#include "tests/scene/frame_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Frames, OfTheRobotsLinks) {
  ExpectAt(Ball(BallIn("base_link")), 1, 0, 0);
  ExpectAt(Ball(BallIn("gripper_link")), 0, 2, 0);
  ExpectAt(Ball(BallIn("/r_finger")), 0, 2, 0);
  EXPECT_EQ(ParseProblem(BallIn("gripper_link"), kBallRequest).scene.world_frame, "base_link");
}

std::string SceneState(const std::string& names, const std::string& positions) {
  return "robot_state: {joint_state: {name: [" + names + "], position: [" + positions + "]}}\n";
}

TEST(Frames, OfLinksAreWhereTheScenesOwnStateHasThem) {
  const auto ball = [](const std::string& names, const std::string& positions) {
    return Ball(BallIn("gripper_link", SceneState(names, positions)));
  };
  ExpectAt(ball("a_joint, b_joint", "0, 3"), 2, 0, 3);
  // What it leaves open is as at the start.
  ExpectAt(ball("b_joint", "3"), 0, 2, 3);
  ExpectAt(ball("", ""), 0, 2, 0);
  ExpectAt(Ball(BallIn("lens", SceneState("a_joint, b_joint", "0, 3") + kTransforms +
                                   Transform("gripper_link", "lens", "0, 0, 2"))),
           2, 0, 5);
  ExpectAt(Ball(BallIn("base_link", SceneState("a_joint, b_joint", "0, 3"))), 1, 0, 0);
}

TEST(Frames, FixedTransformsInEitherDirection) {
  for (const auto& [header, child] : {std::pair{"camera", "base_link"}, {"base_link", "camera"}}) {
    ExpectAt(Ball(BallIn("camera", kTransforms + Transform(header, child, "0, 0.9, 0"))), 1, 0.9,
             0);
    ExpectAt(Ball(BallIn("camera", kTransforms + Transform(header, child, "0, 2, 0", kQuarter))), 0,
             3, 0);
    ExpectAt(Ball(BallIn("base_link", kTransforms + Transform(header, child, "0, 0.9, 0"))), 1, 0,
             0);
    ExpectAt(Ball(BallIn("/camera", kTransforms + Transform("/" + std::string(header),
                                                            "/" + std::string(child), "0, 2, 0"))),
             1, 2, 0);
  }
}

TEST(Frames, FixedTransformsFromALink) {
  ExpectAt(Ball(BallIn("lens", kTransforms + Transform("gripper_link", "lens", "0, 0, 2"))), 0, 2,
           2);
  ExpectAt(Ball(BallIn("lens", kTransforms + Transform("lens", "gripper_link", "0, 0, 2"))), 0, 2,
           2);
}

TEST(Frames, ChainsOfFixedTransforms) {
  const std::string a = Transform("base_link", "room", "0, 2, 0", kQuarter);
  const std::string a_reversed = Transform("room", "base_link", "0, 2, 0", kQuarter);
  const std::string b = Transform("room", "shelf", "5, 0, 0");
  const std::string b_reversed = Transform("shelf", "room", "5, 0, 0");
  const std::string c = Transform("board", "shelf", "0, 0, 1");
  for (const std::string& chain : {a + b + c, c + b + a, a_reversed + b_reversed + c,
                                   b + c + a_reversed, c + a + b_reversed}) {
    ExpectAt(Ball(BallIn("board", kTransforms + chain)), 0, 8, 1);
  }
}

TEST(Frames, LeadingSlashesDoNotCount) {
  for (const char* slashes : {"/", "//", "///"}) {
    const auto named = [&](const char* name) { return std::string(slashes) + name; };
    EXPECT_EQ(WithoutSlash(named("")), "");
    EXPECT_EQ(WithoutSlash(named("table//edge")), "table//edge");
    ExpectAt(Ball(BallIn(named("r_finger"))), 0, 2, 0);
    const std::string state =
        "robot_state: {joint_state: {header: {frame_id: " + named("world") + "}}}\n";
    ExpectAt(Ball(BallIn("world", state)), 1, 0, 0);
    for (const auto& [header, child] :
         {std::pair{named("map"), named("base_link")}, {named("base_link"), named("map")}}) {
      ExpectAt(Ball(BallIn("map", kTransforms + Transform(header, child, "0, 2, 0"))), 1, 2, 0);
    }
    Robot robot = TextRobot();
    robot.virtual_joints = {
        {"stand", JointType::kFixed, named("odom"), robot.model.FindLink("base_link")}};
    const Problem problem = ParseProblem(YamlNode::Parse(BallIn("odom"), "scene.yaml"),
                                         YamlNode::Parse(kBallRequest, "request.yaml"), robot, {});
    ExpectAt(PlaceOf(problem.scene.objects.at(0)), 1, 0, 0);
  }
}

TEST(Frames, OfLinksWhoseNamesBeginWithASlash) {
  Robot robot;
  robot.name = "fetch";
  robot.model = RobotModel::FromUrdf(
      "<robot name='r'><link name='/base'/><link name='/hand'/><joint name='j' type='revolute'>"
      "<parent link='/base'/><child link='/hand'/><origin xyz='0 1 0'/><axis xyz='0 0 1'/>"
      "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>",
      "r.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"j"}, "/hand")};
  for (const char* hand : {"hand", "/hand"}) {
    const std::string attached =
        "robot_state: {attached_collision_objects: [{link_name: /hand, touch_links: [/hand], "
        "object: {id: tool, header: {frame_id: " +
        std::string(hand) + "}, primitives: [{type: sphere, dimensions: [0.1]}], " +
        "primitive_poses: [{orientation: {w: 1}}]}}]}\n";
    const Problem problem =
        ParseProblem(YamlNode::Parse(BallIn(hand, attached), "scene.yaml"),
                     YamlNode::Parse("start_state: {joint_state: {name: [j], position: [0]}}\n"
                                     "goal_constraints: [{position_constraints: [{header: "
                                     "{frame_id: /base}, link_name: /hand, constraint_region: "
                                     "{primitives: [{type: 2, dimensions: [0.1]}], "
                                     "primitive_poses: [{position: [0, 1, 0], orientation: "
                                     "[0, 0, 0, 1]}]}}]}]\n",
                                     "request.yaml"),
                     robot, {});
    ExpectAt(PlaceOf(problem.scene.objects.at(0)), 1, 1, 0);
    EXPECT_EQ(problem.scene.attached.at(0).link, "/hand");
    ExpectAt(PlaceOf(problem.scene.attached.at(0).object), 0, 0, 0);
    EXPECT_TRUE(problem.warnings.empty());
  }
}

// The farthest first, which is the order that takes longest if the list is gone through for each.
TEST(Frames, ALongChainIsFollowedInOneWalk) {
  constexpr int kLength = 20000;
  const Robot robot = TextRobot();
  const YamlNode node = YamlNode::Parse("{}", "scene.yaml");
  std::vector<FixedTransform> transforms;
  for (int i = kLength; i > 0; --i) {
    transforms.push_back({.header = i == 1 ? "base_link" : std::to_string(i - 1),
                          .child = std::to_string(i),
                          .X = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.5)),
                          .node = node});
  }
  const FrameTree frames(robot, {.positions = robot.model.DefaultPositions(), .placed_links = {}},
                         {.name = "map"}, transforms);
  const Eigen::Isometry3d* last = frames.Find(std::to_string(kLength));
  ASSERT_NE(last, nullptr);
  ExpectAt(last->translation(), 0, 0, 0.5 * kLength);
}

TEST(Frames, ATransformSaidTwiceMustBeTheSame) {
  const std::string once = kTransforms + Transform("base_link", "camera", "0, 2, 0");
  ExpectAt(Ball(BallIn("camera", once + Transform("camera", "base_link", "0, 2, 0.0000001"))), 1, 2,
           0);
  // As tf has the reverse.
  ExpectAt(Ball(BallIn("camera", once + Transform("camera", "base_link", "0, -2, 0"))), 1, 2, 0);
  ExpectInputError(
      [&] { Ball(BallIn("camera", once + Transform("camera", "base_link", "0, 2.1, 0"))); },
      {"scene.yaml:4: fixed_frame_transforms[1]", "'camera' and 'base_link' stand otherwise"});
  ExpectInputError(
      [&] {
        Ball(BallIn("camera", once + Transform("camera", "lens", "1, 0, 0") +
                                  Transform("lens", "base_link", "0, 0, 0")));
      },
      {"fixed_frame_transforms[", "stand otherwise"});
}

TEST(Frames, ThePlanningFrameIsTheRootsUnlessItIsPlaced) {
  // Named by itself, by the state, or as MoveIt names it in every other frame's entry.
  ExpectAt(Ball(BallIn("world", kTransforms + Transform("world", "world", "0, 0, 0"))), 1, 0, 0);
  ExpectAt(Ball(BallIn("odom", "robot_state: {joint_state: {header: {frame_id: odom}}}\n")), 1, 0,
           0);
  ExpectAt(Ball(BallIn("odom", "robot_state: {joint_state: {header: {frame_id: /odom}}}\n")), 1, 0,
           0);
  ExpectAt(Ball(BallIn("camera", kTransforms + Transform("camera", "map", "0, 0, 3"))), 1, 0, 3);
  ExpectAt(Ball(BallIn("map", kTransforms + Transform("camera", "map", "0, 0, 3"))), 1, 0, 0);
  // Without a name.
  ExpectAt(Ball(BallIn("")), 1, 0, 0);
  ExpectAt(Ball(BallIn("world", kTransforms + Transform("", "world", "0, 0, 0"))), 1, 0, 0);
  // It may be a link that is not the root.
  ExpectAt(Ball(BallIn("", "robot_state: {joint_state: {header: {frame_id: gripper_link}}}\n")), 0,
           2, 0);
  // Transforms join it to the robot.
  const std::string placed =
      kTransforms + Transform("map", "map", "0, 0, 0") + Transform("map", "base_link", "0, 7, 0");
  ExpectAt(Ball(BallIn("", placed)), 1, -7, 0);
  ExpectAt(Ball(BallIn("map", placed)), 1, -7, 0);
}

// As of any other frame the numbers are its pose in the planning frame, whichever the header names.
TEST(Frames, ATransformOfALinkSaysWhereTheRobotStandsInThePlanningFrame) {
  const std::string map = kTransforms + Transform("map", "map", "0, 0, 0");
  for (const std::string& robot :
       {Transform("base_link", "map", "0, 7, 0"), Transform("map", "base_link", "0, 7, 0")}) {
    ExpectAt(Ball(BallIn("map", map + robot)), 1, -7, 0);
    ExpectAt(Ball(BallIn("base_link", map + robot)), 1, 0, 0);
    ExpectAt(Ball(BallIn("camera", map + robot + Transform("camera", "map", "0, 7, 3"))), 1, 0, 3);
    // MoveIt does not.
    EXPECT_THAT(ParseProblem(BallIn("map", map + robot), kBallRequest).warnings,
                ElementsAre(HasSubstr(
                    "scene.yaml:4: fixed_frame_transforms[1]: taken as the pose of the robot's "
                    "link 'base_link' in the frame 'map', which places the robot in the planning "
                    "frame 'map'; MoveIt passes it over")));
  }
  ExpectAt(Ball(BallIn("", kTransforms + Transform("", "base_link", "0, 7, 0"))), 1, -7, 0);
  ExpectAt(Ball(BallIn("map", map + Transform("gripper_link", "map", "0, 0, 5"))), 0, 2, -5);
  // Where the robot's state says the same, or nothing is said, there is nothing to warn of.
  const std::string joint = "robot_state:\n" + RootAt("map", "0, 7, 0");
  for (const std::string& scene :
       {BallIn("map", joint + kTransforms + Transform("base_link", "map", "0, 7, 0")),
        BallIn("map", map + Transform("base_link", "map", "0, 0, 0"))}) {
    EXPECT_THAT(ParseProblem(scene, kBallRequest).warnings, IsEmpty());
  }
}

// Whether tf has a frame in between or not.
TEST(Frames, ChainsAreFollowedOutwardsFromThePlanningFrame) {
  const std::string map = kTransforms + Transform("map", "map", "0, 0, 0");
  const std::string odom = Transform("map", "odom", "0, 0, 0");
  const std::string robot = Transform("odom", "base_link", "0, 7, 0");
  for (const std::string& chain : {odom + robot, robot + odom}) {
    ExpectAt(Ball(BallIn("map", map + chain)), 1, -7, 0);
    ExpectAt(Ball(BallIn("odom", map + chain)), 1, -7, 0);
    ExpectAt(Ball(BallIn("base_link", map + chain)), 1, 0, 0);
    ExpectAt(Ball(BallIn("lens", map + chain + Transform("odom", "camera", "0, 7, 0") +
                                     Transform("camera", "lens", "0, 0, 3"))),
             1, 0, 3);
    EXPECT_THAT(ParseProblem(BallIn("map", map + chain), kBallRequest).warnings,
                ElementsAre(HasSubstr("link 'base_link' in the frame 'odom', which places the "
                                      "robot in the planning frame 'map'")));
  }
  const std::string turned =
      Transform("map", "odom", "5, 0, 0", kQuarter) + Transform("odom", "base_link", "0, 7, 0");
  ExpectAt(Ball(BallIn("map", map + turned)), 0, -3, 0);  // The base is at (-2, 0, 0), turned.
  // Where the robot's state joins the chain.
  const std::string joint = "robot_state:\n" + RootAt("odom", "0, 7, 0");
  ExpectAt(Ball(BallIn("map", joint + map + Transform("map", "odom", "0, 0, 3"))), 1, -7, -3);
  // From a link below the planning frame.
  ExpectAt(Ball(BallIn("lens", kTransforms + Transform("base_link", "base_link", "0, 0, 0") +
                                   Transform("base_link", "camera", "0, 2, 0") +
                                   Transform("lens", "camera", "0, 0, 3"))),
           1, 2, 3);
}

// A table above the ball.
std::string WithTable(const std::string& scene) {
  return Replaced(scene, "    - id: ball",
                  "    - id: table\n      header: {frame_id: base_link}\n"
                  "      pose: {position: [0, 0, 1], orientation: [0, 0, 0, 1]}\n"
                  "      primitives: [{type: box, dimensions: [1, 1, 1]}]\n"
                  "      primitive_poses: [{position: [0, 0, 9], orientation: [0, 0, 0, 1]}]\n"
                  "      subframe_names: [edge]\n"
                  "      subframe_poses: [{position: [0, 2, 0], orientation: [0, 0, 0, 1]}]\n"
                  "    - id: ball");
}

TEST(Frames, OfObjectsAndTheirSubframes) {
  const auto with_table = [&](const std::string& frame) { return WithTable(BallIn(frame)); };
  const auto place = [&](const std::string& scene) {
    return PlaceOf(ParseProblem(scene, kBallRequest).scene.objects.at(1));
  };
  ExpectAt(place(with_table("table")), 1, 0, 1);
  ExpectAt(place(with_table("/table")), 1, 0, 1);
  ExpectAt(place(with_table("table/edge")), 1, 2, 1);
  // An object without a pose and with one shape has the frame of the shape.
  ExpectAt(place(Replaced(with_table("table"),
                          "      pose: {position: [0, 0, 1], orientation: [0, 0, 0, 1]}\n", "")),
           1, 0, 9);
  ExpectInputError([&] { place(with_table("table/leg")); }, {"unknown frame 'table/leg'"});
}

TEST(Frames, OfObjectsHaveNamesOfTheirOwn) {
  const std::string scene = WithTable(BallIn("base_link"));
  const auto refuse = [&](const std::string& from, const std::string& to, const std::string& field,
                          const std::string& says) {
    ExpectInputError([&] { Ball(Replaced(scene, from, to)); },
                     {"scene.yaml:", ": world.collision_objects" + field + ": ", says});
  };
  const std::string one_pose = "subframe_poses: [{position: [0, 2, 0], ";
  const std::string two_poses =
      std::string("subframe_poses: [{position: [0, 3, 0], orientation: [0, 0, 0, 1]}, ") +
      "{position: [0, 2, 0], ";
  const std::string between = "\n      ";
  refuse("[edge]" + between + one_pose, "[edge, edge]" + between + two_poses,
         "[0].subframe_names[1]", "the object 'table' has a frame 'table/edge' already");
  refuse("[edge]", "['']", "[0].subframe_names[0]", "must not be empty");
  refuse("id: ball", "id: table/edge", "[1].id",
         "the object 'table' has a frame 'table/edge' already");
  refuse("    - id: table\n",
         "    - {id: table/edge, primitives: [{type: sphere, dimensions: [1]}], primitive_poses: "
         "[{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]}\n    - id: table\n",
         "[1].subframe_names[0]", "the object 'table/edge' has a frame 'table/edge' already");
}

TEST(Frames, OfObjectsWhoseNamesBeginWithASlash) {
  const auto ball = [](const std::string& frame) {
    return PlaceOf(
        ParseProblem(Replaced(WithTable(BallIn(frame)), "id: table", "id: /table"), kBallRequest)
            .scene.objects.at(1));
  };
  for (const char* frame : {"table", "/table"}) ExpectAt(ball(frame), 1, 0, 1);
  for (const char* frame : {"table/edge", "/table/edge"}) ExpectAt(ball(frame), 1, 2, 1);

  // Of two that differ in it alone nobody could say which a frame means.
  const std::string two = Replaced(WithTable(BallIn("base_link")), "id: ball", "id: /table");
  ExpectInputError([&] { Ball(two); }, {"scene.yaml:", ": world.collision_objects[1].id: ",
                                        "the object 'table' has a frame 'table' already"});
  const std::string attached =
      Replaced(kBallRequest, "start_state: {",
               "start_state: {attached_collision_objects: [{link_name: gripper_link, object: {id: "
               "/table, primitives: [{type: sphere, dimensions: [0.1]}], primitive_poses: "
               "[{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]}}], ");
  ExpectInputError([&] { Ball(WithTable(BallIn("base_link")), attached); },
                   {"request.yaml:", "object.id: ", "'table' has a frame 'table' already"});
}

TEST(Frames, OfObjectsComeBeforeFixedOnesOfTheirName) {
  const std::string fixed = kTransforms + Transform("table", "base_link", "0, 0, 5");
  const std::string scene = Replaced(WithTable(BallIn("table", fixed)),
                                     "header: {frame_id: base_link}", "header: {frame_id: table}");
  ExpectAt(PlaceOf(ParseProblem(scene, kBallRequest).scene.objects.at(1)), 1, 0, 6);
}

TEST(Frames, ThatMoveItHasElsewhereAreNamedWhereTheyArePutIfTheyAreUsed) {
  const auto with_pose = [](const std::string& frame, const std::string& orientation) {
    return ParseProblem(
        Replaced(WithTable(BallIn(frame)), "{position: [0, 0, 1], orientation: [0, 0, 0, 1]}",
                 "{position: [0, 0, 0], orientation: " + orientation + "}"),
        kBallRequest);
  };
  for (const char* frame : {"table", "table/edge"}) {
    EXPECT_THAT(with_pose(frame, "{x: 0, y: 0, z: 0, w: 1}").warnings,
                ElementsAre(HasSubstr(
                    "scene.yaml:6: world.collision_objects[0].pose: puts the frame of the "
                    "object 'table', which others are in")));
    EXPECT_THAT(with_pose(frame, "[0, 0, 0, 0]").warnings, IsEmpty()) << "none for MoveIt, too";
    EXPECT_THAT(with_pose(frame, "[0, 0, 0.6, 0.8]").warnings, IsEmpty());
  }
  EXPECT_THAT(with_pose("base_link", "[0, 0, 0, 1]").warnings, IsEmpty());
  const std::string used_twice =
      Replaced(Replaced(WithTable(BallIn("table")), "position: [0, 0, 1]", "position: [0, 0, 0]"),
               "    - id: ball",
               "    - {id: can, header: {frame_id: table/edge}, primitives: [{type: sphere, "
               "dimensions: [1]}], primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, "
               "1]}]}\n    - id: ball");
  EXPECT_EQ(ParseProblem(used_twice, kBallRequest).warnings.size(), 1u);
  ExpectAt(PlaceOf(with_pose("table", "[0, 0, 0, 1]").scene.objects.at(1)), 1, 0, 0);
}

TEST(Frames, UnknownOnesAreRefusedWithTheirFileAndLine) {
  ExpectInputError([] { Ball(BallIn("lamp")); },
                   {"scene.yaml:5: world.collision_objects[0].header.frame_id: unknown frame "
                    "'lamp'"});
  ExpectInputError([] { Ball(BallIn("griper_link")); }, {"did you mean 'gripper_link'?"});
  // Known to each other, but not to the robot.
  ExpectInputError(
      [] {
        Ball(BallIn("camera", "robot_state: {joint_state: {header: {frame_id: base_link}}}\n" +
                                  (kTransforms + Transform("camera", "map", "0, 0, 3"))));
      },
      {"unknown frame 'camera'"});
  // Most objects being in it does not make a frame known.
  ExpectInputError(
      [] {
        Ball(BallIn("camera", "robot_state: {joint_state: {header: {frame_id: base_link}}}\n"));
      },
      {"unknown frame 'camera'"});
}

// The pedestal: the root is called world, the arm's base stands on it.
TEST(Frames, OfARobotOnAPedestal) {
  constexpr const char* kUrdf = R"(<robot name="fetch">
  <link name="world"/><link name="base_link"/><link name="arm"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base_link"/>
    <origin xyz="0 0 0.8"/></joint>
  <joint name="turn" type="continuous"><parent link="base_link"/><child link="arm"/></joint>
</robot>)";
  Robot robot;
  robot.model = RobotModel::FromUrdf(kUrdf, "pedestal.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"turn"}, "arm")};
  const auto ball = [&](const std::string& scene) {
    const Problem problem =
        ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                     YamlNode::Parse("start_state: {joint_state: {name: [turn], position: [0]}}\n"
                                     "goal_constraints: [{joint_constraints: "
                                     "[{joint_name: turn, position: 1}]}]\n",
                                     "request.yaml"),
                     robot, {});
    EXPECT_EQ(problem.scene.world_frame, "world");
    return PlaceOf(problem.scene.objects.at(0));
  };
  ExpectAt(ball(BallIn("base_link")), 1, 0, 0.8);
  ExpectAt(ball(BallIn("world")), 1, 0, 0);
  ExpectAt(ball(BallIn("")), 1, 0, 0);
  // A file made with the arm alone: its planning frame is the arm's base.
  ExpectAt(ball(BallIn("", kTransforms + Transform("base_link", "base_link", "0, 0, 0"))), 1, 0,
           0.8);
  ExpectAt(ball(BallIn("base_link", kTransforms + Transform("world", "world", "0, 0, 0"))), 1, 0,
           0.8);
}

TEST(Frames, FixedOnesComeOutInTheBaseFrame) {
  const Scene scene =
      ParseProblem(BallIn("base_link", kTransforms + Transform("camera", "base_link", "0, 2, 0") +
                                           Transform("lens", "camera", "0, 0, 1") +
                                           Transform("lost", "found", "0, 0, 1")),
                   kBallRequest)
          .scene;
  std::vector<std::string> names;
  for (const FrameTransform& frame : scene.fixed_frames) names.push_back(frame.frame);
  EXPECT_THAT(names, ElementsAre("camera", "lens"));
  ExpectAt(scene.fixed_frames[1].X_WF.translation(), 0, 2, 1);
}

}  // namespace
}  // namespace planbench
