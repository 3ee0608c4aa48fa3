// The meshes model: the URDF's collision geometry instead of spheres.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "collision/collision_checker.h"
#include "collision/link_geometry.h"
#include "collision/simd/robot_meshes.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/obj_text.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// The rail robot with collision geometry on its tool.
Robot RailRobotWith(const std::string& geometry, const std::filesystem::path& folder = {}) {
  Robot robot;
  robot.name = "rail_robot";
  robot.model = RobotModel::FromUrdf(R"(<robot name="rail_robot">
    <link name="base"/>
    <link name="tool"> <collision> <origin xyz="0 0 0.25" rpy="0 0 0"/>
      <geometry>)" + geometry + R"(</geometry> </collision> </link>
    <joint name="slide" type="prismatic"> <parent link="base"/> <child link="tool"/>
      <axis xyz="0 0 1"/> <limit lower="-10" upper="10" velocity="1" effort="1"/> </joint>
  </robot>)",
                                     "rail_robot.urdf");
  robot.groups = {robot.model.MakeGroup("rail", {"slide"}, "tool")};
  robot.resources.base_folder = folder;
  return robot;
}

constexpr char kBoxGeometry[] = R"(<box size="0.5 1 0.25"/>)";
constexpr char kMeshGeometry[] = R"(<mesh filename="meshes/box.obj" scale="0.5 1 0.25"/>)";

std::vector<double> Slide(double z) { return {z}; }

Eigen::Isometry3d AtHeight(double z) { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, z)); }

TEST(MeshesModelTest, AMeshFileOfABoxIsTheBox) {
  const TemporaryFolder folder;
  folder.Write("meshes/box.obj", ObjText(BoxMesh({1, 1, 1})));
  const Robot with_mesh = RailRobotWith(kMeshGeometry, folder.path());
  const Robot with_box = RailRobotWith(kBoxGeometry);
  const auto mesh =
      MakeCollisionChecker(with_mesh, with_mesh.groups.front(), CollisionModel::kMeshes);
  const auto box = MakeCollisionChecker(with_box, with_box.groups.front(), CollisionModel::kMeshes);
  int num_free = 0;
  int num = 0;
  std::mt19937_64 generator(9);
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    Scene scene = world.scene;
    scene.attached.clear();  // to links of another robot
    mesh->SetScene(scene, Slide(0));
    box->SetScene(scene, Slide(0));
    for (int i = 0; i < 60; ++i) {
      const auto q = Slide(std::uniform_real_distribution<double>(-1, 2)(generator));
      const ClosestPair of_box = box->FindClosest(q);
      const ClosestPair of_mesh = mesh->FindClosest(q);
      if (of_box.distance_m > 0 && of_box.distance_m < 1e-4) continue;
      ++num;
      num_free += box->IsFree(q) ? 1 : 0;
      EXPECT_EQ(box->IsFree(q), of_box.distance_m > 0);
      EXPECT_EQ(mesh->IsFree(q), box->IsFree(q));
      EXPECT_EQ(mesh->FindContact(q).has_value(), !mesh->IsFree(q));
      if (of_box.distance_m > 0 && !scene.objects.empty()) {
        EXPECT_NEAR(of_mesh.distance_m, of_box.distance_m, 1e-4);
      }
    }
  }
  EXPECT_GT(num_free, num / 10);
  EXPECT_LT(num_free, num * 9 / 10);
}

TEST(MeshesModelTest, KnowsExactDistances) {
  const Robot robot = RailRobotWith(kBoxGeometry);
  const auto checker = MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kMeshes);
  checker->SetScene(SceneWith("table", Box{{1, 1, 1}}), Slide(0));
  EXPECT_NEAR(checker->FindClosest(Slide(1)).distance_m, 0.625, 1e-6);
  EXPECT_TRUE(checker->IsFree(Slide(0.38)));
  EXPECT_FALSE(checker->IsFree(Slide(0.37)));
  EXPECT_EQ(checker->FindClosest(Slide(1)).body_a, "tool");
  EXPECT_EQ(checker->FindClosest(Slide(1)).body_b, "table");
}

TEST(MeshesModelTest, LinksAndObjectsInsideEachOtherCollide) {
  const TemporaryFolder folder;
  folder.Write("meshes/box.obj", ObjText(BoxMesh({1, 1, 1})));
  const Robot robot = RailRobotWith(kMeshGeometry, folder.path());
  const auto checker = MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kMeshes);
  Mesh room;
  room.triangles = BoxMesh({4, 4, 4});
  Mesh bead;
  bead.triangles = BoxMesh({0.01, 0.01, 0.01});
  const Eigen::Isometry3d in_tool(Eigen::Translation3d(0.1, 0.2, 0.3));
  for (const Scene& scene : {SceneWith("room", room), SceneWith("bead", bead, in_tool),
                             SceneWith("bead", Sphere{0.01}, in_tool),
                             SceneWith("bead", Cylinder{0.01, 0.01}, in_tool)}) {
    checker->SetScene(scene, Slide(0));
    EXPECT_FALSE(checker->IsFree(Slide(0)));
    EXPECT_LE(checker->FindClosest(Slide(0)).distance_m, 0);
    EXPECT_TRUE(checker->IsFree(Slide(5)));
  }
}

