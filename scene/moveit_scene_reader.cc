#include <cmath>
#include <map>
#include <set>

#include "scene/moveit_fields.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_yaml.h"
#include "scene/pose.h"

namespace planbench {
namespace {

void RefuseUnsupported(const YamlNode& scene) {
  for (const auto& [list, field, neutral] :
       {std::tuple{"link_padding", "padding", 0.0}, std::tuple{"link_scale", "scale", 1.0}}) {
    for (const YamlNode& element : OptionalElements(scene, list)) {
      const YamlNode value = element.At(field);
      if (value.Double() != neutral) value.Fail(std::string(list) + " is not supported");
    }
  }
  const std::optional<YamlNode> world = scene.Find("world");
  const std::optional<YamlNode> octomap_with_pose = world ? world->Find("octomap") : std::nullopt;
  if (!octomap_with_pose) return;
  const std::optional<YamlNode> octomap = octomap_with_pose->Find("octomap");
  if (octomap) RefuseElements(*octomap, "data", "octomaps are not supported");
}

// Refuses a file that is something else, say a request: every field of a scene is optional, and a
// scene without obstacles must not come out of a wrong file.
void RequireSceneFields(const YamlNode& scene) {
  if (!scene.IsMap()) scene.Fail("expected a moveit_msgs/PlanningScene, found no map");
  for (const char* field : {"world", "robot_state", "allowed_collision_matrix",
                            "fixed_frame_transforms", "robot_model_name"}) {
    if (scene.Find(field)) return;
  }
  scene.Fail("holds no field of moveit_msgs/PlanningScene (world, robot_state, ...)");
}

// The frame W that the scene is in. `fixed_frame_transforms` gives poses in the planning frame,
// which its headers name. Without them it is the frame of the robot's state, else the frame most
// objects are in (the first of these, if two are equally frequent).
std::string FindWorldFrame(const YamlNode& scene, const std::vector<YamlNode>& objects) {
  for (const YamlNode& transform : OptionalElements(scene, "fixed_frame_transforms")) {
    const std::string frame = ReadFrame(transform);
    if (!frame.empty()) return frame;
  }
  if (const std::optional<YamlNode> robot_state = scene.Find("robot_state")) {
    const std::optional<YamlNode> joint_state = robot_state->Find("joint_state");
    const std::string frame = joint_state ? ReadFrame(*joint_state) : "";
    if (!frame.empty()) return frame;
  }
  std::map<std::string, int> counts;
  std::string most_frequent;
  for (const YamlNode& object : objects) {
    const std::string frame = ReadFrame(object);
    if (!frame.empty()) ++counts[frame];
  }
  for (const YamlNode& object : objects) {
    const std::string frame = ReadFrame(object);
    if (!frame.empty() && (most_frequent.empty() || counts[frame] > counts[most_frequent])) {
      most_frequent = frame;
    }
  }
  return most_frequent;
}

std::vector<FrameTransform> ReadFixedFrames(const YamlNode& scene, const std::string& world_frame) {
  std::vector<FrameTransform> frames;
  std::set<std::string> names;
  for (const YamlNode& node : OptionalElements(scene, "fixed_frame_transforms")) {
    const std::string parent = ReadFrame(node);
    if (!parent.empty() && parent != world_frame) {
      node.Fail("gives a pose in the frame '" + parent + "', the others in '" + world_frame + "'");
    }
    FrameTransform frame;
    const YamlNode child = node.At("child_frame_id");
    frame.frame = child.String();
    if (frame.frame.empty()) child.Fail("must not be empty");
    if (!names.insert(frame.frame).second)
      child.Fail("the frame '" + frame.frame + "' is given twice");
    const YamlNode transform = node.At("transform");
    const Eigen::Vector3d translation = ReadVector3(transform.At("translation"));
    frame.X_WF = CanonicalPose(
        PoseFromPositionOrientation(translation, ReadQuaternion(transform.At("rotation"))));
    if (frame.frame != world_frame) {
      frames.push_back(frame);
    } else if (!frame.X_WF.isApprox(Eigen::Isometry3d::Identity(), 1e-9)) {
      transform.Fail("the frame '" + world_frame +
                     "' has a pose other than the identity in itself");
    }
  }
  return frames;
}

// Pose of the frame an object is given in.
Eigen::Isometry3d FrameInWorld(const YamlNode& object, const Scene& scene) {
  const std::string frame = ReadFrame(object);
  if (frame.empty() || frame == scene.world_frame) return Eigen::Isometry3d::Identity();
  for (const FrameTransform& fixed : scene.fixed_frames) {
    if (fixed.frame == frame) return fixed.X_WF;
  }
  std::string known = "'" + scene.world_frame + "'";
  for (const FrameTransform& fixed : scene.fixed_frames) known += ", '" + fixed.frame + "'";
  object.At("header").At("frame_id").Fail("unknown frame '" + frame + "'; known are: " + known);
}

bool ReadFlag(const YamlNode& node) {
  // uint8 flags are written as numbers by some tools.
  if (node.IsScalar() && (node.String() == "0" || node.String() == "1")) {
    return node.String() == "1";
  }
  return node.Bool();
}

AllowedCollisionMatrix ReadAllowedCollisions(const YamlNode& node) {
  AllowedCollisionMatrix matrix;
  const std::vector<YamlNode> names = OptionalElements(node, "entry_names");
  const std::vector<YamlNode> rows = OptionalElements(node, "entry_values");
  if (names.size() != rows.size()) {
    node.Fail("has " + std::to_string(names.size()) + " entry_names but " +
              std::to_string(rows.size()) + " entry_values");
  }
  std::set<std::string> seen;
  for (const YamlNode& node_of_name : names) {
    const std::string name = node_of_name.String();
    if (!seen.insert(name).second) node_of_name.Fail("'" + name + "' is named twice");
  }
  std::vector<std::vector<YamlNode>> values;
  for (const YamlNode& row : rows) {
    const YamlNode flags = row.IsMap() ? row.At("enabled") : row;
    values.push_back(flags.Elements());
    if (values.back().size() != names.size()) {
      flags.Fail("has " + std::to_string(values.back().size()) + " values for " +
                 std::to_string(names.size()) + " entry_names");
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    ReadFlag(values[i][i]);  // Means nothing, but must be readable.
    for (std::size_t j = 0; j < i; ++j) {
      const bool allowed = ReadFlag(values[i][j]);
      if (allowed != ReadFlag(values[j][i])) {
        values[i][j].Fail("the matrix is not symmetric: '" + names[i].String() + "' against '" +
                          names[j].String() + "' is " + (allowed ? "true" : "false") +
                          ", the reverse is not");
      }
      matrix.SetEntry(names[i].String(), names[j].String(), allowed);
    }
  }

  const std::vector<YamlNode> default_names = OptionalElements(node, "default_entry_names");
  const std::vector<YamlNode> defaults = OptionalElements(node, "default_entry_values");
  if (default_names.size() != defaults.size()) {
    node.Fail("has " + std::to_string(default_names.size()) + " default_entry_names but " +
              std::to_string(defaults.size()) + " default_entry_values");
  }
  for (std::size_t i = 0; i < default_names.size(); ++i) {
    const std::string name = default_names[i].String();
    if (matrix.default_entries().contains(name)) {
      default_names[i].Fail("'" + name + "' is named twice");
    }
    matrix.SetDefaultEntry(name, ReadFlag(defaults[i]));
  }
  return matrix.Simplified();
}

}  // namespace

Scene ReadScene(const YamlNode& planning_scene, const ResourceResolver& resources) {
  RequireSceneFields(planning_scene);
  RefuseUnsupported(planning_scene);
  Scene scene;
  scene.name = planning_scene.StringOr("name", "");
  scene.robot_name = planning_scene.StringOr("robot_model_name", "");

  const std::optional<YamlNode> world = planning_scene.Find("world");
  const std::vector<YamlNode> objects =
      world ? OptionalElements(*world, "collision_objects") : std::vector<YamlNode>();
  scene.world_frame = FindWorldFrame(planning_scene, objects);
  scene.fixed_frames = ReadFixedFrames(planning_scene, scene.world_frame);

  std::set<std::string> ids;
  for (const YamlNode& node : objects) {
    SceneObject object = ReadCollisionObject(node, resources);
    if (!ids.insert(object.id).second) {
      node.At("id").Fail("the object '" + object.id + "' is given twice");
    }
    object.X_WO = CanonicalPose(FrameInWorld(node, scene) * object.X_WO);
    scene.objects.push_back(std::move(object));
  }
  if (const std::optional<YamlNode> robot_state = planning_scene.Find("robot_state")) {
    AddAttachedObjects(*robot_state, resources, &scene);
  }
  AddAttachedObjects(planning_scene, resources, &scene);
  if (const auto matrix = planning_scene.Find("allowed_collision_matrix")) {
    scene.allowed_collisions = ReadAllowedCollisions(*matrix);
  }
  return scene;
}

}  // namespace planbench
