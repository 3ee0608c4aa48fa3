#include "scene/moveit_scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "scene/moveit_fields.h"
#include "scene/moveit_messages.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// The default entries alone.
AllowedCollisionMatrix ReadDefaults(const YamlNode& node) {
  AllowedCollisionMatrix matrix;
  const std::vector<YamlNode> names = OptionalElements(node, "default_entry_names");
  const std::vector<YamlNode> values = OptionalElements(node, "default_entry_values");
  if (names.size() != values.size()) {
    node.Fail("has " + std::to_string(names.size()) + " default_entry_names but " +
              std::to_string(values.size()) + " default_entry_values");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = ReadName(names[i]);
    if (matrix.default_entries().contains(name)) names[i].Fail("'" + name + "' is named twice");
    matrix.SetDefaultEntry(name, ReadFlag(values[i]));
  }
  return matrix;
}

bool AreJoined(const RobotModel& model, const std::string& link_a, const std::string& link_b) {
  const int a = model.FindLink(link_a);
  const int b = model.FindLink(link_b);
  return a >= 0 && b >= 0 && model.Joined(a, b);
}

}  // namespace

void RequireScene(const YamlNode& planning_scene) {
  if (!planning_scene.IsMap()) {
    planning_scene.Fail("expected a moveit_msgs/PlanningScene, found no map");
  }
  RequireKnownFields(planning_scene, "moveit_msgs/PlanningScene");
  const std::vector<std::string> fields = planning_scene.Keys();
  if (std::all_of(fields.begin(), fields.end(),
                  [](const std::string& field) { return field.starts_with("x-"); })) {
    planning_scene.Fail(
        "holds no field of moveit_msgs/PlanningScene; an empty scene has a name, or 'world: {}'");
  }
  for (const auto& [list, field, neutral] :
       {std::tuple{"link_padding", "padding", 0.0}, std::tuple{"link_scale", "scale", 1.0}}) {
    for (const YamlNode& element : OptionalElements(planning_scene, list)) {
      const YamlNode value = element.At(field);
      if (value.Double() != neutral) {
        value.Fail(
            fmt::format("{} is not supported; only {:g} is, which changes nothing", list, neutral));
      }
    }
  }
  if (const auto is_diff = planning_scene.Find("is_diff"); is_diff && ReadFlag(*is_diff)) {
    is_diff->Warn("the scene is a difference to another one; taken as the whole");
  }
}

std::vector<FixedTransform> ReadFixedTransforms(const YamlNode& planning_scene) {
  std::vector<FixedTransform> transforms;
  for (const YamlNode& node : OptionalElements(planning_scene, "fixed_frame_transforms")) {
    const YamlNode child = node.At("child_frame_id");
    const YamlNode transform = node.At("transform");
    FixedTransform fixed{
        .header = ReadFrame(node), .child = WithoutSlash(child.String()), .X = {}, .node = node};
    if (fixed.child.empty()) child.Fail("must not be empty");
    fixed.X = ReadTransform(transform);
    transforms.push_back(fixed);
  }
  return transforms;
}

AllowedCollisionMatrix ReadAllowedCollisions(const YamlNode& node, const RobotModel& model) {
  const std::vector<YamlNode> nodes_of_names = OptionalElements(node, "entry_names");
  const std::vector<YamlNode> rows = OptionalElements(node, "entry_values");
  if (nodes_of_names.size() != rows.size()) {
    node.Fail("has " + std::to_string(nodes_of_names.size()) + " entry_names but " +
              std::to_string(rows.size()) + " entry_values");
  }
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const YamlNode& node_of_name : nodes_of_names) {
    names.push_back(ReadName(node_of_name));
    if (!seen.insert(names.back()).second) {
      node_of_name.Fail("'" + names.back() + "' is named twice");
    }
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
  AllowedCollisionMatrix matrix = ReadDefaults(node);
  for (std::size_t i = 0; i < names.size(); ++i) {
    ReadFlag(values[i][i]);  // Means nothing, but must be readable.
    for (std::size_t j = 0; j < i; ++j) {
      const bool allowed = ReadFlag(values[i][j]);
      if (allowed != ReadFlag(values[j][i])) {
        values[i][j].Fail("the matrix is not symmetric: '" + names[i] + "' against '" + names[j] +
                          "' is " + (allowed ? "true" : "false") + ", the reverse is not");
      }
      const bool by_default = matrix.Allowed(names[i], names[j]);
      if (allowed || by_default || AreJoined(model, names[i], names[j])) {
        matrix.SetEntry(names[i], names[j], allowed);
      }
    }
  }
  return matrix.Simplified();
}

}  // namespace planbench