TEST(MeshesModelTest, TheMotionBoundReachesTheCornersOfTheGeometry) {
  Robot robot;
  robot.name = "arm";
  robot.model = RobotModel::FromUrdf(R"(<robot name="arm">
    <link name="base"/>
    <link name="rod"> <collision> <origin xyz="1 0 0"/>
      <geometry> <box size="0.5 0.25 0.1"/> </geometry> </collision> </link>
    <joint name="turn" type="continuous"> <parent link="base"/> <child link="rod"/>
      <axis xyz="0 0 1"/> <limit velocity="1" effort="1"/> </joint>
  </robot>)",
                                     "arm.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"turn"}, "rod")};
  const auto checker = MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kMeshes);
  checker->SetScene({}, Slide(0));
  ASSERT_EQ(checker->motion_bound().reach().size(), 1u);
  EXPECT_GE(checker->motion_bound().reach()[0], std::hypot(1.25, 0.125));
  EXPECT_LE(checker->motion_bound().reach()[0], 1.3);
}

TEST(MeshesModelTest, MillimetresTakenForMetresAreJudgedWithoutMuchMemoryAndTold) {
  const TemporaryFolder folder;
  folder.Write("meshes/box.obj", ObjText(BoxMesh({20, 20, 200})));
  Robot robot = RailRobotWith(R"(<mesh filename="meshes/box.obj"/>)", folder.path());
  for (const double radius_m : {0.0, 0.04}) {  // With a sphere pieces are cut smaller still.
    if (radius_m > 0) robot.spheres.push_back({1, Eigen::Vector3d::Zero(), radius_m});
    const auto checker = MakeCollisionChecker(robot, robot.groups.front(), CollisionModel::kMeshes);
    // From 100.5 m on; the tool reaches 100.25 m above the slide's position.
    checker->SetScene(SceneWith("lamp", Box{{1, 1, 1}}, AtHeight(101)), Slide(0));
    EXPECT_TRUE(checker->IsFree(Slide(0.2)));
    EXPECT_FALSE(checker->IsFree(Slide(0.3)));
  }
  const auto odd_sizes = [](const Robot& of) { return OddSizes(of, LoadLinkGeometry(of)); };
  EXPECT_THAT(odd_sizes(robot), testing::ElementsAre("link 'tool', meshes/box.obj: is 200 m large: "
                                                     "check its unit, and scale= in the URDF"));
  EXPECT_THAT(odd_sizes(RailRobotWith(kBoxGeometry)), testing::IsEmpty());
}

TEST(MeshesModelTest, RefusesRobotsWithoutTheirGeometry) {
  const TemporaryFolder folder;
  const Robot missing_file = RailRobotWith(kMeshGeometry, folder.path());
  const auto make = [](const Robot& robot, CollisionModel model) {
    return [&robot, model] { MakeCollisionChecker(robot, robot.groups.front(), model); };
  };
  ExpectInputError(make(missing_file, CollisionModel::kMeshes), {"meshes/box.obj"});
  ExpectInputError(make(missing_file, CollisionModel::kSpheres),
                   {"rail_robot", "collision spheres", "spheres model"});
  const Robot spheres_only = MakeRailRobot();
  ExpectInputError(make(spheres_only, CollisionModel::kMeshes),
                   {"rail_robot", "collision geometry", "meshes model"});
}

TEST(MeshesModelTest, PrismsOfHugeCylindersHaveAnEnd) {
  constexpr double kRadius = 1e12;  // m
  const LinkGeometry link{0, {PlacedShape{Cylinder{kRadius, 1}}}};
  const RobotMeshes meshes({link}, {});
  std::size_t num_triangles = 0;
  for (const auto& patch : meshes.patches) {
    for (const auto& group : patch.groups) {
      num_triangles += group.triangles.size();
      for (const Corners& triangle : group.triangles) {
        const Eigen::Vector3d middle = (triangle[0] + triangle[1]) / 2;
        if (triangle[0].z() == triangle[1].z()) continue;  // Of an edge within an end.
        EXPECT_GT(middle.head<2>().norm(), kRadius * (1 - 1e-9));
      }
    }
  }
  EXPECT_LT(num_triangles, 100'000u);
}

}  // namespace
}  // namespace planbench
