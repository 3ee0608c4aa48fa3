#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/moveit_messages.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Unknown {
  const char* name;
  bool in_scene;
  const char* from;
  const char* to;
  const char* field;  // Its place and name.
  const char* hint;
};

void PrintTo(const Unknown& unknown, std::ostream* out) { *out << unknown.name; }

class UnknownField : public testing::TestWithParam<Unknown> {};

TEST_P(UnknownField, IsRefusedWithTheNearestOrItsPlace) {
  const Unknown& unknown = GetParam();
  std::string scene = kFullScene;
  std::string request = kFullRequest;
  std::string& changed = unknown.in_scene ? scene : request;
  changed = Replaced(changed, unknown.from, unknown.to);
  ExpectInputError([&] { ParseProblem(scene, request); },
                   {unknown.in_scene ? "scene.yaml:" : "request.yaml:",
                    std::string(": ") + unknown.field + ": unknown field", unknown.hint});
}

INSTANTIATE_TEST_SUITE_P(
    EveryLevel, UnknownField,
    testing::Values(
        Unknown{"Misplaced", true, "world:\n  collision_objects:", "collision_objects:",
                "collision_objects", "its place is world.collision_objects"},
        Unknown{"Misspelt", true, "world:\n  collision_objects:", "world:\n  colision_objects:",
                "world.colision_objects", "did you mean 'collision_objects'?"},
        Unknown{"MisspeltWorld", true, "world:\n", "World:\n", "World", "did you mean 'world'?"},
        Unknown{"CamelCase", true, "world:\n  collision_objects:", "world:\n  collisionObjects:",
                "world.collisionObjects", "did you mean 'collision_objects'?"},
        Unknown{"AttachedAtTheTop", true, "robot_state:\n",
                "attached_collision_objects: []\n"
                "robot_state:\n",
                "attached_collision_objects",
                "its place is robot_state.attached_collision_objects"},
        Unknown{"AttachedInTheWorld", true, "world:\n",
                "world:\n  attached_collision_objects: []\n", "world.attached_collision_objects",
                "its place is robot_state.attached_collision_objects"},
        Unknown{"OctomapAtTheTop", true, "name: kitchen", "octomap: {octomap: {data: [1]}}",
                "octomap", "its place is world.octomap"},
        Unknown{"OctomapWithoutPose", true, "world:\n", "world:\n  octomap: {data: [1, 2]}\n",
                "world.octomap.data", "its place there is octomap.data"},
        Unknown{"FrameOutsideTheHeader", true, "      operation: 0\n",
                "      frame_id: base_link\n", "world.collision_objects[0].frame_id",
                "its place there is header.frame_id"},
        Unknown{"AnIdForAField", true, "world:\n  collision_objects:",
                "world:\n  collision_objects: {b: {}}\nx-objects:\n  collision_objects:",
                "world.collision_objects.b", "field 'b' of moveit_msgs/CollisionObject"},
        Unknown{"OneLetter", true, "position: [1, 0, 0.5]", "position: {x: 1, y: 0, z: 0, w: 1}",
                "world.collision_objects[0].pose.position.w", "Vector3; known are: x, y, z"},
        Unknown{"OfAnObject", true, "operation: 0", "operations: 0",
                "world.collision_objects[0].operations", "did you mean 'operation'?"},
        Unknown{"OfAShape", true, "{type: sphere, dimensions: [0.05]}",
                "{type: sphere, dimension: [0.05]}",
                "world.collision_objects[0].primitives[1].dimension", "did you mean 'dimensions'?"},
        Unknown{"OfAPose", true, "pose: {position: [1, 0, 0.5],", "pose: {postion: [1, 0, 0.5],",
                "world.collision_objects[0].pose.postion", "did you mean 'position'?"},
        Unknown{"OfAVector", true, "position: [1, 0, 0.5]", "position: {x: 1, y: 0, zz: 0.5, z: 0}",
                "world.collision_objects[0].pose.position.zz", "known are: x, y, z"},
        Unknown{"OfAMesh", true, "- vertices:", "- scales: 2\n          vertices:",
                "world.collision_objects[2].meshes[0].scales", "did you mean 'scale'?"},
        Unknown{"OfAHeader", true, "header: {frame_id: camera}", "header: {frame: camera}",
                "world.collision_objects[1].header.frame", "did you mean 'frame_id'?"},
        Unknown{"OfAStamp", true, "header: {frame_id: camera}",
                "header: {frame_id: camera, stamp: {seconds: 1}}",
                "world.collision_objects[1].header.stamp.seconds", "did you mean 'sec'?"},
        Unknown{"OfTheState", true, "    name: [a_joint, b_joint]", "    names: [a_joint, b_joint]",
                "robot_state.joint_state.names", "did you mean 'name'?"},
        Unknown{"OfAnAttachedObject", true, "- link_name: gripper_link", "- link: gripper_link",
                "robot_state.attached_collision_objects[0].link", "did you mean 'link_name'?"},
        Unknown{"OfWhatIsAttached", true, "        id: tool\n",
                "        id: tool\n        ids: x\n",
                "robot_state.attached_collision_objects[0].object.ids", "did you mean 'id'?"},
        Unknown{"OfATransform", true, "child_frame_id: camera", "child_frame: camera",
                "fixed_frame_transforms[1].child_frame", "did you mean 'child_frame_id'?"},
        Unknown{"OfTheMatrix", true, "  entry_names: [a, b, tool]", "  entries: [a, b, tool]",
                "allowed_collision_matrix.entries", "known are: entry_names"},
        Unknown{"OfARow", true, "- [true, false, true]", "- {enable: [true, false, true]}",
                "allowed_collision_matrix.entry_values[1].enable", "did you mean 'enabled'?"},
        Unknown{"OfPadding", true, "name: kitchen", "link_padding: [{link: a, padding: 0}]",
                "link_padding[0].link", "did you mean 'link_name'?"},
        Unknown{"OfARequest", false, "group_name: arm", "group: arm", "group",
                "did you mean 'group_name'?"},
        Unknown{"OfTheStart", false, "start_state:\n  joint_state:",
                "start_state:\n  joint_states:", "start_state.joint_states",
                "did you mean 'joint_state'?"},
        Unknown{"ConstraintsAtTheTop", false, "goal_constraints:\n  - joint_constraints:",
                "joint_constraints: []\ngoal_constraints:\n  - joint_constraints:",
                "joint_constraints", "its place is goal_constraints.joint_constraints"},
        Unknown{"OfAGoal", false, "tolerance_above: 0.25", "tolerance_abov: 0.25",
                "goal_constraints[0].joint_constraints[0].tolerance_abov",
                "did you mean 'tolerance_above'?"},
        Unknown{"OfTheGoals", false, "  - joint_constraints:", "  - joint_constraint:",
                "goal_constraints[0].joint_constraint", "did you mean 'joint_constraints'?"},
        Unknown{"PathConstraintsMisspelt", false, "group_name: arm",
                "group_name: arm\npath_constraint: {}", "path_constraint",
                "did you mean 'path_constraints'?"},
        Unknown{"InsidePathConstraints", false, "group_name: arm",
                "group_name: arm\npath_constraints: {orientation_constraint: [{weight: 1}]}",
                "path_constraints.orientation_constraint",
                "did you mean 'orientation_constraints'?"},
        Unknown{"OfTheWorkspace", false, "  min_corner: [-1, -2, 0]", "  min: [-1, -2, 0]",
                "workspace_parameters.min", "did you mean 'min_corner'?"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(KnownFields, ThatBearOnThePlanAndAreNotSupportedAreRefusedByName) {
  const auto refuse = [](const std::string& line, const std::string& says) {
    ExpectInputError([&] { ParseProblem(kFullScene, line + "\n" + kFullRequest); },
                     {"request.yaml:1: ", says});
  };
  refuse("path_constraints: {joint_constraints: [{joint_name: a_joint, position: 0}]}",
         "path_constraints.joint_constraints[0]: constraints on the path are not supported");
  refuse("path_constraints: {position_constraints: [{link_name: mast}]}",
         "path_constraints.position_constraints[0]: constraints on the path are not supported");
  refuse("path_constraints: {visibility_constraints: [{target_radius: 1}]}",
         "path_constraints.visibility_constraints[0]");
  refuse("trajectory_constraints: {constraints: [{name: x}]}",
         "trajectory_constraints.constraints[0]: constraints on the path are not supported");
}

TEST(KnownFields, ThatDoNotBearOnThePlanAreLeftAlone) {
  const Problem problem = ParseProblem(
      "x-anything: {goes: [here]}\nis_diff: False\nobject_colors: [{id: can, color: {r: 1, g: 0, "
      "b: "
      "0, a: 1}}]\n" +
          Replaced(std::string(kFullScene), "      touch_links:",
                   "      weight: 2\n      detach_posture: {header: {seq: 1}, joint_names: [l], "
                   "points: [{positions: [1], time_from_start: {secs: 1, nsecs: 0}}]}\n"
                   "      touch_links:"),
      "pipeline_id: ompl\nplanner_id: RRT\nnum_planning_attempts: 1\n"
      "max_velocity_scaling_factor: .nan\nmax_cartesian_speed: 0\n"
      "cartesian_speed_limited_link: ''\nreference_trajectories: []\n"
      "path_constraints: {name: '', joint_constraints: [], position_constraints: [], "
      "orientation_constraints: [], visibility_constraints: []}\n"
      "trajectory_constraints: {constraints: []}\n" +
          std::string(kFullRequest));
  EXPECT_EQ(problem.goal.size(), 2u);
  EXPECT_TRUE(problem.warnings.empty());
}

TEST(KnownFields, TrajectoriesToStartFromAreNotReadAndSaidSo) {
  const Problem problem = ParseProblem(kFullScene,
                                       "reference_trajectories: [{joint_trajectory: {joint_names: "
                                       "[a_joint], points: []}}]\n" +
                                           std::string(kFullRequest));
  EXPECT_THAT(problem.warnings,
              ElementsAre(HasSubstr("request.yaml:1: reference_trajectories: are not read")));
}

TEST(KnownFields, AServicesAnswerIsReadAsItsMessage) {
  const auto indented = [](const std::string& key, const std::string& text) {
    std::string result = key + ":\n  ";
    for (const char c : text) {
      result += c;
      if (c == '\n') result += "  ";
    }
    return result + "\n---\n";
  };
  const std::string id = SceneId(ParseProblem(kFullScene).scene);
  const auto read = [&](const std::string& request) {
    const Problem problem = ParseProblem(indented("scene", kFullScene), request);
    EXPECT_EQ(SceneId(problem.scene), id);
    EXPECT_EQ(problem.goal.size(), 2u);
    return problem.warnings;
  };
  EXPECT_THAT(read(indented("motion_plan_request", kFullRequest)), ElementsAre());
  // MoveIt's action, and the topic of its goals.
  const std::string goal = indented("request", kFullRequest);
  EXPECT_THAT(read(goal), ElementsAre());
  const std::string with_options = "planning_options: {plan_only: true}\n" + goal;
  const auto told = ElementsAre(HasSubstr("planning_options: are not read"));
  EXPECT_THAT(read(with_options), told);
  EXPECT_THAT(read("header: {seq: 1}\ngoal_id: {id: x}\n" +
                   indented("goal", with_options.substr(0, with_options.find("---")))),
              told);
  ExpectInputError([&] { read("group_name: arm\n" + goal); },
                   {"request.yaml:1: group_name: unknown field 'group_name' of "
                    "moveit_msgs/MoveGroupGoal"});
  ExpectInputError([&] { read("goal: {}\n" + std::string(kFullRequest)); },
                   {"request.yaml:1: goal: unknown field 'goal' of moveit_msgs/MotionPlanRequest"});
}

TEST(KnownFields, ADifferenceIsTakenAsTheWholeWithAWarning) {
  const Problem problem = ParseProblem("is_diff: True\n" + std::string(kFullScene));
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr("scene.yaml:1: is_diff")));
}

TEST(KnownFields, AnyOneMakesAScene) {
  for (const char* text : {"name: empty", "is_diff: true", "is_diff: false\nname: ''",
                           "robot_model_name: fetch", "world: {}", "object_colors: []"}) {
    SCOPED_TRACE(text);
    const Problem problem = ParseProblem(text);
    EXPECT_TRUE(problem.scene.objects.empty());
    EXPECT_EQ(problem.goal.size(), 2u);
  }
  for (const char* text : {"{}", "x-only: anchors"}) {
    ExpectInputError([&] { ParseProblem(text); },
                     {"scene.yaml:1: ", "no field of moveit_msgs/PlanningScene"});
  }
  ExpectInputError(
      [] {
        ParseProblem("name: empty",
                     "goal_constraints: [{joint_constraints: [{joint_name: a_joint, "
                     "position: 0}, {joint_name: b_joint, position: 0}]}]");
      },
      {"request.yaml:1: ", "no start: neither the request's start_state nor the scene's"});
}

TEST(MergeKeys, ApplyAtEveryLevel) {
  const std::string merged = R"(
x-header: &in_camera
  header: {frame_id: camera}
x-state: &state
  joint_state:
    header: {frame_id: base_link}
    name: [a_joint, b_joint]
    position: [0.25, -1e-3]
x-pose: &level
  orientation: [0, 0, 0, 1]
x-ball: &ball {type: sphere}
x-scene: &scene {name: kitchen, robot_model_name: other}
<<: *scene
robot_model_name: fetch
robot_state:
  <<: *state
fixed_frame_transforms:
  - header: {frame_id: base_link}
    child_frame_id: camera
    transform: {translation: [0, 0, 1], rotation: [0, 0, 0, 1]}
world:
  collision_objects:
    - &first
      <<: *in_camera
      id: a
      primitives: [{<<: *ball, dimensions: [0.1]}]
      primitive_poses: [{<<: *level, position: [1, 0, 0]}]
    - <<: [{id: b}, *first]
    - <<: *first
      id: c
      header: {frame_id: base_link}
)";
  const Problem problem = ParseProblem(merged);
  EXPECT_EQ(problem.scene.name, "kitchen");
  ASSERT_EQ(problem.scene.objects.size(), 3u);
  EXPECT_EQ(problem.scene.objects[0].id, "a");
  EXPECT_EQ(problem.scene.objects[1].id, "b");
  EXPECT_EQ(problem.scene.objects[1].X_WO.translation(), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(problem.scene.objects[2].X_WO.translation(), Eigen::Vector3d(0, 0, 0));
  ExpectInputError(
      [&] { ParseProblem(Replaced(merged, "x-ball: &ball {", "x-ball: &ball {t: 1, ")); },
      {"world.collision_objects[0].primitives[0].t: unknown field 't'"});
}

TEST(Angles, InDegreesWhereverANumberIs) {
  const Problem problem = ParseProblem(
      kFullScene, Replaced(Replaced(kFullRequest, "position: 1.5,", "position: !degrees 90,"),
                           "tolerance_above: 0.25", "tolerance_above: deg(90)"));
  EXPECT_NEAR(problem.goal[0].position, 1.5707963267948966, 1e-15);
  EXPECT_NEAR(problem.goal[0].tolerance_above, 1.5707963267948966, 1e-15);
  const Problem start = ParseProblem(kFullScene, Replaced(kFullRequest, "position: [0.5, 1]",
                                                          "position: [!degrees 180, rad(pi)]"));
  EXPECT_NEAR(start.start.positions[0], 3.141592653589793, 1e-15);
  EXPECT_NEAR(start.start.positions[1], 3.141592653589793, 1e-15);
  ExpectInputError(
      [] { ParseProblem(kFullScene, Replaced(kFullRequest, "1.5,", "!gradians 100,")); },
      {"request.yaml:13: goal_constraints[0].joint_constraints[0].position", "'!gradians'"});
}

}  // namespace
}  // namespace planbench
