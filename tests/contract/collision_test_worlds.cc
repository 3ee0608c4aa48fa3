#include "tests/contract/collision_test_worlds.h"

#include <fstream>
#include <random>

#include "tests/contract/collision_oracle.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr char kTestArmUrdf[] = R"(<robot name="test_arm">
  <link name="base"/> <link name="torso"/> <link name="head"/> <link name="camera"/>
  <link name="upper"/> <link name="fore"/> <link name="hand"/> <link name="finger"/> <link name="pad"/>
  <joint name="lift" type="prismatic">
    <parent link="base"/> <child link="torso"/> <origin xyz="-0.1 0.05 0.4"/> <axis xyz="0 0 1"/>
    <limit lower="0" upper="0.4" velocity="1" effort="1"/>
  </joint>
  <joint name="neck" type="fixed">
    <parent link="torso"/> <child link="head"/> <origin xyz="0 0 0.5" rpy="0 0.2 0"/>
  </joint>
  <joint name="camera_mount" type="fixed">
    <parent link="head"/> <child link="camera"/> <origin xyz="0.1 0 0.1"/>
  </joint>
  <joint name="pan" type="revolute">
    <parent link="torso"/> <child link="upper"/> <origin xyz="0.15 0 0.2" rpy="0 0 0.3"/>
    <axis xyz="0 0 1"/> <limit lower="-2" upper="2" velocity="1" effort="1"/>
  </joint>
  <joint name="roll" type="continuous">
    <parent link="upper"/> <child link="fore"/> <origin xyz="0.4 0 0" rpy="0.1 -0.2 0.4"/>
    <axis xyz="1 0.5 0.25"/> <limit velocity="1" effort="1"/>
  </joint>
  <joint name="flex" type="revolute">
    <parent link="fore"/> <child link="hand"/> <origin xyz="0.35 0 0"/> <axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" velocity="1" effort="1"/>
  </joint>
  <joint name="finger_joint" type="prismatic">
    <parent link="hand"/> <child link="finger"/> <origin xyz="0.2 0 0"/> <axis xyz="0 1 0"/>
    <limit lower="0" upper="0.3" velocity="1" effort="1"/>
  </joint>
  <joint name="pad_mount" type="fixed">
    <parent link="finger"/> <child link="pad"/> <origin xyz="0.05 0 0" rpy="0 0 1"/>
  </joint>
</robot>)";

constexpr char kRailUrdf[] = R"(<robot name="rail_robot">
  <link name="base"/> <link name="tool"/>
  <joint name="slide" type="prismatic">
    <parent link="base"/> <child link="tool"/> <axis xyz="0 0 1"/>
    <limit lower="-10" upper="10" velocity="1" effort="1"/>
  </joint>
</robot>)";

void AddSpheres(Robot* robot, const std::string& link, const Vector3d& from, const Vector3d& to,
                double radius, int num) {
  for (int i = 0; i < num; ++i) {
    const double t = num == 1 ? 0 : static_cast<double>(i) / (num - 1);
    robot->spheres.push_back({robot->model.FindLink(link), from + t * (to - from), radius});
  }
}

constexpr int kCapsules = 4;

/// Kinds 0 to 3: boxes, cylinders, spheres, cones.
Shape RandomShape(std::mt19937_64* generator, int kind, double low, double high) {
  std::uniform_real_distribution<double> size(low, high);
  const double a = size(*generator);
  const double b = size(*generator);
  const double c = size(*generator);
  if (kind == kCapsules) return Capsule{a / 2, b};
  switch (kind % 4) {
    case 0:
      return Box{Vector3d(a, b, c)};
    case 1:
      return Cylinder{a / 2, b};
    case 2:
      return Sphere{a / 2};
    default:
      return Cone{a / 2, b};
  }
}

Eigen::Isometry3d At(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

AttachedObject Attach(const std::string& link, const std::string& id, const Shape& shape,
                      const Eigen::Isometry3d& X_LO, std::vector<std::string> touch_links) {
  return {link, {id, X_LO, {{shape, Eigen::Isometry3d::Identity()}}}, std::move(touch_links)};
}

}  // namespace

