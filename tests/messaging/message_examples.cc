#include "tests/messaging/message_examples.h"

#include <cmath>

namespace planbench {
namespace {

Eigen::Isometry3d Pose(double x, double y, double z, double angle) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.linear() =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  return pose;
}

}  // namespace

TriangleMesh ExampleMesh() {
  return {{{1.0 / 3, 0.1, -1e-17}, {0.2, 1.0 / 7, 0}, {-0.3, 0.1, 1e-3}, {0.1, 0.1, std::sqrt(2)}},
          {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
}

Scene ExampleScene() {
  Scene scene;
  scene.name = "table";
  scene.robot_name = "arm";
  scene.world_frame = "base";
  SceneObject table{"table", Pose(0.5, 0, 0.2, 0.3), {}};
  table.shapes.push_back({Box{{1, 0.5, 0.04}}, Pose(0, 0, 0.1, 0)});
  table.shapes.push_back({Cylinder{0.03, 0.5}, Pose(0.1, 0.2, 0, 1.7)});
  table.shapes.push_back({Sphere{0.1}, Pose(0.3, 0, 0, 3.1)});
  table.shapes.push_back({Cone{0.1, 0.2}, Pose(0, -0.3, 0, -2)});
  table.shapes.push_back({Capsule{0.05, 0.3}, Pose(0, 0.4, 0, 0.5)});
  table.shapes.push_back({HalfSpace{}, Pose(0, 0, -0.2, 1)});
  scene.objects.push_back(table);
  Mesh mesh;
  mesh.triangles = ExampleMesh();
  scene.objects.push_back({"rock", Pose(1.0 / 3, 2, 0, 0.1), {{mesh, Pose(0, 0, 0.7, 0.9)}}});
  scene.attached.push_back(
      {"gripper", {"can", Pose(0.1, 0, 0, 1), {{Cylinder{0.03, 0.14}}}}, {"finger_l", "finger_r"}});
  scene.allowed_collisions.SetEntry("base", "shoulder", true);
  scene.allowed_collisions.SetEntry("can", "table", false);
  scene.allowed_collisions.SetDefaultEntry("estop", true);
  scene.fixed_frames.push_back({"camera", Pose(0, 0, 1, 2)});
  return scene;
}

}  // namespace planbench
