#pragma once

#include <gtest/gtest.h>

#include <string>

#include "scene/moveit_yaml.h"

namespace planbench {

/// A scene that uses every supported field once or more.
inline constexpr const char* kFullScene = R"(name: kitchen
robot_model_name: fetch
robot_state:
  joint_state:
    header: {frame_id: base_link}
    name: [a_joint, b_joint]
    position: [0.25, -1e-3]
  attached_collision_objects:
    - link_name: gripper_link
      object:
        id: tool
        header: {frame_id: gripper_link}
        primitives:
          - {type: cone, dimensions: [0.2, 0.04]}
        primitive_poses:
          - {position: [0, 0, 0.1], orientation: [0, 0, 0, 1]}
      touch_links: [l_finger, r_finger]
fixed_frame_transforms:
  - header: {frame_id: base_link}
    child_frame_id: base_link
    transform: {translation: [0, 0, 0], rotation: [0, 0, 0, 1]}
  - header: {frame_id: base_link}
    child_frame_id: camera
    transform: {translation: [0, 0, 1], rotation: [0, 0, 0.7071067811865475, 0.7071067811865476]}
allowed_collision_matrix:
  entry_names: [a, b, tool]
  entry_values:
    - [false, true, false]
    - [true, false, true]
    - [false, true, false]
  default_entry_names: [shelf, camera_mount]
  default_entry_values: [true, false]
world:
  collision_objects:
    - id: shelf
      header: {frame_id: base_link}
      operation: 0
      pose: {position: [1, 0, 0.5], orientation: [0, 0, 0.6, 0.8]}
      primitives:
        - {type: box, dimensions: [1.2, 0.4, 0.04]}
        - {type: sphere, dimensions: [0.05]}
      primitive_poses:
        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}
        - {position: [0.1, 0, 0.3], orientation: [0, 0, 0, 1]}
    - id: can
      header: {frame_id: camera}
      primitives:
        - {type: cylinder, dimensions: [0.14, 0.03]}
      primitive_poses:
        - {position: [0.5, 0, 0], orientation: [0, 0, 0, 1]}
    - id: wedge
      meshes:
        - vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
          triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
      mesh_poses:
        - {position: [-1, 0, 0], orientation: [0, 0, 0, 1]}
)";

/// A request that uses every supported field.
inline constexpr const char* kFullRequest = R"(group_name: arm
allowed_planning_time: 12.5
workspace_parameters:
  header: {frame_id: base_link}
  min_corner: [-1, -2, 0]
  max_corner: [1, 2, 3]
start_state:
  joint_state:
    name: [a_joint, b_joint]
    position: [0.5, 1]
goal_constraints:
  - joint_constraints:
      - {joint_name: a_joint, position: 1.5, tolerance_above: 0.25, tolerance_below: 0.125, weight: 1}
      - {joint_name: b_joint, position: -3.141592653589793}
)";

/// `text` with its one occurrence of `from` replaced.
inline std::string Replaced(const std::string& text, const std::string& from,
                            const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the base text lacks: " << from;
  if (at == std::string::npos) return text;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << "occurs twice: " << from;
  return text.substr(0, at) + to + text.substr(at + from.size());
}

/// A robot whose joints and links the texts name: a mast that turns (a_joint) and lifts (b_joint)
/// a gripper with two fixed fingers.
inline Robot TextRobot() {
  constexpr const char* kUrdf = R"(<robot name="fetch_urdf">
  <link name="base_link"/><link name="mast"/><link name="gripper_link"/>
  <link name="l_finger"/><link name="r_finger"/>
  <joint name="a_joint" type="continuous"><parent link="base_link"/><child link="mast"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="b_joint" type="prismatic"><parent link="mast"/><child link="gripper_link"/>
    <origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" velocity="1" effort="1"/></joint>
  <joint name="l" type="fixed"><parent link="gripper_link"/><child link="l_finger"/></joint>
  <joint name="r" type="fixed"><parent link="gripper_link"/><child link="r_finger"/></joint>
</robot>)";
  Robot robot;
  robot.name = "fetch";
  robot.model = RobotModel::FromUrdf(kUrdf, "text.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"a_joint", "b_joint"}, "gripper_link")};
  return robot;
}

/// The problem of two texts, called scene.yaml and request.yaml in errors.
inline Problem ParseProblem(const std::string& scene_text,
                            const std::string& request_text = kFullRequest,
                            const ResourceResolver& resources = {}) {
  return ParseProblem(YamlNode::Parse(scene_text, "scene.yaml"),
                      YamlNode::Parse(request_text, "request.yaml"), TextRobot(), resources);
}

}  // namespace planbench
