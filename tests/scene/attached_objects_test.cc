#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "common/error.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// The gripper is at (1, 0, 2) at the start.
constexpr const char* kToolRequest = R"(
start_state:
  joint_state: {name: [a_joint, b_joint], position: [0, 2]}
  attached_collision_objects: []
goal_constraints:
  - joint_constraints: [{joint_name: a_joint, position: 1}, {joint_name: b_joint, position: 0}]
)";

constexpr const char* kWorld = R"(robot_model_name: fetch
robot_state:
  attached_collision_objects: []
world:
  collision_objects:
    - id: tool
      header: {frame_id: base_link}
      pose: {position: [1.25, 0, 2], orientation: [0, 0, 0, 1]}
      primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]
      primitive_poses: [{position: [0, 0, 0.5], orientation: [0, 0, 0, 1]}]
    - id: wall
      header: {frame_id: base_link}
      primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]
      primitive_poses: [{position: [0, 5, 0], orientation: [0, 0, 0, 1]}]
)";

// The same without the tool.
std::string WorldWithoutTool() { return Replaced(kWorld, "id: tool", "id: can"); }

std::string Attaching(const std::string& text, const std::string& object,
                      const std::string& link = "gripper_link") {
  return Replaced(text, "attached_collision_objects: []",
                  "attached_collision_objects: [{link_name: " + link + ", object: {" + object +
                      "}, touch_links: [/l_finger]}]");
}

const char* const kTool =
    "id: tool, header: {frame_id: gripper_link}, primitives: [{type: sphere, dimensions: [0.2]}], "
    "primitive_poses: [{position: [0.25, 0, 0.5], orientation: [0, 0, 0, 1]}]";

Vector3d PlaceInLink(const AttachedObject& attached) {
  return attached.object.X_WO * attached.object.shapes.front().X_FS.translation();
}

TEST(AttachedObjects, ByIdLeaveTheWorldWhereTheyAre) {
  for (const bool in_request : {false, true}) {
    for (const char* object : {"id: tool", "id: tool, operation: 0",
                               "id: tool, primitives: [], meshes: [], planes: []"}) {
      const Scene scene = in_request ? ParseProblem(kWorld, Attaching(kToolRequest, object)).scene
                                     : ParseProblem(Attaching(kWorld, object), kToolRequest).scene;
      ASSERT_EQ(scene.objects.size(), 1u);
      EXPECT_EQ(scene.objects[0].id, "wall");
      ASSERT_EQ(scene.attached.size(), 1u);
      EXPECT_EQ(scene.attached[0].link, "gripper_link");
      EXPECT_EQ(PlaceInLink(scene.attached[0]), Vector3d(0.25, 0, 0.5));
      EXPECT_THAT(scene.attached[0].touch_links, ElementsAre("l_finger"));
    }
  }
}

TEST(AttachedObjects, WithShapesTakeTheIdOutOfTheWorld) {
  for (const bool in_request : {false, true}) {
    const Scene scene = in_request ? ParseProblem(kWorld, Attaching(kToolRequest, kTool)).scene
                                   : ParseProblem(Attaching(kWorld, kTool), kToolRequest).scene;
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].id, "wall");
    ASSERT_EQ(scene.attached.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Sphere>(scene.attached[0].object.shapes[0].shape));
  }
}

TEST(AttachedObjects, WithShapesThatTakeTheIdOutOfTheWorldAreNamed) {
  const auto told = [](const std::string& where) {
    return ElementsAre(where +
                       ": the world's object 'tool' is left out: one of that id is "
                       "attached to the link 'gripper_link', with shapes of its own");
  };
  EXPECT_THAT(ParseProblem(Attaching(kWorld, kTool), kToolRequest).warnings,
              told("scene.yaml:6: world.collision_objects[0].id"));
  const std::string on_wall = Replaced(kTool, "frame_id: gripper_link", "frame_id: wall");
  EXPECT_THAT(ParseProblem(Attaching(kWorld, on_wall), kToolRequest).warnings,
              told("scene.yaml:3: robot_state.attached_collision_objects[0].object.id"));
  EXPECT_THAT(ParseProblem(kWorld, Attaching(kToolRequest, kTool)).warnings,
              told("request.yaml:4: start_state.attached_collision_objects[0].object.id"));
  EXPECT_THAT(ParseProblem(Attaching(kWorld, "id: tool"), kToolRequest).warnings, IsEmpty());
}

