#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/scene/problem_texts.h"

namespace planbench {

// In these tests the robot's mast is turned by a quarter: the gripper is at (0, 1, 0), its x axis
// along y.
inline constexpr const char* kBallRequest = R"(
start_state: {joint_state: {name: [a_joint, b_joint], position: [1.5707963267948966, 0]}}
goal_constraints:
  - joint_constraints: [{joint_name: a_joint, position: 1}, {joint_name: b_joint, position: 0}]
)";

inline std::string Transform(const std::string& header, const std::string& child,
                             const std::string& translation,
                             const std::string& rotation = "0, 0, 0, 1") {
  return "  - {header: {frame_id: '" + header + "'}, child_frame_id: '" + child +
         "', transform: {translation: [" + translation + "], rotation: [" + rotation + "]}}\n";
}

// A ball at (1, 0, 0) of a frame, and more of a scene.
inline std::string BallIn(const std::string& frame, const std::string& more = "") {
  return "robot_model_name: fetch\n" + more +
         "world:\n  collision_objects:\n    - id: ball\n      header: {frame_id: '" + frame +
         "'}\n      primitives: [{type: sphere, dimensions: [0.1]}]\n"
         "      primitive_poses: [{position: [1, 0, 0], orientation: [0, 0, 0, 1]}]\n";
}

inline Eigen::Vector3d PlaceOf(const SceneObject& object) {
  return object.X_WO * object.shapes.front().X_FS.translation();
}

inline Eigen::Vector3d Ball(const std::string& scene, const std::string& request = kBallRequest) {
  return PlaceOf(ParseProblem(scene, request).scene.objects.at(0));
}

inline void ExpectAt(const Eigen::Vector3d& actual, double x, double y, double z) {
  EXPECT_TRUE((actual - Eigen::Vector3d(x, y, z)).isZero(1e-9)) << actual.transpose();
}

inline constexpr const char* kTransforms = "fixed_frame_transforms:\n";
// A quarter turn about z.
inline constexpr const char* kQuarter = "0, 0, 0.7071067811865476, 0.7071067811865476";

inline std::string RootAt(const std::string& frame, const std::string& translation,
                          const std::string& rotation = "0, 0, 0, 1") {
  return "  multi_dof_joint_state:\n    header: {frame_id: '" + frame +
         "'}\n    joint_names: [world_joint]\n    transforms: [{translation: [" + translation +
         "], rotation: [" + rotation + "]}]\n    twist: []\n    wrench: []\n";
}

}  // namespace planbench
