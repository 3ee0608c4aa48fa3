#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "planning/planner.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// The planar arm of tests/data/planar3: reach 1.2 m about the z axis, first joint continuous,
/// column held by the joint `lift`.
inline Robot LoadPlanarRobot() {
  return LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "tests/data/planar3");
}

inline Robot LoadFetch() {
  return LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch");
}

/// A box with edges along the axes. Centre and size in m.
inline void AddBox(Scene* scene, const std::string& id, const Eigen::Vector3d& center,
                   const Eigen::Vector3d& size) {
  SceneObject box;
  box.id = id;
  box.X_WO.translation() = center;
  box.shapes.push_back({Box{size}});
  scene->objects.push_back(box);
}

inline Scene EmptyPlanarScene() {
  Scene scene;
  scene.world_frame = "base";
  return scene;
}

/// Two posts on the circle of 0.9 m: the arm must fold to pass them.
inline Scene PostsScene() {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "post_ahead", {0.9, 0, 0}, {0.1, 0.1, 0.2});
  AddBox(&scene, "post_behind", {-0.9, 0, 0}, {0.1, 0.1, 0.2});
  return scene;
}

/// Walls along the x axis that no configuration of the arm crosses: left and right of them are
/// worlds apart.
inline Scene WallsScene() {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "wall_ahead", {0.8, 0, 0}, {1.2, 0.04, 0.2});
  AddBox(&scene, "wall_behind", {-0.8, 0, 0}, {1.2, 0.04, 0.2});
  return scene;
}

/// Start and goal for the first group of a robot; joints outside it at their default.
inline PlanRequest MakeRequest(const Robot& robot, const Configuration& start,
                               const Configuration& goal, double tolerance = 0) {
  const PlanningGroup& group = robot.groups.front();
  PlanRequest request;
  request.request_id = "test";
  request.time_limit_s = 60;
  for (int j = 0; j < group.space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    request.start.names.push_back(group.space.joint(j).name);
    request.start.positions.push_back(start[k]);
    request.goal.push_back({group.space.joint(j).name, goal[k], tolerance, tolerance});
  }
  return request;
}

/// A table before the Fetch. Of the robot's own links only the arm beyond the elbow is checked
/// against the body.
inline Scene FetchTableScene(const Robot& fetch) {
  Scene scene;
  scene.world_frame = "base_link";
  AddBox(&scene, "table", {0.85, 0, 0.5}, {0.6, 1.2, 0.04});
  constexpr std::array<std::string_view, 3> kBody = {"base_link", "torso_fixed_link",
                                                     "torso_lift_link"};
  constexpr std::array<std::string_view, 7> kArm = {
      "forearm_roll_link", "wrist_flex_link",       "wrist_roll_link",      "gripper_link",
      "elbow_flex_link",   "l_gripper_finger_link", "r_gripper_finger_link"};
  const auto among = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const Link& a : fetch.model.links()) {
    for (const Link& b : fetch.model.links()) {
      const bool checked = among(kBody, a.name) && among(kArm, b.name);
      const bool checked_mirrored = among(kBody, b.name) && among(kArm, a.name);
      if (a.name < b.name && !checked && !checked_mirrored) {
        scene.allowed_collisions.SetEntry(a.name, b.name, true);
      }
    }
  }
  return scene;
}

/// The Fetch's tucked arm, and the arm stretched over the table of FetchTableScene.
inline Configuration FetchTucked() { return {0.1, 1.32, 1.4, -0.2, 1.72, 0, 1.66, 0}; }
inline Configuration FetchOverTable() { return {0.35, 0.2, 0.1, 0, 0.4, 0, 0.9, 0}; }

}  // namespace planbench