TEST(AttachedObjects, OfTheRequestTakeThePlaceOfTheScenes) {
  const std::string scene = Attaching(WorldWithoutTool(), kTool);
  const auto attached = [&](const std::string& object) {
    const Problem problem = ParseProblem(scene, Attaching(kToolRequest, object));
    EXPECT_THAT(problem.warnings, IsEmpty());
    return problem.scene.attached;
  };
  EXPECT_EQ(attached(kTool).size(), 1u);
  EXPECT_EQ(attached(Replaced(kTool, "tool", "other")).size(), 2u);
  const std::vector<AttachedObject> larger = attached(Replaced(kTool, "[0.2]", "[0.3]"));
  ASSERT_EQ(larger.size(), 1u);
  EXPECT_EQ(std::get<Sphere>(larger[0].object.shapes.at(0).shape).radius, 0.3);
}

TEST(AttachedObjects, ByIdMayBeAttachedAlready) {
  const std::string scene = Attaching(kWorld, kTool);
  const auto attached = [&](const std::string& request) {
    const std::vector<AttachedObject> all = ParseProblem(scene, request).scene.attached;
    EXPECT_EQ(all.size(), 1u);
    return all.at(0);
  };
  const std::string by_id = Attaching(kToolRequest, "id: tool");
  EXPECT_EQ(PlaceInLink(attached(by_id)), Vector3d(0.25, 0, 0.5));
  EXPECT_THAT(attached(by_id).touch_links, ElementsAre("l_finger"));
  EXPECT_THAT(attached(Replaced(by_id, "[/l_finger]", "[]")).touch_links, ElementsAre("l_finger"));
  EXPECT_THAT(attached(Replaced(by_id, "/l_finger", "r_finger")).touch_links,
              ElementsAre("r_finger"));
  const AttachedObject at_base = attached(Attaching(kToolRequest, "id: tool", "base_link"));
  EXPECT_EQ(at_base.link, "base_link");
  EXPECT_TRUE(PlaceInLink(at_base).isApprox(Vector3d(1.25, 0, 2.5), 1e-12));
}

TEST(AttachedObjects, OfAWholeStartStateAreAllThereAre) {
  const std::string scene = Attaching(WorldWithoutTool(), kTool);
  const auto with_flag = [](const std::string& flag, const std::string& request) {
    return Replaced(request, "start_state:", "start_state:\n  is_diff: " + flag);
  };
  const Problem whole = ParseProblem(scene, with_flag("False", kToolRequest));
  EXPECT_THAT(whole.scene.attached, IsEmpty());
  EXPECT_THAT(whole.warnings, ElementsAre(AllOf(HasSubstr("request.yaml:3: start_state.is_diff"),
                                                HasSubstr("'tool'"), HasSubstr("left out"))));
  const std::string named = with_flag("False", Attaching(kToolRequest, "id: tool"));
  EXPECT_EQ(ParseProblem(scene, named).scene.attached.size(), 1u);
  const Problem difference = ParseProblem(scene, with_flag("True", kToolRequest));
  EXPECT_EQ(difference.scene.attached.size(), 1u);
  EXPECT_THAT(difference.warnings, IsEmpty());
  // Without joints it is no state.
  const std::string empty =
      Replaced(Replaced(kToolRequest, "[a_joint, b_joint]", "[]"), "[0, 2]", "[]");
  const std::string with_start = Replaced(
      scene,
      "robot_state:", "robot_state:\n  joint_state: {name: [a_joint, b_joint], position: [0, 2]}");
  EXPECT_EQ(ParseProblem(with_start, with_flag("False", empty)).scene.attached.size(), 1u);
  ExpectInputError([&] { ParseProblem(scene, with_flag("2", kToolRequest)); },
                   {"request.yaml:3: start_state.is_diff"});
}

