#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/error.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

enum class File { kScene, kRequest };

// A mistake made in a good file, and what the message must say.
struct Mistake {
  const char* name;
  File file;
  const char* from;
  const char* to;
  const char* at;     // The message names the line where this text stands, in the changed file.
  const char* field;  // "" for errors of syntax.
  const char* says;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class Malformed : public testing::TestWithParam<Mistake> {};

TEST_P(Malformed, IsRefusedWithFileLineAndField) {
  const Mistake& mistake = GetParam();
  std::string scene = kFullScene;
  std::string request = kFullRequest;
  std::string& changed = mistake.file == File::kScene ? scene : request;
  changed = Replaced(changed, mistake.from, mistake.to);
  const std::size_t at = changed.find(mistake.at);
  ASSERT_NE(at, std::string::npos);
  const auto line = 1 + std::count(changed.begin(), changed.begin() + static_cast<long>(at), '\n');
  std::string where = mistake.file == File::kScene ? "scene.yaml:" : "request.yaml:";
  where += std::to_string(line) + ": ";
  if (*mistake.field != '\0') where += std::string(mistake.field) + ": ";
  try {
    ParseProblem(scene, request);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith(where));
    EXPECT_THAT(error.what(), HasSubstr(mistake.says));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "not one line";
  }
}

constexpr File kScene = File::kScene;
constexpr File kRequest = File::kRequest;
const auto kName = [](const auto& info) { return std::string(info.param.name); };

#define OBJECT "world.collision_objects"