Robot MakeTestArm() {
  Robot robot;
  robot.name = "test_arm";
  robot.model = RobotModel::FromUrdf(kTestArmUrdf, "test_arm.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"roll", "lift", "flex", "pan"}, "hand")};
  AddSpheres(&robot, "base", {-0.2, -0.1, 0.1}, {-0.2, 0.2, 0.1}, 0.13, 7);
  AddSpheres(&robot, "torso", {0, 0, -0.1}, {0, 0, 0.3}, 0.11, 12);
  AddSpheres(&robot, "head", {0, 0, 0}, {0, 0, 0}, 0.12, 1);
  AddSpheres(&robot, "camera", {0.1, 0, 0}, {0.1, 0, 0}, 0.03, 1);
  AddSpheres(&robot, "upper", {0.1, 0, 0}, {0.35, 0, 0}, 0.06, 5);
  AddSpheres(&robot, "fore", {0.05, 0, 0}, {0.3, 0.02, 0}, 0.05, 6);
  AddSpheres(&robot, "hand", {0.05, 0, 0}, {0.15, 0, 0}, 0.045, 3);
  AddSpheres(&robot, "finger", {0, 0, 0}, {0.06, 0, 0}, 0.015, 4);
  AddSpheres(&robot, "pad", {0.02, 0, 0}, {0.02, 0, 0.02}, 0.01, 2);
  return robot;
}

Robot MakeSolidTestArm(const std::filesystem::path& folder) {
  std::string urdf = kTestArmUrdf;
  const auto give = [&urdf](const std::string& link, const std::string& xyz,
                            const std::string& geometry) {
    const std::string bare = "<link name=\"" + link + "\"/>";
    urdf.replace(urdf.find(bare), bare.size(),
                 "<link name=\"" + link + "\"> <collision> <origin xyz=\"" + xyz +
                     "\"/> <geometry>" + geometry + "</geometry> </collision> </link>");
  };
  give("base", "-0.2 0.05 0.1", R"(<box size="0.2 0.5 0.2"/>)");
  give("torso", "0 0 0.1", R"(<cylinder radius="0.1" length="0.5"/>)");
  give("upper", "0.22 0 0", R"(<box size="0.3 0.1 0.08"/>)");
  give("fore", "0.17 0 0", R"(<mesh filename="wedge.obj"/>)");
  give("hand", "0.1 0 0", R"(<box size="0.15 0.08 0.06"/>)");
  give("finger", "0.03 0 0", R"(<sphere radius="0.02"/>)");
  std::ofstream(folder / "wedge.obj") << "v -0.13 -0.05 -0.04\nv 0.13 -0.03 -0.03\n"
                                         "v 0.13 0.03 -0.03\nv -0.13 0.05 -0.04\nv 0 0 0.06\n"
                                         "f 1 4 3\nf 1 3 2\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
  Robot robot;
  robot.name = "solid_test_arm";
  robot.model = RobotModel::FromUrdf(urdf, "solid_test_arm.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"roll", "lift", "flex", "pan"}, "hand")};
  robot.resources.base_folder = folder;
  return robot;
}

Robot MakeRailRobot() {
  Robot robot;
  robot.name = "rail_robot";
  robot.model = RobotModel::FromUrdf(kRailUrdf, "rail_robot.urdf");
  robot.groups = {robot.model.MakeGroup("rail", {"slide"}, "tool")};
  robot.spheres = {{robot.model.FindLink("tool"), Vector3d::Zero(), 0.25}};
  return robot;
}

void AddObject(Scene* scene, const std::string& id, const Shape& shape,
               const Eigen::Isometry3d& X_WO) {
  scene->objects.push_back({id, X_WO, {{shape, Eigen::Isometry3d::Identity()}}});
}

Scene SceneWith(const std::string& id, const Shape& shape, const Eigen::Isometry3d& X_WO) {
  Scene scene;
  AddObject(&scene, id, shape, X_WO);
  return scene;
}

std::vector<NamedScene> MakeTestScenes() {
  std::mt19937_64 generator(20240614);
  std::vector<NamedScene> scenes;
  const auto add_random = [&generator](Scene* scene, int num, double low, double high, int kind) {
    for (int i = 0; i < num; ++i) {
      const Shape shape = RandomShape(&generator, kind < 0 ? i : kind, low, high);
      Eigen::Isometry3d X = RandomPose(&generator, 0.7);
      X.translation() += Vector3d(0.9, 0, 0.7);
      AddObject(scene, ShapeTypeName(shape) + std::to_string(i), shape, X);
    }
  };

  scenes.push_back({"nothing", {}});
  scenes.push_back({"primitives", {}});
  add_random(&scenes.back().scene, 12, 0.05, 0.4, -1);
  scenes.push_back({"tiny", {}});
  add_random(&scenes.back().scene, 60, 0.001, 0.01, -1);
  scenes.push_back({"cones", {}});
  add_random(&scenes.back().scene, 10, 0.1, 0.6, 3);

  Scene huge;
  AddObject(&huge, "floor", Box{Vector3d(100, 100, 10)}, At(0, 0, -5.2));
  AddObject(&huge, "wall", Box{Vector3d(0.001, 50, 50)}, At(1, 0, 0));
  AddObject(&huge, "planet", Sphere{1000}, At(0, 1000.8, 0));
  AddObject(&huge, "tower", Cylinder{50, 400}, At(0, -50.9, 0));
  AddObject(&huge, "hill", Cone{300, 300}, At(-200, 0, -10));
  AddObject(&huge, "far_away", Box{Vector3d(1, 1, 1)}, At(40, 40, 0));
  scenes.push_back({"huge", huge});

  Scene meshes;
  for (int i = 0; i < 4; ++i) {
    Mesh mesh;
    mesh.triangles = BoxMesh(Vector3d(0.3 + 0.1 * i, 0.25, 0.2));
    Eigen::Isometry3d X = RandomPose(&generator, 0.6);
    X.translation() += Vector3d(0.6, 0, 0.6);
    AddObject(&meshes, "mesh" + std::to_string(i), mesh, X);
  }
  scenes.push_back({"meshes", meshes});

  Scene several;
  for (int i = 0; i < 4; ++i) {
    Eigen::Isometry3d X_WO = RandomPose(&generator, 0.7);
    X_WO.translation() += Vector3d(0.6, 0, 0.6);
    SceneObject object{"cluster" + std::to_string(i), X_WO, {}};
    for (int k = 0; k < 4; ++k) {
      object.shapes.push_back({RandomShape(&generator, k, 0.02, 0.2), RandomPose(&generator, 0.2)});
    }
    several.objects.push_back(object);
  }
  scenes.push_back({"objects of several shapes", several});

  Scene carried;
  for (int i = 0; i < 12; ++i) {
    Eigen::Isometry3d X = RandomPose(&generator, 1.0);
    X.translation() += Vector3d(0.6, 0, 0.6);
    AddObject(&carried, "ball" + std::to_string(i), Sphere{0.05 + 0.01 * i}, X);
  }
  carried.attached = {
      Attach("hand", "held_box", Box{Vector3d(0.1, 0.2, 0.3)}, At(0.3, 0, 0), {"finger", "pad"}),
      Attach("pad", "held_ball", Sphere{0.04}, At(0.3, 0, 0), {"finger"}),
      Attach("head", "antenna", Cylinder{0.02, 0.6}, At(0, 0, 0.4), {})};
  carried.allowed_collisions.SetEntry("antenna", "held_box", true);
  carried.allowed_collisions.SetEntry("antenna", "camera", true);
  carried.allowed_collisions.SetEntry("held_box", "ball3", true);
  scenes.push_back({"attached objects", carried});

  Scene allowed = scenes[1].scene;
  AllowedCollisionMatrix& matrix = allowed.allowed_collisions;
  matrix.SetEntry("fore", "box0", true);
  matrix.SetEntry("hand", "box0", false);
  matrix.SetEntry("torso", "hand", true);
  matrix.SetEntry("base", "hand", true);
  matrix.SetDefaultEntry("cylinder1", true);
  matrix.SetEntry("cylinder1", "upper", false);
  matrix.SetDefaultEntry("pad", true);
  matrix.SetDefaultEntry("sphere2", false);
  scenes.push_back({"allowed pairs", allowed});

  scenes.push_back({"capsules", {}});
  add_random(&scenes.back().scene, 10, 0.05, 0.5, kCapsules);
  AddObject(&scenes.back().scene, "beam", Capsule{30, 200}, At(-31, 0, 0));

  Scene planes;
  AddObject(&planes, "floor", HalfSpace{}, At(3, -200, -0.1));
  Eigen::Isometry3d X_WS = At(1.2, 0, 0.7);
  X_WS.rotate(Eigen::AngleAxisd(-1.7, Vector3d(0.2, 1, 0.1).normalized()));
  AddObject(&planes, "wall", HalfSpace{}, X_WS);
  AddObject(&planes, "abyss", HalfSpace{}, At(0, 0, -50));
  AddObject(&planes, "ball", Sphere{0.1}, At(0.7, 0.3, 0.8));
  planes.attached = {Attach("hand", "held_ball", Sphere{0.05}, At(0.3, 0, 0), {"finger", "pad"})};
  scenes.push_back({"half-spaces", planes});
  return scenes;
}

}  // namespace planbench