TEST(AttachedObjects, GivenTwiceAreWhatTheLastSays) {
  const std::string one = "{link_name: gripper_link, object: {" + std::string(kTool) + "}}";
  const Problem problem =
      ParseProblem(Replaced(WorldWithoutTool(), "attached_collision_objects: []",
                            "attached_collision_objects: [" + one + ", " +
                                Replaced(one, "[0.2]", "[0.3]") + "]"),
                   kToolRequest);
  ASSERT_EQ(problem.scene.attached.size(), 1u);
  EXPECT_EQ(std::get<Sphere>(problem.scene.attached[0].object.shapes.at(0).shape).radius, 0.3);
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("'tool' is attached twice")));
}

TEST(AttachedObjects, GivenTwiceAreWhatTheLastSaysWhateverNeedsTheWorld) {
  const std::string one = "{link_name: gripper_link, object: {" + std::string(kTool) + "}}";
  const std::string on_wall = Replaced(one, "frame_id: gripper_link", "frame_id: wall");
  const Problem problem = ParseProblem(Replaced(kWorld, "attached_collision_objects: []",
                                                "attached_collision_objects: [" + on_wall + ", " +
                                                    Replaced(one, "[0.2]", "[0.3]") + "]"),
                                       kToolRequest);
  ASSERT_EQ(problem.scene.attached.size(), 1u);
  EXPECT_EQ(std::get<Sphere>(problem.scene.attached[0].object.shapes.at(0).shape).radius, 0.3);
}

// As in MoveIt, whose robot state comes before the world.
TEST(AttachedObjects, HaveFramesForObjectsOfTheWorld) {
  const std::string in_tool = Replaced(kWorld, "id: wall\n      header: {frame_id: base_link}",
                                       "id: wall\n      header: {frame_id: tool}");
  const auto wall = [](const std::string& scene) -> Vector3d {
    const SceneObject object = ParseProblem(scene, kToolRequest).scene.objects.back();
    EXPECT_EQ(object.id, "wall");
    return object.X_WO * object.shapes.front().X_FS.translation();
  };
  EXPECT_TRUE(wall(Attaching(in_tool, kTool)).isApprox(Vector3d(1.25, 5, 2.5), 1e-12));
  EXPECT_TRUE(wall(Attaching(in_tool, "id: tool")).isApprox(Vector3d(1.25, 5, 2), 1e-12));
  const std::string pen = Replaced(kTool, "id: tool", "id: pen");
  const std::string in_pen = Replaced(in_tool, "frame_id: tool", "frame_id: pen");
  EXPECT_TRUE(wall(Attaching(in_pen, pen)).isApprox(Vector3d(1.25, 5, 2.5), 1e-12));
}

TEST(AttachedObjects, ByIdStayWhereTheyAreWhateverPoseIsGiven) {
  const Problem problem = ParseProblem(
      Attaching(kWorld, "id: tool, pose: {position: [1, 1, 1], orientation: [0, 0, 0, 1]}"),
      kToolRequest);
  EXPECT_EQ(PlaceInLink(problem.scene.attached.at(0)), Vector3d(0.25, 0, 0.5));
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("object.pose: does not count")));
}

TEST(AttachedObjects, MayBeGivenInAnyFrame) {
  const auto place = [](const std::string& frame) {
    const Problem problem = ParseProblem(
        Attaching(kWorld, Replaced(kTool, "frame_id: gripper_link", "frame_id: " + frame)),
        kToolRequest);
    return PlaceInLink(problem.scene.attached.at(0));
  };
  EXPECT_EQ(place("gripper_link"), Vector3d(0.25, 0, 0.5));
  EXPECT_EQ(place("/gripper_link"), Vector3d(0.25, 0, 0.5));
  EXPECT_TRUE(place("base_link").isApprox(Vector3d(-0.75, 0, -1.5), 1e-12));
  EXPECT_TRUE(place("mast").isApprox(Vector3d(-0.75, 0, -1.5), 1e-12));
  EXPECT_TRUE(place("wall").isApprox(Vector3d(-0.75, 5, -1.5), 1e-12));
}

// The gripper is at (1, 0, 2) at the start, at (1, 0, 0) in the scene.
std::string Lowered(const std::string& scene) {
  return Replaced(scene, "robot_state:\n",
                  "robot_state:\n  joint_state: {name: [b_joint], position: [0]}\n");
}

