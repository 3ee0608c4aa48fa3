#include "scene/moveit_messages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "common/text.h"

namespace planbench {
namespace {

struct Field {
  std::string_view name;
  std::string_view type = {};  // A message, or a list of such; empty for what has no fields.
};
using Messages = std::map<std::string_view, std::vector<Field>>;

// The messages of ROS 1 and 2 that a scene and a request consist of, with every field they have or
// had, and, after those, the dialects'.
const Messages& AllMessages() {
  static const Messages messages = {
      {"builtin/Time", {{"secs"}, {"nsecs"}, {"sec"}, {"nanosec"}, {"nsec"}}},
      {"std_msgs/Header", {{"seq"}, {"stamp", "builtin/Time"}, {"frame_id"}}},
      {"std_msgs/ColorRGBA", {{"r"}, {"g"}, {"b"}, {"a"}}},
      {"geometry_msgs/Vector3", {{"x"}, {"y"}, {"z"}}},
      {"geometry_msgs/Quaternion", {{"x"}, {"y"}, {"z"}, {"w"}}},
      {"geometry_msgs/Pose",
       {{"position", "geometry_msgs/Vector3"}, {"orientation", "geometry_msgs/Quaternion"}}},
      {"geometry_msgs/PoseStamped",
       {{"header", "std_msgs/Header"}, {"pose", "geometry_msgs/Pose"}}},
      {"geometry_msgs/Transform",
       {{"translation", "geometry_msgs/Vector3"}, {"rotation", "geometry_msgs/Quaternion"}}},
      {"geometry_msgs/TransformStamped",
       {{"header", "std_msgs/Header"},
        {"child_frame_id"},
        {"transform", "geometry_msgs/Transform"}}},
      {"geometry_msgs/Twist",
       {{"linear", "geometry_msgs/Vector3"}, {"angular", "geometry_msgs/Vector3"}}},
      {"geometry_msgs/Wrench",
       {{"force", "geometry_msgs/Vector3"}, {"torque", "geometry_msgs/Vector3"}}},
      {"geometry_msgs/Accel",
       {{"linear", "geometry_msgs/Vector3"}, {"angular", "geometry_msgs/Vector3"}}},
      {"geometry_msgs/Polygon", {{"points", "geometry_msgs/Vector3"}}},
      {"sensor_msgs/JointState",
       {{"header", "std_msgs/Header"}, {"name"}, {"position"}, {"velocity"}, {"effort"}}},
      {"sensor_msgs/MultiDOFJointState",
       {{"header", "std_msgs/Header"},
        {"joint_names"},
        {"transforms", "geometry_msgs/Transform"},
        {"twist", "geometry_msgs/Twist"},
        {"wrench", "geometry_msgs/Wrench"}}},
      {"trajectory_msgs/JointTrajectoryPoint",
       {{"positions"},
        {"velocities"},
        {"accelerations"},
        {"effort"},
        {"time_from_start", "builtin/Time"}}},
      {"trajectory_msgs/JointTrajectory",
       {{"header", "std_msgs/Header"},
        {"joint_names"},
        {"points", "trajectory_msgs/JointTrajectoryPoint"}}},
      {"shape_msgs/SolidPrimitive",
       {{"type"}, {"dimensions"}, {"polygon", "geometry_msgs/Polygon"}}},
      {"shape_msgs/MeshTriangle", {{"vertex_indices"}}},
      {"shape_msgs/Mesh",
       {{"triangles", "shape_msgs/MeshTriangle"},
        {"vertices", "geometry_msgs/Vector3"},
        {"resource"},
        {"dimensions", "geometry_msgs/Vector3"},
        {"scale", "geometry_msgs/Vector3"}}},
      {"shape_msgs/Plane", {{"coef"}}},
      {"object_recognition_msgs/ObjectType", {{"key"}, {"db"}}},
      {"octomap_msgs/Octomap",
       {{"header", "std_msgs/Header"}, {"binary"}, {"id"}, {"resolution"}, {"data"}}},
      {"octomap_msgs/OctomapWithPose",
       {{"header", "std_msgs/Header"},
        {"origin", "geometry_msgs/Pose"},
        {"octomap", "octomap_msgs/Octomap"}}},
      {"moveit_msgs/CollisionObject",
       {{"header", "std_msgs/Header"},
        {"pose", "geometry_msgs/Pose"},
        {"id"},
        {"type", "object_recognition_msgs/ObjectType"},
        {"primitives", "shape_msgs/SolidPrimitive"},
        {"primitive_poses", "geometry_msgs/Pose"},
        {"meshes", "shape_msgs/Mesh"},
        {"mesh_poses", "geometry_msgs/Pose"},
        {"planes", "shape_msgs/Plane"},
        {"plane_poses", "geometry_msgs/Pose"},
        {"subframe_names"},
        {"subframe_poses", "geometry_msgs/Pose"},
        {"operation"},
        {"primitive_pose", "geometry_msgs/Pose"},
        {"mesh", "shape_msgs/Mesh"},
        {"mesh_pose", "geometry_msgs/Pose"},
        {"plane_pose", "geometry_msgs/Pose"}}},
      {"moveit_msgs/AttachedCollisionObject",
       {{"link_name"},
        {"object", "moveit_msgs/CollisionObject"},
        {"touch_links"},
        {"detach_posture", "trajectory_msgs/JointTrajectory"},
        {"weight"}}},
      {"moveit_msgs/RobotState",
       {{"joint_state", "sensor_msgs/JointState"},
        {"multi_dof_joint_state", "sensor_msgs/MultiDOFJointState"},
        {"attached_collision_objects", "moveit_msgs/AttachedCollisionObject"},
        {"is_diff"}}},
      {"moveit_msgs/AllowedCollisionEntry", {{"enabled"}}},
      {"moveit_msgs/AllowedCollisionMatrix",
       {{"entry_names"},
        {"entry_values", "moveit_msgs/AllowedCollisionEntry"},
        {"default_entry_names"},
        {"default_entry_values"}}},
      {"moveit_msgs/LinkPadding", {{"link_name"}, {"padding"}}},
      {"moveit_msgs/LinkScale", {{"link_name"}, {"scale"}}},
      {"moveit_msgs/ObjectColor", {{"id"}, {"color", "std_msgs/ColorRGBA"}}},
      {"moveit_msgs/PlanningSceneWorld",
       {{"collision_objects", "moveit_msgs/CollisionObject"},
        {"octomap", "octomap_msgs/OctomapWithPose"}}},
      {"moveit_msgs/PlanningScene",
       {{"name"},
        {"robot_state", "moveit_msgs/RobotState"},
        {"robot_model_name"},
        {"fixed_frame_transforms", "geometry_msgs/TransformStamped"},
        {"allowed_collision_matrix", "moveit_msgs/AllowedCollisionMatrix"},
        {"link_padding", "moveit_msgs/LinkPadding"},
        {"link_scale", "moveit_msgs/LinkScale"},
        {"object_colors", "moveit_msgs/ObjectColor"},
        {"world", "moveit_msgs/PlanningSceneWorld"},
        {"is_diff"}}},
      {"moveit_msgs/JointConstraint",
       {{"joint_name"}, {"position"}, {"tolerance_above"}, {"tolerance_below"}, {"weight"}}},
      {"moveit_msgs/BoundingVolume",
       {{"primitives", "shape_msgs/SolidPrimitive"},
        {"primitive_poses", "geometry_msgs/Pose"},
        {"meshes", "shape_msgs/Mesh"},
        {"mesh_poses", "geometry_msgs/Pose"}}},
      {"moveit_msgs/PositionConstraint",
       {{"header", "std_msgs/Header"},
        {"link_name"},
        {"target_point_offset", "geometry_msgs/Vector3"},
        {"constraint_region", "moveit_msgs/BoundingVolume"},
        {"weight"}}},
      {"moveit_msgs/OrientationConstraint",
       {{"header", "std_msgs/Header"},
        {"orientation", "geometry_msgs/Quaternion"},
        {"link_name"},
        {"absolute_x_axis_tolerance"},
        {"absolute_y_axis_tolerance"},
        {"absolute_z_axis_tolerance"},
        {"parameterization"},
        {"weight"}}},
      {"moveit_msgs/VisibilityConstraint",
       {{"target_radius"},
        {"target_pose", "geometry_msgs/PoseStamped"},
        {"cone_sides"},
        {"sensor_pose", "geometry_msgs/PoseStamped"},
        {"max_view_angle"},
        {"max_range_angle"},
        {"sensor_view_direction"},
        {"weight"}}},
      {"moveit_msgs/Constraints",
       {{"name"},
        {"joint_constraints", "moveit_msgs/JointConstraint"},
        {"position_constraints", "moveit_msgs/PositionConstraint"},
        {"orientation_constraints", "moveit_msgs/OrientationConstraint"},
        {"visibility_constraints", "moveit_msgs/VisibilityConstraint"}}},
      {"moveit_msgs/TrajectoryConstraints", {{"constraints", "moveit_msgs/Constraints"}}},
      {"moveit_msgs/CartesianPoint",
       {{"pose", "geometry_msgs/Pose"},
        {"velocity", "geometry_msgs/Twist"},
        {"acceleration", "geometry_msgs/Accel"}}},
      {"moveit_msgs/CartesianTrajectoryPoint",
       {{"point", "moveit_msgs/CartesianPoint"}, {"time_from_start", "builtin/Time"}}},
      {"moveit_msgs/CartesianTrajectory",
       {{"header", "std_msgs/Header"},
        {"tracked_frame"},
        {"points", "moveit_msgs/CartesianTrajectoryPoint"}}},
      {"moveit_msgs/GenericTrajectory",
       {{"header", "std_msgs/Header"},
        {"joint_trajectory", "trajectory_msgs/JointTrajectory"},
        {"cartesian_trajectory", "moveit_msgs/CartesianTrajectory"}}},
      {"moveit_msgs/WorkspaceParameters",
       {{"header", "std_msgs/Header"},
        {"min_corner", "geometry_msgs/Vector3"},
        {"max_corner", "geometry_msgs/Vector3"}}},
      {"moveit_msgs/MotionPlanRequest",
       {{"workspace_parameters", "moveit_msgs/WorkspaceParameters"},
        {"start_state", "moveit_msgs/RobotState"},
        {"goal_constraints", "moveit_msgs/Constraints"},
        {"path_constraints", "moveit_msgs/Constraints"},
        {"trajectory_constraints", "moveit_msgs/TrajectoryConstraints"},
        {"reference_trajectories", "moveit_msgs/GenericTrajectory"},
        {"pipeline_id"},
        {"planner_id"},
        {"group_name"},
        {"num_planning_attempts"},
        {"allowed_planning_time"},
        {"max_velocity_scaling_factor"},
        {"max_acceleration_scaling_factor"},
        {"cartesian_speed_end_effector_link"},
        {"cartesian_speed_limited_link"},
        {"max_cartesian_speed"}}},
      {"moveit_msgs/MoveGroupGoal",
       {{"request", "moveit_msgs/MotionPlanRequest"}, {"planning_options"}}},
      {"moveit_msgs/MoveGroupActionGoal",
       {{"header", "std_msgs/Header"}, {"goal_id"}, {"goal", "moveit_msgs/MoveGroupGoal"}}},
  };
  return messages;
}

// Where a field of that name stands in a message of type `root`, "" if nowhere: the place that is
// fewest levels down.
std::string PlaceOf(std::string_view field, std::string_view root) {
  std::deque<std::pair<std::string_view, std::string>> open = {{root, ""}};
  std::set<std::string_view> seen = {root};
  while (!open.empty()) {
    const auto [type, path] = open.front();
    open.pop_front();
    for (const Field& known : AllMessages().at(type)) {
      const std::string place = (path.empty() ? "" : path + ".") + std::string(known.name);
      if (known.name == field) return place;
      if (!known.type.empty() && seen.insert(known.type).second)
        open.emplace_back(known.type, place);
    }
  }
  return "";
}

std::string Complaint(const std::string& key, std::string_view type, std::string_view root) {
  std::vector<std::string_view> names;
  for (const Field& field : AllMessages().at(type)) names.push_back(field.name);
  const std::string unknown = "unknown field '" + key + "' of " + std::string(type);
  // A letter is a coordinate's, of which there are many.
  if (key.size() > 1) {
    const std::string near = type == root ? "" : PlaceOf(key, type);
    if (!near.empty()) return unknown + "; its place there is " + near;
    if (const std::string place = PlaceOf(key, root); !place.empty()) {
      return unknown + "; its place is " + place;
    }
  }
  if (const std::string nearest = NearestName(key, names); !nearest.empty()) {
    return unknown + "; did you mean '" + nearest + "'?";
  }
  constexpr std::size_t kMost = 8;  // What a message of two lines has room for.
  if (names.size() > kMost) return unknown;
  return fmt::format("{}; known are: {}", unknown, fmt::join(names, ", "));
}

void Check(const YamlNode& node, std::string_view type, std::string_view root, bool is_root) {
  if (node.IsSequence()) {
    for (const YamlNode& element : node.Elements()) {
      if (element.IsMap()) Check(element, type, root, false);
    }
    return;
  }
  if (!node.IsMap()) return;
  const std::vector<Field>& fields = AllMessages().at(type);
  const auto find = [&](const std::string& key) {
    return std::find_if(fields.begin(), fields.end(),
                        [&](const Field& field) { return field.name == key; });
  };
  node.RequireKeys([&](const std::string& key) -> std::optional<std::string> {
    if (find(key) != fields.end() || (is_root && key.starts_with("x-"))) return std::nullopt;
    return Complaint(key, type, root);
  });
  for (const Field& field : fields) {
    if (field.type.empty()) continue;
    if (const auto value = node.Find(std::string(field.name))) {
      Check(*value, field.type, root, false);
    }
  }
}

}  // namespace

void RequireKnownFields(const YamlNode& message, const std::string& type) {
  Check(message, type, type, true);
}

}  // namespace planbench