INSTANTIATE_TEST_SUITE_P(
    Syntax, Malformed,
    testing::Values(
        Mistake{"RunTogether", kRequest, "allowed_planning_time: 12.5\nworkspace",
                "allowed_planning_time: 12.5workspace", "12.5workspace_parameters:", "", ""},
        Mistake{"TwoDocuments", kRequest, "start_state:", "---\nstart_state:", "start_state:", "",
                "second YAML document"},
        Mistake{"Tab", kRequest, "group_name: arm\n", "group_name: arm\n\tx: 1\n", "\tx", "", ""},
        Mistake{"KeyTwice", kScene, "robot_model_name: fetch", "robot_model_name: fetch\nworld: {}",
                "world:\n", "world", "twice"},
        Mistake{"GroupIsASequence", kRequest, "group_name: arm\n", "group_name: [arm]\n",
                "group_name", "group_name", "expected text"}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Objects, Malformed,
    testing::Values(
        Mistake{"NoId", kScene, "- id: can\n", "- type: {key: soup}\n", "type: {key", OBJECT "[1]",
                "'id' is missing"},
        Mistake{"SameIdTwice", kScene, "- id: can\n", "- id: shelf\n",
                "shelf\n      header: {frame_id: camera", OBJECT "[1].id",
                "'shelf' is given twice"},
        Mistake{"NoShape", kScene,
                "      primitives:\n        - {type: cylinder, dimensions: [0.14, 0.03]}\n", "",
                "- id: can", OBJECT "[1]", "no shape"},
        Mistake{"UnknownType", kScene, "type: cylinder", "type: capsule", "capsule",
                OBJECT "[1].primitives[0].type", "box (1), sphere (2), cylinder (3), cone (4)"},
        Mistake{"UnknownTypeNumber", kScene, "type: cylinder", "type: 5", "type: 5",
                OBJECT "[1].primitives[0].type", "unknown shape type '5'"},
        Mistake{"NoType", kScene, "type: sphere, ", "", "dimensions: [0.05]",
                OBJECT "[0].primitives[1]", "'type' is missing"},
        Mistake{"NoDimensions", kScene, "{type: sphere, dimensions: [0.05]}", "{type: sphere}",
                "type: sphere", OBJECT "[0].primitives[1]", "'dimensions' is missing"},
        Mistake{"TooFewDimensions", kScene, "[1.2, 0.4, 0.04]", "[1.2, 0.4]", "[1.2",
                OBJECT "[0].primitives[0].dimensions", "expected 3 numbers, found 2"},
        Mistake{"TooManyDimensions", kScene, "[0.14, 0.03]", "[0.14, 0.03, 1]", "[0.14",
                OBJECT "[1].primitives[0].dimensions", "expected 2 numbers, found 3"},
        Mistake{"ZeroDimension", kScene, "[1.2, 0.4, 0.04]", "[1.2, 0, 0.04]", "[1.2",
                OBJECT "[0].primitives[0].dimensions[1]", "greater than zero"},
        Mistake{"NegativeDimension", kScene, "[0.05]", "[-0.05]", "[-0.05]",
                OBJECT "[0].primitives[1].dimensions[0]", "greater than zero"},
        Mistake{"NanDimension", kScene, "[0.05]", "[.nan]", ".nan",
                OBJECT "[0].primitives[1].dimensions[0]", "finite number"},
        Mistake{"InfinitePosition", kScene, "[1, 0, 0.5]", "[1, -.inf, 0.5]", "-.inf",
                OBJECT "[0].pose.position[1]", "finite number"},
        Mistake{"TextForANumber", kScene, "[1, 0, 0.5]", "[1, zero, 0.5]", "zero",
                OBJECT "[0].pose.position[1]", "expected a number, found 'zero'"},
        Mistake{"NumberRunIntoText", kScene, "[1, 0, 0.5]", "[1, 0.5robot, 0.5]", "0.5robot",
                OBJECT "[0].pose.position[1]", "expected a number"},
        Mistake{"PositionOfTwo", kScene, "[1, 0, 0.5]", "[1, 0.5]", "[1, 0.5]",
                OBJECT "[0].pose.position", "expected 3 numbers, found 2"},
        Mistake{"QuaternionLacksW", kScene, "[0, 0, 0.6, 0.8]", "{z: 0.6}", "{z: 0.6",
                OBJECT "[0].pose.orientation", "no unit quaternion (length 0.6"},
        Mistake{"NonUnitQuaternion", kScene, "[0, 0, 0.6, 0.8]", "[0, 0, 0.6, 0.9]", "0.9]",
                OBJECT "[0].pose.orientation", "no unit quaternion"},
        Mistake{"AnglesForAQuaternion", kScene, "[0, 0, 0.6, 0.8]", "[0, 0, 1.57, 0]", "1.57",
                OBJECT "[0].pose.orientation", "no unit quaternion"},
        Mistake{"InfiniteQuaternion", kScene, "[0, 0, 0.6, 0.8]", "[0, 0, 0, .inf]", ".inf",
                OBJECT "[0].pose.orientation[3]", "finite"},
        Mistake{"FewerPosesThanShapes", kScene,
                "        - {position: [0.1, 0, 0.3], orientation: [0, 0, 0, 1]}\n", "",
                "- id: shelf", OBJECT "[0]", "2 shapes but 1 primitive_poses"},
        Mistake{"UnknownFrame", kScene, "header: {frame_id: camera}\n      primitives",
                "header: {frame_id: lamp}\n      primitives", "lamp", OBJECT "[1].header.frame_id",
                "unknown frame 'lamp'"},
        Mistake{"FrameOfALaterObject", kScene, "header: {frame_id: camera}\n      primitives",
                "header: {frame_id: /wedge}\n      primitives", "/wedge",
                OBJECT "[1].header.frame_id", "'wedge' is that of an object that comes later"},
        Mistake{"FrameOfItself", kScene, "header: {frame_id: camera}\n      primitives",
                "header: {frame_id: can/top}\n      primitives", "can/top",
                OBJECT "[1].header.frame_id", "comes later, or of this one"},
        Mistake{"OperationOnAnObjectAbove", kScene, "- id: can\n",
                "- id: shelf\n      operation: append\n", "append", OBJECT "[1].operation",
                "only the operation ADD"},
        Mistake{"RemoveOperationOfRos2", kScene, "operation: 0", "operation: \"\\x01\"",
                "operation", OBJECT "[0].operation",
                "only the operation ADD (0) is supported, found '1'"},
        Mistake{"NameOfTwoLines", kScene, "- id: can\n", "- id: \"c\\nan\"\n", "- id: \"c",
                OBJECT "[1].id", "one line"},
        Mistake{"TwoScales", kScene, "- vertices:",
                "- dimensions: [1, 1, 2]\n          scale: [1, 1, 1]\n          vertices:",
                "scale: [1", OBJECT "[2].meshes[0].scale", "another scale"},
        Mistake{"RemoveOperation", kScene, "operation: 0", "operation: 1", "operation",
                OBJECT "[0].operation", "only the operation ADD"},
        Mistake{"PlaneWithoutNormal", kScene, "- id: can\n",
                "- id: can\n      planes: [{coef: [0, 0, 0, 1]}]\n      plane_poses: [{position: "
                "[0, 0, 0], orientation: [0, 0, 0, 1]}]\n",
                "planes", OBJECT "[1].planes[0].coef", "must not all be zero"},
        Mistake{"VertexOutOfRange", kScene, "[1, 2, 3]", "[1, 2, 4]", "[1, 2, 4]",
                OBJECT "[2].meshes[0].triangles[2][2]", "no vertex 4 among 4"},
        Mistake{"TriangleOfFour", kScene, "[1, 2, 3]", "[1, 2, 3, 0]", "[1, 2, 3, 0]",
                OBJECT "[2].meshes[0].triangles[2]", "three vertex indices"},
        Mistake{"FractionalIndex", kScene, "[1, 2, 3]", "[1, 2.5, 3]", "2.5",
                OBJECT "[2].meshes[0].triangles[2][1]", "expected an integer"},
        Mistake{"NoTriangles", kScene, "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]", "[]",
                "triangles: []", OBJECT "[2].meshes[0].triangles", "no triangles"},
        Mistake{"NeitherResourceNorVertices", kScene,
                "- vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\n          tri", "- tri",
                "- tri", OBJECT "[2].meshes[0]", "'vertices' is missing"}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Scenes, Malformed,
    testing::Values(
        Mistake{"AsymmetricMatrix", kScene, "- [true, false, true]", "- [true, false, false]",
                "- [false, true, false]\n  default", "allowed_collision_matrix.entry_values[2][1]",
                "not symmetric: 'tool' against 'b'"},
        Mistake{"MatrixLacksARow", kScene, "    - [true, false, true]\n", "", "entry_names: [a",
                "allowed_collision_matrix", "3 entry_names but 2 entry_values"},
        Mistake{"ShortRow", kScene, "- [true, false, true]", "- [true, false]", "- [true, false]",
                "allowed_collision_matrix.entry_values[1]", "2 values for 3 entry_names"},
        Mistake{"MatrixNameTwice", kScene, "[a, b, tool]", "[a, b, a]", "[a, b, a]",
                "allowed_collision_matrix.entry_names[2]", "'a' is named twice"},
        Mistake{"NoBoolean", kScene, "- [true, false, true]", "- [true, 2, true]", "2, true",
                "allowed_collision_matrix.entry_values[1][1]", "expected true or false"},
        Mistake{"DefaultsDoNotMatch", kScene, "default_entry_values: [true, false]",
                "default_entry_values: [true]", "entry_names: [a", "allowed_collision_matrix",
                "2 default_entry_names but 1"},
        Mistake{"JointsDoNotMatch", kScene, "position: [0.25, -1e-3]", "position: [0.25]",
                "header: {frame_id: base_link}\n    name", "robot_state.joint_state",
                "2 joint names (name) but 1"},
        Mistake{"TouchLinksAreText", kScene, "touch_links: [l_finger, r_finger]",
                "touch_links: l_finger", "touch_links",
                "robot_state.attached_collision_objects[0].touch_links", "expected a sequence"},
        Mistake{"MultiDofWithoutTransform", kScene, "robot_state:\n",
                "robot_state:\n  multi_dof_joint_state: {joint_names: [floating]}\n", "[floating]",
                "robot_state.multi_dof_joint_state", "1 joint_names but 0 transforms"},
        Mistake{"MultiDofOfAnArmJoint", kScene, "robot_state:\n",
                "robot_state:\n  multi_dof_joint_state: {joint_names: [a_joint], transforms: "
                "[{translation: [0, 0, 0], rotation: [0, 0, 0, 1]}]}\n",
                "[a_joint]", "robot_state.multi_dof_joint_state.joint_names[0]",
                "'a_joint' is not one that takes a pose"},
        Mistake{"TwoRoots", kScene, "robot_state:\n",
                "robot_state:\n  multi_dof_joint_state: {joint_names: [root, other], transforms: "
                "[{translation: [0, 0, 0], rotation: [0, 0, 0, 1]}, "
                "{translation: [0, 0, 0], rotation: [0, 0, 0, 1]}]}\n",
                "[root, other]", "robot_state.multi_dof_joint_state.joint_names[1]", "'other'"},
        Mistake{"RobotInItsOwnFrame", kScene, "robot_state:\n",
                "robot_state:\n  multi_dof_joint_state: {header: {frame_id: base_link}, "
                "joint_names: [root], transforms: "
                "[{translation: [1.5, 0, 0], rotation: [0, 0, 0, 1]}]}\n",
                "1.5", "robot_state.multi_dof_joint_state.transforms[0]",
                "places the robot's link 'base_link' in the frame 'base_link'"},
        Mistake{"OctomapOfNoResolution", kScene, "world:\n",
                "world:\n  octomap: {octomap: {id: OcTree, binary: true, data: [1, 2]}}\n",
                "octomap", "world.octomap.octomap", "'resolution' is missing"},
        Mistake{"OctomapCutOff", kScene, "world:\n",
                "world:\n  octomap: {octomap: {id: OcTree, binary: true, resolution: 0.1, "
                "data: [3, 0]}}\n",
                "octomap", "world.octomap.octomap.data", "cut off"},
        Mistake{"OctomapOfColours", kScene, "world:\n",
                "world:\n  octomap: {octomap: {id: ColorOcTree, binary: true, resolution: 0.1, "
                "data: [2, 0]}}\n",
                "octomap", "world.octomap.octomap.data", "'ColorOcTree'"},
        Mistake{"OctomapInAnUnknownFrame", kScene, "world:\n",
                "world:\n  octomap: {header: {frame_id: lamp}, octomap: {id: OcTree, binary: true, "
                "resolution: 0.1, data: [2, 0]}}\n",
                "octomap", "world.octomap.header.frame_id", "unknown frame 'lamp'"},
        Mistake{"UnknownJoint", kScene, "name: [a_joint, b_joint]", "name: [a_joint, c_joint]",
                "c_joint", "robot_state.joint_state.name[1]", "'c_joint' is unknown"},
        Mistake{"FixedJointElsewhere", kScene, "name: [a_joint, b_joint]", "name: [a_joint, l]",
                "[a_joint, l]", "robot_state.joint_state.name[1]", "'l' is fixed"},
        Mistake{"OtherRobot", kScene, "robot_model_name: fetch", "robot_model_name: fletch",
                "fletch", "robot_model_name", "robot 'fletch', not for 'fetch'"},
        Mistake{"Padding", kScene, "name: kitchen",
                "name: kitchen\nlink_padding: [{link_name: a, padding: 0.01}]", "0.01",
                "link_padding[0].padding", "link_padding is not supported"},
        Mistake{"Scale", kScene, "name: kitchen",
                "name: kitchen\nlink_scale: [{link_name: a, scale: 1.1}]", "1.1",
                "link_scale[0].scale", "link_scale is not supported"},
        Mistake{"WorldInItselfMoves", kScene, "{translation: [0, 0, 0]", "{translation: [0, 0, 2]",
                "[0, 0, 2]", "fixed_frame_transforms[0].transform", "other than the identity"},
        Mistake{"FrameOfUnknownParent", kScene,
                "  - header: {frame_id: base_link}\n    child_frame_id: camera",
                "  - header: {frame_id: torso}\n    child_frame_id: camera", "camera}\n      prim",
                OBJECT "[1].header.frame_id", "unknown frame 'camera'"},
        Mistake{"FrameTwice", kScene, "child_frame_id: camera",
                "child_frame_id: camera\n    transform: {translation: [0, 1, 1], rotation: "
                "[0, 0, 0, 1]}\n  - header: {frame_id: base_link}\n    child_frame_id: camera",
                "header: {frame_id: base_link}\n    child_frame_id: camera\n    transform: "
                "{translation: [0, 0, 1]",
                "fixed_frame_transforms[2]", "'base_link' and 'camera' stand otherwise"},
        Mistake{"LinkElsewhere", kScene, "child_frame_id: camera", "child_frame_id: gripper_link",
                "header: {frame_id: base_link}\n    child_frame_id: gripper_link",
                "fixed_frame_transforms[1]", "'gripper_link' stand otherwise"},
        Mistake{"AttachedWithoutLink", kScene, "- link_name: gripper_link\n      object",
                "- object", "- object", "robot_state.attached_collision_objects[0]",
                "'link_name' is missing"},
        Mistake{"AttachedInUnknownFrame", kScene, "header: {frame_id: gripper_link}",
                "header: {frame_id: lamp}", "lamp",
                "robot_state.attached_collision_objects[0].object.header.frame_id",
                "unknown frame 'lamp'"},
        Mistake{"AttachedToUnknownLink", kScene, "link_name: gripper_link", "link_name: hand",
                "hand", "robot_state.attached_collision_objects[0].link_name", "no link 'hand'"},
        Mistake{"SubframesDoNotMatch", kScene, "    - id: can\n",
                "    - id: can\n      subframe_names: [top]\n", "- id: can", OBJECT "[1]",
                "1 subframe_names but 0 subframe_poses"}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Requests, Malformed,
    testing::Values(
        Mistake{"NoGoal", kRequest, "goal_constraints:", "x-goals:", "group_name", "",
                "'goal_constraints' is missing"},
        Mistake{"UnknownGroup", kRequest, "group_name: arm", "group_name: leg", "leg", "group_name",
                "no group 'leg'"},
        Mistake{"AlternativeLacksAJoint", kRequest, "goal_constraints:\n",
                "goal_constraints:\n  - joint_constraints: [{joint_name: a_joint, position: 0}]\n",
                "position: 0}", "goal_constraints[0].joint_constraints",
                "no goal for joint 'b_joint'"},
        Mistake{"EmptyGoal", kRequest, "goal_constraints:\n  - joint_constraints:\n",
                "goal_constraints:\n  - joint_constraints: []\n    name: x\nx-rest:\n  - y:\n",
                "[]", "goal_constraints[0].joint_constraints", "no goal"},
        Mistake{"PositionGoal", kRequest, "goal_constraints:\n  - joint",
                "goal_constraints:\n  - position_constraints: [{weight: 1}]\n    joint",
                "weight: 1}]", "goal_constraints[0].position_constraints[0]",
                "'link_name' is missing"},
        Mistake{"OrientationGoal", kRequest, "goal_constraints:\n  - joint",
                "goal_constraints:\n  - orientation_constraints: [{weight: 1}]\n    joint",
                "weight: 1}]", "goal_constraints[0].orientation_constraints[0]",
                "'link_name' is missing"},
        Mistake{"VisibilityGoal", kRequest, "goal_constraints:\n  - joint",
                "goal_constraints:\n  - visibility_constraints: [{weight: 1}]\n    joint",
                "weight: 1}]", "goal_constraints[0].visibility_constraints[0]",
                "constraints on what is visible"},
        Mistake{"PathConstraint", kRequest, "group_name: arm",
                "group_name: arm\npath_constraints: {orientation_constraints: [{weight: 1}]}",
                "path_constraints", "path_constraints.orientation_constraints[0]",
                "constraints on the path"},
        Mistake{"GoalJointTwice", kRequest, "joint_name: b_joint", "joint_name: a_joint",
                "a_joint, position: -3", "goal_constraints[0].joint_constraints[1].joint_name",
                "named twice"},
        Mistake{"GoalOfAnUnknownJoint", kRequest, "joint_name: b_joint", "joint_name: c_joint",
                "c_joint", "goal_constraints[0].joint_constraints[1].joint_name",
                "'c_joint' is unknown"},
        Mistake{"GoalOfAFixedJoint", kRequest, "joint_name: b_joint", "joint_name: l", "l, pos",
                "goal_constraints[0].joint_constraints[1].joint_name",
                "the joint 'l' is fixed and cannot be at -3.14159"},
        Mistake{"GoalLacksAJoint", kRequest,
                "      - {joint_name: b_joint, position: -3.141592653589793}\n", "",
                "joint_name: a_joint", "goal_constraints[0].joint_constraints",
                "no goal for joint 'b_joint'"},
        Mistake{"UnknownStartJoint", kRequest, "[a_joint, b_joint]", "[a_joint, c_joint]",
                "c_joint]", "start_state.joint_state.name[1]", "'c_joint' is unknown"},
        Mistake{"GoalWithoutPosition", kRequest, ", position: -3.141592653589793", "",
                "{joint_name: b_joint", "goal_constraints[0].joint_constraints[1]",
                "'position' is missing"},
        Mistake{"GoalIsNan", kRequest, "-3.141592653589793", "nan", "position: nan",
                "goal_constraints[0].joint_constraints[1].position", "finite"},
        Mistake{"NegativeTolerance", kRequest, "0.125", "-0.125", "-0.125",
                "goal_constraints[0].joint_constraints[0].tolerance_below", "negative"},
        Mistake{"StartJointTwice", kRequest, "[a_joint, b_joint]", "[a_joint, a_joint]",
                "[a_joint, a_joint]", "start_state.joint_state.name[1]", "named twice"},
        Mistake{"StartPositionMissing", kRequest, "position: [0.5, 1]", "position: [0.5]",
                "name: [a_joint", "start_state.joint_state",
                "2 joint names (name) but 1 positions (position)"},
        Mistake{"StartIsInfinite", kRequest, "position: [0.5, 1]", "position: [0.5, .inf]", ".inf",
                "start_state.joint_state.position[1]", "finite"},
        Mistake{"NegativeTime", kRequest, "12.5", "-1", "-1\n", "allowed_planning_time",
                "negative"},
        Mistake{"EmptyWorkspace", kRequest, "[1, 2, 3]", "[1, -2, 3]", "[1, -2, 3]",
                "workspace_parameters.max_corner", "greater than min_corner"},
        Mistake{"WorkspaceLacksACorner", kRequest, "  max_corner: [1, 2, 3]\n", "",
                "header: {frame_id: base_link}\n", "workspace_parameters",
                "'max_corner' is missing"}),
    kName);

// A file cut off anywhere is a smaller valid file or an InputError that names it, and nothing else.
TEST(MalformedFiles, TruncatedAnywhere) {
  const std::string scene = kFullScene;
  const std::string request = kFullRequest;
  int refused = 0;
  const auto read = [&](const std::string& scene_text, const std::string& request_text,
                        const std::string& file) {
    try {
      ParseProblem(scene_text, request_text);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_THAT(error.what(), StartsWith(file));
    }
  };
  for (std::size_t size = 0; size < scene.size(); size += 5) {
    read(scene.substr(0, size), request, "scene.yaml");
  }
  for (std::size_t size = 0; size < request.size(); size += 3) {
    read(scene, request.substr(0, size), "request.yaml");
  }
  EXPECT_GT(refused, 400);
}

TEST(MalformedFiles, OtherFilesThanScenesAreRefused) {
  for (const char* text : {"", "[]", "just text", "{}", "group_name: arm\nstart_state: {}"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(ParseProblem(text, kFullRequest), InputError);
    EXPECT_THROW(ParseProblem(kFullScene, text), InputError);
  }
  EXPECT_THROW(ParseProblem(kFullRequest, kFullRequest), InputError);
  EXPECT_THROW(ParseProblem(kFullScene, kFullScene), InputError);
}

TEST(MalformedFiles, ANameThatIsTooLongIsCalledThat) {
  const std::string scene = Replaced(kFullScene, "- id: can", "- id: " + std::string(5000, 'c'));
  ExpectInputError([&] { ParseProblem(scene); }, {"world.collision_objects[1].id",
                                                  "5000 bytes, which is too long; at most 1000"});
}

TEST(MalformedFiles, AStartIsNeeded) {
  const std::string scene = "robot_model_name: fetch\n";
  const std::string request = Replaced(kFullRequest, "start_state:", "x-state:");
  const std::string state =
      "robot_state: {joint_state: {name: [a_joint, b_joint], position: [0, 0]}}\n";
  const std::string part = "robot_state: {joint_state: {name: [a_joint], position: [0]}}\n";
  ExpectInputError([&] { ParseProblem(scene, request); }, {"request.yaml:1: no start"});
  EXPECT_NO_THROW(ParseProblem(scene + state, request));
  ExpectInputError([&] { ParseProblem(scene + part, request); },
                   {"request.yaml:1: the start does not name joint 'b_joint'"});
}

TEST(MalformedFiles, MissingFileIsNamed) {
  ExpectInputError(
      [] {
        ReadProblem("/nonexistent/scene0001.yaml", "/nonexistent/request0001.yaml", TextRobot());
      },
      {"/nonexistent/scene0001.yaml"});
}

}  // namespace
}  // namespace planbench