TEST(AttachedObjects, OfTheSceneHangWhereItsOwnStateHasThem) {
  const auto place = [](const std::string& scene, const std::string& request) {
    return PlaceInLink(ParseProblem(scene, request).scene.attached.at(0));
  };
  const std::string scene = Lowered(kWorld);
  EXPECT_EQ(place(Attaching(scene, "id: tool"), kToolRequest), Vector3d(0.25, 0, 2.5));
  EXPECT_EQ(place(scene, Attaching(kToolRequest, "id: tool")), Vector3d(0.25, 0, 0.5));
  const std::string of_base = Replaced(kTool, "frame_id: gripper_link", "frame_id: base_link");
  EXPECT_EQ(place(Attaching(scene, of_base), kToolRequest), Vector3d(-0.75, 0, 0.5));
  EXPECT_EQ(place(scene, Attaching(kToolRequest, of_base)), Vector3d(-0.75, 0, -1.5));
  // It has moved with the gripper when the request attaches it to the base.
  EXPECT_EQ(place(Attaching(scene, "id: tool"), Attaching(kToolRequest, "id: tool", "base_link")),
            Vector3d(1.25, 0, 4.5));
}

// Frames of the request are those at the start: what is attached has moved there with its link.
TEST(AttachedObjects, CarryTheirFramesToTheStart) {
  const auto height = [](const std::string& scene, const std::string& request,
                         const std::string& frame) {
    const std::string goal =
        "goal_constraints:\n  - position_constraints:\n      - {link_name: gripper_link, header: "
        "{frame_id: " +
        frame +
        "}, constraint_region: {primitives: [{type: sphere, dimensions: "
        "[1e-6]}], primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]}}\n";
    const Problem problem =
        ParseProblem(scene, request.substr(0, request.find("goal_constraints")) + goal);
    return problem.goal.at(1).position;
  };
  const std::string tool =
      "id: tool, header: {frame_id: gripper_link}, pose: {position: [0, 0, 1], orientation: "
      "[0, 0, 0, 1]}, primitives: [{type: sphere, dimensions: [0.2]}], subframe_names: [end], "
      "subframe_poses: [{position: [0, 0, 2], orientation: [0, 0, 0, 1]}]";
  const std::string scene = Lowered(kWorld);
  EXPECT_NEAR(height(Attaching(scene, tool), kToolRequest, "tool"), 3, 1e-4);
  EXPECT_NEAR(height(Attaching(scene, tool), kToolRequest, "tool/end"), 5, 1e-4);
  // By its id, from where the world has it.
  const std::string near = Replaced(scene, "[1.25, 0, 2]", "[1, 0, 0.5]");
  EXPECT_NEAR(height(Attaching(near, "id: tool"), kToolRequest, "tool"), 2.5, 1e-4);
  EXPECT_NEAR(height(near, Attaching(kToolRequest, "id: tool"), "tool"), 0.5, 1e-4);
  // What replaces it has its own frames alone, and what is left out none.
  ExpectInputError(
      [&] {
        height(Attaching(scene, tool), Attaching(kToolRequest, Replaced(tool, "[end]", "[tip]")),
               "tool/end");
      },
      {"unknown frame 'tool/end'"});
  ExpectInputError(
      [&] {
        height(Attaching(scene, tool),
               Replaced(kToolRequest, "start_state:", "start_state:\n  is_diff: false"), "tool");
      },
      {"unknown frame 'tool'"});
}

