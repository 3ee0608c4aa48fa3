#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_yaml.h"
#include "tests/scene/problem_texts.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Scene ParseScene(const std::string& text, const ResourceResolver& resources = {}) {
  return ParseProblem(text, kFullRequest, resources).scene;
}

TEST(MoveItReader, PlanesAreHalfSpacesBelowThem) {
  const YamlNode node = YamlNode::Parse(
      "id: walls\npose: {position: [1, 0, 0], orientation: [0, 0, 0, 1]}\n"
      "planes: [{coef: [0, 0, 1, 0]}, {coef: [3, 0, 4, 10]}, {coef: [0, 0, -2, 1]}]\n",
      "scene.yaml");
  const SceneObject walls = ReadCollisionObject(node, {});
  ASSERT_EQ(walls.shapes.size(), 3);
  for (const PlacedShape& placed : walls.shapes) {
    EXPECT_TRUE(std::holds_alternative<HalfSpace>(placed.shape));
  }
  EXPECT_EQ(walls.shapes[0].X_FS.matrix(), Eigen::Isometry3d::Identity().matrix());
  EXPECT_TRUE(walls.shapes[1].X_FS.linear().col(2).isApprox(Eigen::Vector3d(0.6, 0, 0.8), 1e-11));
  EXPECT_TRUE(walls.shapes[1].X_FS.translation().isApprox(Eigen::Vector3d(-1.2, 0, -1.6), 1e-12));
  // z >= 0.5
  EXPECT_TRUE(walls.shapes[2].X_FS.linear().col(2).isApprox(-Eigen::Vector3d::UnitZ(), 1e-11));
  EXPECT_TRUE(walls.shapes[2].X_FS.translation().isApprox(Eigen::Vector3d(0, 0, 0.5), 1e-12));
}

TEST(MoveItReader, PlanesThatTheRobotIsInAreNamed) {
  const auto warnings = [](const std::string& ceiling) {
    const std::string pose = "{position: [0, 0, 0], orientation: [0, 0, 0, 1]}";
    return ParseProblem(
               "world: {collision_objects: [{id: room, planes: [{coef: [0, 0, 1, 0]}, "
               "{coef: " +
               ceiling + "}], plane_poses: [" + pose + ", " + pose + "]}]}")
        .warnings;
  };
  EXPECT_THAT(warnings("[0, 0, 1, -0.5]"),
              ElementsAre(HasSubstr("scene.yaml:1: world.collision_objects[0].planes[1].coef: the "
                                    "robot's base is in it")));
  EXPECT_THAT(warnings("[0, 0, -1, 0.5]"), ElementsAre());
}

TEST(MoveItReader, ScalesMeshesThatAreWrittenOut) {
  const auto top = [](const std::string& text) {
    const Scene scene = ParseScene(text);
    const auto& mesh = std::get<Mesh>(scene.objects.at(2).shapes.at(0).shape);
    Eigen::Vector3d most = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& vertex : mesh.triangles->vertices) most = most.cwiseMax(vertex);
    return most;
  };
  const Eigen::Vector3d scaled =
      top(Replaced(kFullScene, "- vertices:", "- scale: [2, 3, 0.5]\n          vertices:"));
  EXPECT_EQ(scaled, top(kFullScene).cwiseProduct(Eigen::Vector3d(2, 3, 0.5)));
}

