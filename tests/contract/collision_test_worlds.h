#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// An arm with every kind of joint, made for the collision tests: its group's order is not that of
/// the chain, a camera is welded to the torso over two fixed joints, a finger is held at an opening
/// that the scene sets, one axis is oblique, the first axis does not pass through the base frame's
/// origin. Group "arm": roll (continuous), lift (prismatic), flex, pan.
Robot MakeTestArm();

/// The test arm with boxes, cylinders and, in folder/wedge.obj, which is written, a mesh for
/// collision geometry: for the meshes model.
Robot MakeSolidTestArm(const std::filesystem::path& folder);

/// One link "tool" on a vertical rail (group "rail": joint "slide", -10 to 10 m), a sphere of
/// radius 0.25 m at its origin; the base has none. All of its figures are exact in binary.
Robot MakeRailRobot();

/// A scene of one object with one shape.
Scene SceneWith(const std::string& id, const Shape& shape,
                const Eigen::Isometry3d& X_WO = Eigen::Isometry3d::Identity());
void AddObject(Scene* scene, const std::string& id, const Shape& shape,
               const Eigen::Isometry3d& X_WO);

struct NamedScene {
  std::string what;
  Scene scene;
};
/// Generated scenes for an arm that reaches about 1.5 m: rotated primitives of all kinds, tiny
/// ones, huge ones, cones, closed meshes, objects of several shapes, attached objects, allowed
/// pairs, capsules, half-spaces, nothing.
std::vector<NamedScene> MakeTestScenes();

}  // namespace planbench