TEST(AttachedObjects, MayBeWhatAGoalIsOf) {
  const std::string scene = Attaching(
      kWorld,
      "id: pen, header: {frame_id: gripper_link}, pose: {position: [0, 0, 1], orientation: [0, 0, "
      "0, 1]}, primitives: [{type: sphere, dimensions: [0.2]}], subframe_names: [end], "
      "subframe_poses: [{position: [0, 0, 2], orientation: [0, 0, 0.7071067811865476, "
      "0.7071067811865476]}]");
  const std::string start =
      std::string(kToolRequest).substr(0, std::string(kToolRequest).find("goal_constraints")) +
      "goal_constraints:\n  - ";
  const auto goal = [&](const std::string& link, const std::string& constraint) {
    return ParseProblem(scene, start + "{" + Replaced(constraint, "LINK", link) + "}\n").goal;
  };
  const std::string at_five =
      "position_constraints: [{link_name: LINK, constraint_region: {primitives: [{type: sphere, "
      "dimensions: [1e-6]}], primitive_poses: [{position: [1, 0, 5], orientation: [0, 0, 0, "
      "1]}]}}]";
  EXPECT_NEAR(goal("gripper_link", at_five).at(1).position, 5, 1e-4);
  EXPECT_NEAR(goal("pen", at_five).at(1).position, 4, 1e-4);
  EXPECT_NEAR(goal("/pen/end", at_five).at(1).position, 2, 1e-4);
  const std::string level =
      "orientation_constraints: [{link_name: LINK, orientation: [0, 0, 0, 1]}]";
  EXPECT_NEAR(goal("pen", level).at(0).position, 0, 1e-4);
  EXPECT_NEAR(goal("pen/end", level).at(0).position, -std::numbers::pi / 2, 1e-4);
  ExpectInputError([&] { goal("wall", at_five); },
                   {"request.yaml:6: goal_constraints[0].position_constraints[0].link_name: 'wall' "
                    "is a frame of an object that is not attached"});
  ExpectInputError([&] { goal("pen/tip", at_five); }, {"no link 'pen/tip', nor is an object"});
}

TEST(AttachedObjects, HaveASetOfTouchLinks) {
  const auto touch_links = [](const std::string& links) {
    const std::string scene = Replaced(Attaching(kWorld, kTool), "[/l_finger]", "[" + links + "]");
    return ParseProblem(scene, kToolRequest).scene.attached.at(0).touch_links;
  };
  EXPECT_THAT(touch_links("r_finger, l_finger, r_finger, /l_finger"),
              ElementsAre("r_finger", "l_finger"));
  for (const char* empty : {"''", "/"}) {
    ExpectInputError([&] { touch_links(std::string("l_finger, ") + empty); },
                     {"scene.yaml:3: robot_state.attached_collision_objects[0].touch_links[1]: "
                      "must not be empty"});
  }
}

TEST(AttachedObjects, TouchLinksThatAreNoneAreNamed) {
  const auto warnings = [](const std::string& link) {
    const std::string scene = Replaced(Attaching(WorldWithoutTool(), kTool), "/l_finger", link);
    return ParseProblem(scene, kToolRequest).warnings;
  };
  EXPECT_THAT(warnings("mast"), IsEmpty());
  const std::string where =
      "scene.yaml:3: robot_state.attached_collision_objects[0].touch_links[0]: ";
  EXPECT_THAT(warnings("Mast"), ElementsAre(HasSubstr(where + "the robot 'fetch' has no link "
                                                              "'Mast'; did you mean 'mast'?")));
  EXPECT_THAT(warnings("wall"), ElementsAre(AllOf(HasSubstr(where + "the robot 'fetch' has no link "
                                                                    "'wall'; touch links"),
                                                  HasSubstr("objects may touch by the matrix"))));
  EXPECT_THAT(warnings("arm"),
              ElementsAre(HasSubstr(where + "'arm' is a planning group, no link")));
}

TEST(AttachedObjects, WithoutAFrameAreInThePlanningFrameWithAWarning) {
  // The planning frame `map`, one above the robot, has the gripper at (1, 0, 1).
  const std::string world = std::string(kWorld) +
                            "fixed_frame_transforms:\n  - {header: {frame_id: map}, "
                            "child_frame_id: map, transform: {translation: [0, 0, 0], rotation: "
                            "[0, 0, 0, 1]}}\n  - {header: {frame_id: map}, child_frame_id: "
                            "base_link, transform: {translation: [0, 0, -1], rotation: [0, 0, 0, "
                            "1]}}\n";
  for (const char* header : {"", "header: {frame_id: ''}, "}) {
    const std::string tool = Replaced(kTool, "header: {frame_id: gripper_link}, ", header);
    for (const bool in_request : {false, true}) {
      const Problem problem = in_request ? ParseProblem(world, Attaching(kToolRequest, tool))
                                         : ParseProblem(Attaching(world, tool), kToolRequest);
      EXPECT_TRUE(PlaceInLink(problem.scene.attached.at(0)).isApprox(Vector3d(-0.75, 0, -0.5)));
      EXPECT_THAT(problem.warnings, Contains(HasSubstr("taken in the planning frame")));
    }
  }
}