TEST(MoveItReader, ReadsEveryField) {
  const Problem problem = ParseProblem(kFullScene);
  const Scene& scene = problem.scene;
  EXPECT_EQ(scene.name, "kitchen");
  EXPECT_EQ(scene.robot_name, "fetch");
  EXPECT_EQ(scene.world_frame, "base_link");
  ASSERT_EQ(scene.fixed_frames.size(), 1);
  EXPECT_EQ(scene.fixed_frames[0].frame, "camera");

  ASSERT_EQ(scene.objects.size(), 3);
  const SceneObject& shelf = scene.objects[0];
  EXPECT_EQ(shelf.X_WO.translation(), Eigen::Vector3d(1, 0, 0.5));
  EXPECT_NEAR(shelf.X_WO.linear()(0, 0), 0.28, 1e-12);  // cos of the yaw whose half has sine 0.6
  EXPECT_NEAR(shelf.X_WO.linear()(1, 0), 0.96, 1e-12);
  ASSERT_EQ(shelf.shapes.size(), 2);
  EXPECT_EQ(std::get<Box>(shelf.shapes[0].shape).size, Eigen::Vector3d(1.2, 0.4, 0.04));
  EXPECT_EQ(std::get<Sphere>(shelf.shapes[1].shape).radius, 0.05);
  EXPECT_EQ(shelf.shapes[1].X_FS.translation(), Eigen::Vector3d(0.1, 0, 0.3));

  const SceneObject& can = scene.objects[1];
  EXPECT_EQ(std::get<Cylinder>(can.shapes[0].shape).length, 0.14);
  EXPECT_EQ(std::get<Cylinder>(can.shapes[0].shape).radius, 0.03);
  const Eigen::Vector3d p_WC = can.X_WO * can.shapes[0].X_FS.translation();
  EXPECT_TRUE(p_WC.isApprox(Eigen::Vector3d(0, 0.5, 1), 1e-12)) << p_WC.transpose();

  const auto& wedge = std::get<Mesh>(scene.objects[2].shapes[0].shape);
  EXPECT_EQ(wedge.triangles->vertices.size(), 4);
  EXPECT_THAT(wedge.triangles->triangles[2], ElementsAre(1, 2, 3));

  ASSERT_EQ(scene.attached.size(), 1);
  EXPECT_EQ(scene.attached[0].link, "gripper_link");
  EXPECT_EQ(scene.attached[0].object.id, "tool");
  EXPECT_EQ(std::get<Cone>(scene.attached[0].object.shapes[0].shape).length, 0.2);
  EXPECT_THAT(scene.attached[0].touch_links, ElementsAre("l_finger", "r_finger"));

  EXPECT_TRUE(scene.allowed_collisions.Allowed("b", "a"));
  EXPECT_FALSE(scene.allowed_collisions.Allowed("a", "tool"));
  EXPECT_TRUE(scene.allowed_collisions.Allowed("shelf", "tool"));

  EXPECT_EQ(problem.group, "arm");
  EXPECT_EQ(problem.time_limit_s, 12.5);
  ASSERT_TRUE(problem.workspace);
  EXPECT_EQ(problem.workspace->frame, "base_link");
  EXPECT_EQ(problem.workspace->min_corner, Eigen::Vector3d(-1, -2, 0));
  EXPECT_THAT(problem.start.names, ElementsAre("a_joint", "b_joint"));
  EXPECT_THAT(problem.start.positions, ElementsAre(0.5, 1));
  ASSERT_EQ(problem.goal.size(), 2);
  EXPECT_EQ(problem.goal[0].tolerance_above, 0.25);
  EXPECT_EQ(problem.goal[0].tolerance_below, 0.125);
  EXPECT_EQ(problem.goal[1].position, -3.141592653589793);
  EXPECT_EQ(problem.goal[1].tolerance_above, 0);
}

TEST(MoveItReader, AWorkspaceInAnUnknownFrameIsLeftOut) {
  const Problem problem =
      ParseProblem(kFullScene, Replaced(kFullRequest, "frame_id: base_link", "frame_id: nowhere"));
  EXPECT_FALSE(problem.workspace);
  EXPECT_THAT(problem.warnings, ElementsAre(testing::AllOf(
                                    HasSubstr("workspace_parameters.header.frame_id: unknown frame "
                                              "'nowhere'"),
                                    HasSubstr("left out"))));
}

// Each pair of texts says the same in two dialects.
struct Dialect {
  const char* name;
  const char* from;
  const char* to;
};

void PrintTo(const Dialect& dialect, std::ostream* out) { *out << dialect.name; }

class SceneDialect : public testing::TestWithParam<Dialect> {};

TEST_P(SceneDialect, MeansTheSameScene) {
  const std::string text = Replaced(kFullScene, GetParam().from, GetParam().to);
  EXPECT_EQ(SceneId(ParseScene(text)), SceneId(ParseScene(kFullScene)));
}

