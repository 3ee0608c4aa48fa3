#include "tests/scene_server/tiny_world.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

constexpr char kLiftAndSwing[] = R"(
  <link name="base_link"/>
  <link name="mast"/>
  <joint name="lift" type="prismatic">
    <parent link="base_link"/><child link="mast"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.5" velocity="0.1" effort="1"/>
  </joint>
  <joint name="swing" type="continuous">
    <parent link="mast"/><child link="arm"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/><limit velocity="1" effort="1"/>
  </joint>
  <link name="finger"/>
)";

constexpr char kTinyUrdf[] = R"(<?xml version="1.0"?>
<robot name="tiny">{}
  <link name="arm"/>
  <joint name="finger_joint" type="prismatic">
    <parent link="arm"/><child link="finger"/>
    <origin xyz="0.5 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.3" velocity="1" effort="1"/>
  </joint>
</robot>
)";

constexpr char kTinyMeshUrdf[] = R"(<?xml version="1.0"?>
<robot name="tiny">{}
  <link name="arm">
    <collision><geometry><mesh filename="package://tiny_meshes/arm.obj"/></geometry></collision>
  </link>
  <joint name="finger_joint" type="fixed">
    <parent link="arm"/><child link="finger"/><origin xyz="0.5 0 0"/>
  </joint>
</robot>
)";

constexpr char kTinyRobotYaml[] = R"(name: tiny
urdf: tiny.urdf
spheres: spheres.yaml
edge_resolution_m: 0.02
groups:
  - {name: arm, joints: [swing, lift], tip_link: finger}
  - {name: lift_only, joints: [lift], tip_link: finger}
)";

constexpr char kTinySpheresYaml[] = R"(links:
  arm:
    - {center: [0.2, 0, 0], radius: 0.05}
    - {center: [0.3, 0, 0], radius: 0.05}
    - {center: [0.4, 0, 0], radius: 0.05}
    - {center: [0.5, 0, 0], radius: 0.05}
  finger:
    - {center: [0, 0, 0], radius: 0.05}
)";

// A box from x 0.15 to 0.55, y -0.05 to 0.05, z -0.5 to 0.5.
constexpr char kArmObj[] = R"(v 0.15 -0.05 -0.5
v 0.55 -0.05 -0.5
v 0.55 0.05 -0.5
v 0.15 0.05 -0.5
v 0.15 -0.05 0.5
v 0.55 -0.05 0.5
v 0.55 0.05 0.5
v 0.15 0.05 0.5
f 1 3 2
f 1 4 3
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
)";

SceneObject UprightCylinder(const std::string& id, double x, double y, double radius,
                            double height) {
  SceneObject object;
  object.id = id;
  object.X_WO.translation() = Eigen::Vector3d(x, y, height / 2);
  object.shapes.emplace_back().shape = Cylinder{radius, height};
  return object;
}

}  // namespace

fs::path WriteTinyRobot(const TemporaryFolder& parent) {
  parent.Write("tiny/tiny.urdf", fmt::format(kTinyUrdf, kLiftAndSwing));
  parent.Write("tiny/spheres.yaml", kTinySpheresYaml);
  return parent.Write("tiny/robot.yaml", kTinyRobotYaml).parent_path();
}

fs::path WriteTinyMeshRobot(const TemporaryFolder& parent, const std::string& below) {
  parent.Write("tiny_meshes/arm.obj", kArmObj);
  return parent.Write("tiny_meshes/tiny.urdf", fmt::format(kTinyMeshUrdf, below + kLiftAndSwing))
      .parent_path();
}

Problem TinyProblem() {
  Problem problem;
  problem.scene.name = "cans";
  problem.scene.robot_name = "tiny";
  problem.scene.world_frame = "base_link";
  problem.scene.objects = {UprightCylinder("can", 0.5, 0, 0.05, 0.2),
                           UprightCylinder("post", -0.8, 0, 0.05, 0.2)};
  problem.start = {{"lift", "swing", "finger_joint"}, {0, kStartSwing, 0.05}};
  problem.goal = {{"lift", 0, 0, 0}, {"swing", kGoalSwing, 0, 0}};
  problem.group = "arm";
  problem.time_limit_s = 7;
  return problem;
}

void WriteTinyProblem(const Problem& problem, const fs::path& set, int index) {
  fs::create_directories(set);
  WriteProblem(problem, set / fmt::format("scene{:04}.yaml", index),
               set / fmt::format("request{:04}.yaml", index));
}

TinyWorld::TinyWorld(bool with_mesh_robot, const std::string& below_mesh_robot) {
  const fs::path set = folder_.path() / "problems" / "cans";
  Problem problem = TinyProblem();
  WriteTinyProblem(problem, set, 1);
  WriteTinyProblem(problem, set, 5);
  problem.scene.objects.pop_back();
  WriteTinyProblem(problem, set, 2);
  Robot robot = LoadRobot(WriteTinyRobot(folder_));
  std::optional<Robot> mesh_robot;
  if (with_mesh_robot)
    mesh_robot = LoadRefereeRobot(WriteTinyMeshRobot(folder_, below_mesh_robot), robot);
  service_ = std::make_unique<SceneService>(std::move(robot), std::move(mesh_robot),
                                            std::vector{folder_.path() / "problems"});
}

std::string TinyWorld::SceneIdOfFirst() {
  return service_->AnswerProblem({"id", "cans", 1}).problem.scene_id;
}

}  // namespace planbench