TEST(AttachedObjects, NeedAShapeAndALink) {
  ExpectInputError([] { ParseProblem(Attaching(kWorld, "id: pen"), kToolRequest); },
                   {"scene.yaml:3: robot_state.attached_collision_objects[0].object.id",
                    "'pen' has no shape, and the world has none of that id"});
  ExpectInputError([] { ParseProblem(Attaching(kWorld, "id: tool", "hand"), kToolRequest); },
                   {"attached_collision_objects[0].link_name", "no link 'hand'"});
  ExpectInputError([] { ParseProblem(Attaching(kWorld, "id: tool, operation: 1"), kToolRequest); },
                   {"only the operation ADD"});
  const std::string plane =
      Replaced(kWorld,
               "primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]\n      primitive_poses: "
               "[{position: [0, 0, 0.5]",
               "planes: [{coef: [0, 0, 1, 0]}]\n      plane_poses: [{position: [0, 0, 0.5]");
  ExpectInputError([&] { ParseProblem(Attaching(plane, "id: tool"), kToolRequest); },
                   {"a plane cannot be attached"});
}

TEST(Names, OfTheOctomapIsForNoObject) {
  const auto refuse = [](const std::string& scene, const std::string& request,
                         const std::string& where) {
    ExpectInputError([&] { ParseProblem(scene, request); },
                     {where, "the name '<octomap>' is that of world.octomap alone"});
  };
  refuse(Replaced(kWorld, "id: wall", "id: <octomap>"), kToolRequest,
         "scene.yaml:11: world.collision_objects[1].id");
  for (const std::string& object :
       {std::string("id: <octomap>"), Replaced(kTool, "tool", "<octomap>")}) {
    refuse(Attaching(kWorld, object), kToolRequest,
           "scene.yaml:3: robot_state.attached_collision_objects[0].object.id");
    refuse(kWorld, Attaching(kToolRequest, object),
           "request.yaml:4: start_state.attached_collision_objects[0].object.id");
  }
}

// The link `mast` has a body, by spheres; `gripper_link` has none.
Problem WithBody(const std::string& scene) {
  Robot robot = TextRobot();
  robot.spheres.push_back({robot.model.FindLink("mast"), Vector3d(0, 0, 0), 0.1});
  return ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                      YamlNode::Parse(kToolRequest, "request.yaml"), robot, {});
}

TEST(Names, OfLinksAreNotForObjects) {
  EXPECT_NO_THROW(WithBody(kWorld));
  ExpectInputError([] { WithBody(Replaced(kWorld, "id: wall", "id: mast")); },
                   {"scene.yaml:11: world.collision_objects[1].id", "name of a link, 'mast'"});
  ExpectInputError([] { WithBody(Attaching(kWorld, Replaced(kTool, "tool", "mast"))); },
                   {"attached_collision_objects[0].object.id", "name of a link, 'mast'"});
}

TEST(Names, OfLinksWithoutABodyAreButNotWhatTheMatrixAllowsThem) {
  const std::string scene = Replaced(kWorld, "id: wall", "id: gripper_link");
  EXPECT_NO_THROW(WithBody(scene));
  EXPECT_NO_THROW(WithBody(scene + "allowed_collision_matrix: {entry_names: [mast, gripper_link], "
                                   "entry_values: [[false, false], [false, false]]}\n"));
  for (const char* matrix :
       {"{entry_names: [mast, gripper_link], "
        "entry_values: [[false, true], [true, false]]}",
        "{default_entry_names: [gripper_link], default_entry_values: [true]}"}) {
    ExpectInputError(
        [&] { WithBody(scene + "allowed_collision_matrix: " + matrix + "\n"); },
        {"scene.yaml:15: allowed_collision_matrix", "'gripper_link'", "a link and of an object"});
  }
}

}  // namespace
}  // namespace planbench