INSTANTIATE_TEST_SUITE_P(
    Dialects, SceneDialect,
    testing::Values(
        Dialect{"VectorAsMap", "position: [1, 0, 0.5]", "position: {y: 0, x: 1.0, z: 5e-1}"},
        Dialect{"QuaternionAsMap", "orientation: [0, 0, 0.6, 0.8]",
                "orientation: {w: 0.8, x: 0, y: 0, z: 0.6}"},
        Dialect{"FieldsThatAreZeroLeftOut",
                "{position: [1, 0, 0.5], orientation: [0, 0, 0.6, 0.8]}",
                "{position: {z: 0.5, x: 1}, orientation: {w: 0.8, z: 0.6}}"},
        Dialect{"PositionLeftOut",
                "{position: [0, 0, 0], orientation: [0, 0, 0, 1]}\n        - "
                "{position: [0.1,",
                "{orientation: {w: 1}}\n        - {position: [0.1,"},
        Dialect{"TranslationLeftOut", "{translation: [0, 0, 0], rotation: [0, 0, 0, 1]}",
                "{rotation: {w: 1.0}}"},
        Dialect{"QuaternionOfOtherSign", "[0, 0, 0.6, 0.8]", "[0, 0, -0.6, -0.8]"},
        Dialect{"NegativeZero", "position: [1, 0, 0.5]", "position: [1, -0.0, 0.5]"},
        Dialect{"QuotedNumbersAndNames", "{type: sphere, dimensions: [0.05]}",
                "{\"type\": 'sphere', \"dimensions\": ['+0.05']}"},
        Dialect{"TypeAsNumber", "{type: sphere, dimensions: [0.05]}",
                "{dimensions: [0.05], type: 2}"},
        Dialect{"LengthsThatTheShapeLacksAtZero", "dimensions: [0.05]",
                "dimensions: [0.05, 0, 0.0]"},
        Dialect{"TypeInCapitals", "type: cylinder", "type: CYLINDER"},
        Dialect{"NoOperation", "      operation: 0\n", ""},
        Dialect{"OperationAsWord", "operation: 0", "operation: ADD"},
        Dialect{"OperationAsRos2PrintsIt", "operation: 0", "operation: \"\\0\""},
        Dialect{"OperationAsBinary", "operation: 0", "operation: !!binary AA=="},
        Dialect{"OtherName", "name: kitchen", "name: \"\""},
        Dialect{"NameAsNull", "name: kitchen", "name: ~"},
        Dialect{"NoRobotName", "robot_model_name: fetch\n", ""},
        Dialect{"RowsAsMaps", "- [true, false, true]", "- {enabled: [true, false, true]}"},
        Dialect{"RowsAsNumbers", "- [true, false, true]", "- [1, 0, 1]"},
        Dialect{"TrianglesAsMaps", "[0, 2, 1],", "{vertex_indices: [0, 2, 1]},"},
        Dialect{"SingleMesh", "      meshes:\n        - vertices",
                "      mesh:\n        - vertices"},
        Dialect{"UnsetPose", "    - id: can\n",
                "    - id: can\n"
                "      pose: {position: {x: 0, y: 0, z: 0}, orientation: [0, 0, 0, 0]}\n"},
        Dialect{"LeadingSlashes",
                "link_name: gripper_link\n      object:\n        id: tool\n        "
                "header: {frame_id: gripper_link}",
                "link_name: /gripper_link\n      object:\n        id: tool\n        "
                "header: {frame_id: /gripper_link}"},
        Dialect{"LeadingSlashOfAFrame", "header: {frame_id: camera}",
                "header: {frame_id: /camera}"},
        Dialect{"LeadingSlashOfAChild", "child_frame_id: camera", "child_frame_id: /camera"},
        Dialect{"EndOfADocument", "name: kitchen\n", "---\nname: kitchen\n"},
        Dialect{"IgnoredFields", "name: kitchen",
                "is_diff: false\nobject_colors: []\nlink_padding: [{link_name: a, padding: 0}]\n"
                "link_scale: [{link_name: a, scale: 1}]"},
        Dialect{"EmptyOctomap", "world:\n", "world:\n  octomap: {octomap: {id: \"\", data: []}}\n"},
        Dialect{"EmptyPlanes", "    - id: can\n", "    - id: can\n      planes: []\n"},
        Dialect{"DiagonalIsTrue", "[false, true, false]\n    - [true, false",
                "[true, true, false]\n    - [true, false"},
        Dialect{"WindowsLineEnds", "name: kitchen\n", "name: kitchen\r\n"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(MoveItReader, KeysInReverseOrderAndNoNewlineAtTheEnd) {
  const Scene scene = ParseScene(
      "world:\n  collision_objects:\n"
      "    - primitive_poses: [{orientation: [0, 0, 0, 1], position: [1, 2, 3]}]\n"
      "      primitives: [{dimensions: [0.1], type: sphere}]\n"
      "      header: {frame_id: base_link}\n      id: ball\n"
      "allowed_collision_matrix:\n  entry_values: [[false, true], [true, false]]\n"
      "  entry_names: [a, b]\nname: \"\"");
  EXPECT_EQ(scene.world_frame, "base_link");
  EXPECT_TRUE(scene.allowed_collisions.Allowed("a", "b"));
  EXPECT_EQ(scene.objects[0].shapes[0].X_FS.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(MoveItReader, AnEntryHasLinksCheckedThatAJointConnects) {
  const auto read = [](const std::string& flags) {
    return ParseScene(
               "allowed_collision_matrix:\n  entry_names: [mast, gripper_link, l_finger]\n"
               "  entry_values: " +
               flags + "\n")
        .allowed_collisions;
  };
  const AllowedCollisionMatrix none =
      read("[[false, false, false], [false, false, false], [false, false, false]]");
  EXPECT_EQ(none.entries().size(), 1u) << "the other pairs are checked, or never are, anyway";
  EXPECT_EQ(none.Entry("gripper_link", "mast"), std::optional(false));
  const AllowedCollisionMatrix some =
      read("[[false, true, false], [true, false, false], [false, false, false]]");
  EXPECT_EQ(some.entries().size(), 1u);
  EXPECT_EQ(some.Entry("gripper_link", "mast"), std::optional(true));
}

TEST(MoveItReader, NamesOfTheMatrixThatAreNearlyLinksAreToldOf) {
  const auto warnings = [](const std::string& matrix) {
    return ParseProblem(
               "world: {collision_objects: [{id: gripper_lnik, pose: {orientation: {w: 1}}, "
               "primitives: [{type: "
               "sphere, dimensions: [0.1]}]}]}\nallowed_collision_matrix: " +
               matrix)
        .warnings;
  };
  EXPECT_THAT(warnings("{entry_names: [base_lnik, gripper_lnik, panda_hand],\n  entry_values: "
                       "[[false, true, true], [true, false, true], [true, true, false]]}"),
              ElementsAre("scene.yaml:2: allowed_collision_matrix.entry_names[0]: 'base_lnik' is "
                          "no link and no object; did you mean the link 'base_link'?"));
  EXPECT_THAT(warnings("{default_entry_names: [r_fingers, x], default_entry_values: [true, true]}"),
              ElementsAre(testing::HasSubstr("default_entry_names[0]: 'r_fingers' is no link")));
  EXPECT_THAT(warnings("{default_entry_names: [m_finger, l_finger, r_finger], "
                       "default_entry_values: [true, true, true]}"),
              ElementsAre())
      << "a link of another robot: the near ones are named themselves";
}

TEST(MoveItReader, PosesOfShapesMayBeLeftOutBesideAnObjectPose) {
  const Scene scene = ParseScene(
      "world: {collision_objects: [{id: ball, pose: {position: [1, 2, 3], "
      "orientation: [0, 0, 0, 1]}, primitives: [{type: sphere, dimensions: [1]}]}]}");
  EXPECT_EQ(scene.objects[0].X_WO.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(scene.objects[0].shapes[0].X_FS.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(MoveItReader, ObjectsOutOfAllReachAreNamedOnce) {
  const auto warnings = [](const std::string& positions_x) {
    std::string objects;
    std::string_view rest = positions_x;
    for (int i = 0; !rest.empty(); ++i) {
      const std::string_view x = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(x.size() + 1, rest.size()));
      objects += fmt::format(
          "\n  - {{id: box_{}, primitives: [{{type: sphere, dimensions: [0.1]}}], primitive_poses: "
          "[{{position: [{}, 0, 0], orientation: {{w: 1}}}}]}}",
          i, x);
    }
    return ParseProblem("world:\n  collision_objects:" + objects).warnings;
  };
  EXPECT_THAT(warnings("99 0.9"), ElementsAre());
  EXPECT_THAT(warnings("1 -900"),
              ElementsAre("scene.yaml:4: world.collision_objects[1].id: 'box_1' is 900 m from the "
                          "robot's base; are its numbers millimetres? They are metres"));
  EXPECT_THAT(warnings("450 2 -900 1000"), ElementsAre(HasSubstr("metres; likewise 2 more")));
}

TEST(MoveItReader, PosesThatNothingGivesAreTheIdentityWithAWarning) {
  const auto read = [](const std::string& object) {
    return ParseProblem(
        "world: {collision_objects: [{id: ball, primitives: [{type: sphere, "
        "dimensions: [1]}]" +
        object + "}]}");
  };
  const auto at_origin = ElementsAre(HasSubstr(
      "scene.yaml:1: world.collision_objects[0]: has neither a pose nor primitive_poses; taken"));
  EXPECT_THAT(read("").warnings, at_origin);
  EXPECT_THAT(read(", pose: {position: [0, 0, 0], orientation: [0, 0, 0, 0]}").warnings, at_origin);
  EXPECT_THAT(read(", pose: {}, primitive_poses: []").warnings, at_origin);
  const SceneObject ball = read("").scene.objects.at(0);
  EXPECT_TRUE(ball.X_WO.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(ball.shapes.at(0).X_FS.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_THAT(read(", pose: {orientation: {w: 1}}").warnings, ElementsAre());
  EXPECT_THAT(
      read(", planes: [{coef: [0, 0, 1, 0]}], primitive_pose: {orientation: {w: 1}}").warnings,
      ElementsAre(HasSubstr("has neither a pose nor plane_poses")));
  EXPECT_THAT(read(", primitive_poses: [{position: {x: 3}}]").warnings,
              ElementsAre(HasSubstr("primitive_poses[0]: the orientation, left out, is all zero; "
                                    "taken as no rotation")));
}

TEST(MoveItReader, AChainToALinkIsNamedWhereThePlanningFrameIsGuessed) {
  const auto warnings = [](const std::vector<std::pair<std::string, std::string>>& chain) {
    std::string scene = "fixed_frame_transforms:\n";
    for (const auto& [header, child] : chain) {
      scene += "  - {header: {frame_id: " + header + "}, child_frame_id: " + child +
               ", transform: {rotation: {w: 1}}}\n";
    }
    return ParseProblem(scene).warnings;
  };
  const auto told = [](int line) {
    return ElementsAre(HasSubstr(fmt::format(
        "scene.yaml:{}: fixed_frame_transforms[{}]: taken as the pose of the frame 'odom' in that "
        "of the link 'base_link'",
        line, line - 2)));
  };
  EXPECT_THAT(warnings({{"map", "odom"}, {"odom", "base_link"}}), told(3));
  EXPECT_THAT(warnings({{"odom", "base_link"}, {"odom", "map"}, {"base_link", "lens"}}), told(2));
  // What is said otherwise, or can be meant in one way alone.
  EXPECT_THAT(warnings({{"map", "map"}, {"map", "odom"}, {"odom", "base_link"}}), ElementsAre());
  EXPECT_THAT(warnings({{"base_link", "odom"}, {"odom", "map"}}), ElementsAre());
  EXPECT_THAT(warnings({{"camera", "map"}, {"lens", "base_link"}}), ElementsAre());
}

class MeshFile : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "meshes");
    std::ofstream(folder_ / "meshes" / "tri.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Scene(const std::string& mesh) {
    return "world:\n  collision_objects:\n    - id: m\n      meshes:\n        - " + mesh +
           "\n      mesh_poses:\n        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}\n";
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("planbench_mesh_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
       testing::UnitTest::GetInstance()->current_test_info()->name());
  ResourceResolver resources_{.base_folder = folder_, .packages = {{"things", folder_}}};
};

TEST_F(MeshFile, IsReadAgainIfItWasReplacedThoughItsTimeWasKept) {
  const auto file = folder_ / "meshes" / "tri.obj";
  const auto read = [&] { return ParseScene(Scene("{resource: meshes/tri.obj}"), resources_); };
  const auto mesh_of = [](const planbench::Scene& scene) {
    return std::get<Mesh>(scene.objects[0].shapes[0].shape).triangles;
  };
  const planbench::Scene first = read();
  EXPECT_EQ(mesh_of(read()).operator->(), mesh_of(first).operator->()) << "of the same file";
  std::ofstream(folder_ / "other.obj") << "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";  // as long
  std::filesystem::last_write_time(folder_ / "other.obj", std::filesystem::last_write_time(file));
  std::filesystem::rename(folder_ / "other.obj", file);
  EXPECT_NE(mesh_of(read()), mesh_of(first));
}

TEST_F(MeshFile, LoadsResourceAndAppliesScale) {
  const planbench::Scene scene = ParseScene(
      Scene("{resource: 'package://things/meshes/tri.obj', dimensions: [2, 3, 1]}"), resources_);
  const auto& mesh = std::get<Mesh>(scene.objects[0].shapes[0].shape);
  EXPECT_EQ(mesh.resource, "package://things/meshes/tri.obj");
  EXPECT_EQ(mesh.scale, Eigen::Vector3d(2, 3, 1));
  ASSERT_EQ(mesh.triangles->triangles.size(), 1);
  Eigen::Vector3d top = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : mesh.triangles->vertices) top = top.cwiseMax(vertex);
  EXPECT_EQ(top, Eigen::Vector3d(2, 3, 0));

  Problem problem;
  problem.scene = scene;
  Problem again;
  again.scene = ParseScene(SceneToYaml(problem), resources_);
  EXPECT_EQ(SceneId(again.scene), SceneId(scene));
  EXPECT_EQ(SceneToYaml(again), SceneToYaml(problem));
}

TEST_F(MeshFile, IsReadOnceForObjectsOfTheSameScaleUntilItChanges) {
  const std::string text = Scene("{resource: 'meshes/tri.obj', dimensions: [2, 3, 1]}");
  const auto mesh_of = [](const planbench::Scene& scene) {
    return std::get<Mesh>(scene.objects[0].shapes[0].shape).triangles;
  };
  const SharedMesh mesh = mesh_of(ParseScene(text, resources_));
  EXPECT_EQ(mesh_of(ParseScene(text, resources_)).operator->(), mesh.operator->());
  EXPECT_NE(mesh_of(ParseScene(Scene("{resource: 'meshes/tri.obj'}"), resources_)), mesh);
  const std::filesystem::path file = folder_ / "meshes" / "tri.obj";
  std::ofstream(file) << "v 0 0 0\nv 5 0 0\nv 0 1 0\nf 1 2 3\n";
  std::filesystem::last_write_time(
      file, std::filesystem::last_write_time(file) + std::chrono::seconds(1));
  EXPECT_NE(mesh_of(ParseScene(text, resources_)), mesh);
}

TEST_F(MeshFile, IsLookedForUnlessEveryListOfMeshesIsEmpty) {
  for (const char* text :
       {"", "id: table", "meshes: []\nmesh_poses:   [] \n", "{meshes: [], mesh_poses: []}",
        "meshes: []\r\nprimitives: []", "id: \"a\\tb\"\nmeshes: []"}) {
    EXPECT_FALSE(MayHaveMesh(text)) << text;
  }
  for (const char* text :
       {"mesh: a.obj", "meshes: [a.obj]", "meshes: []\n---\nmesh: a.obj", "meshes:\n  - a.obj",
        "meshes: &none []", "meshes: [] # of mesh.obj", "\"meshes\": [a.obj]",
        "? meshes\n: [a.obj]", "{mesh_poses: [], meshes: [a.obj]}", "meshes: [",
        "\"\\x6desh\": a.obj", "\"me\\u0073hes\": [a.obj]", "\"\\U0000006desh\": a.obj",
        "\"me\\\n  sh\": a.obj"}) {
    EXPECT_TRUE(MayHaveMesh(text)) << text;
  }
  EXPECT_TRUE(MayHaveMesh(Scene("tri.obj")));
}

TEST_F(MeshFile, MissingResourceNamesTheLineOfTheScene) {
  try {
    ParseScene(Scene("{resource: 'package://things/meshes/none.obj'}"), resources_);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("scene.yaml:5: world.collision_objects[0].meshes[0].resource: "));
    EXPECT_THAT(error.what(), HasSubstr("none.obj"));
  }
}

}  // namespace
}  // namespace planbench
