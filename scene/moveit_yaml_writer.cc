#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <stdexcept>

#include "common/error.h"
#include "common/write_file.h"
#include "common/yaml_text.h"
#include "scene/moveit_yaml.h"
#include "scene/pose.h"

namespace planbench {
namespace {

std::string Vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", YamlNumber(v.x()), YamlNumber(v.y()), YamlNumber(v.z()));
}

std::string Orientation(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q = OrientationOf(pose);
  return fmt::format("[{}, {}, {}, {}]", YamlNumber(q.x()), YamlNumber(q.y()), YamlNumber(q.z()),
                     YamlNumber(q.w()));
}

std::string TextList(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(YamlText(text));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string Header(const std::string& frame, const std::string& indent) {
  return fmt::format("{0}header:\n{0}  frame_id: {1}\n", indent, YamlText(frame));
}

std::string JointStateYaml(const JointState& state, const std::string& frame,
                           const std::string& indent) {
  std::vector<std::string> positions;
  for (const double position : state.positions) positions.push_back(YamlNumber(position));
  return indent + "joint_state:\n" + Header(frame, indent + "  ") +
         fmt::format("{0}  name: {1}\n{0}  position: [{2}]\n", indent, TextList(state.names),
                     fmt::join(positions, ", "));
}

struct ShapeWriter {
  std::string indent;  // Of the fields of a list element, after "- ".

  std::string operator()(const Box& box) const { return Primitive("box", Vector(box.size)); }
  std::string operator()(const Sphere& sphere) const {
    return Primitive("sphere", fmt::format("[{}]", YamlNumber(sphere.radius)));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return Primitive("cylinder", HeightRadius(cylinder.length, cylinder.radius));
  }
  std::string operator()(const Cone& cone) const {
    return Primitive("cone", HeightRadius(cone.length, cone.radius));
  }
  std::string operator()(const Capsule&) const {
    throw std::logic_error("a capsule cannot be written");  // ObjectFields has refused it
  }
  // shape_msgs/Plane: a x + b y + c z + d = 0 (see ReadCollisionObject).
  std::string operator()(const HalfSpace&) const { return "coef: [0, 0, 1, 0]\n"; }
  std::string operator()(const Mesh& mesh) const {
    if (!mesh.resource.empty()) {
      return fmt::format("resource: {}\n{}dimensions: {}\n", YamlText(mesh.resource), indent,
                         Vector(mesh.scale));
    }
    std::vector<std::string> vertices;
    for (const Eigen::Vector3d& vertex : mesh.triangles->vertices) {
      vertices.push_back(Vector(vertex));
    }
    std::vector<std::string> triangles;
    for (const auto& corners : mesh.triangles->triangles) {
      triangles.push_back(fmt::format("[{}]", fmt::join(corners, ", ")));
    }
    return fmt::format("vertices: [{}]\n{}triangles: [{}]\n", fmt::join(vertices, ", "), indent,
                       fmt::join(triangles, ", "));
  }

  std::string Primitive(const std::string& type, const std::string& dimensions) const {
    return fmt::format("type: {}\n{}dimensions: {}\n", type, indent, dimensions);
  }
  static std::string HeightRadius(double height, double radius) {
    return fmt::format("[{}, {}]", YamlNumber(height), YamlNumber(radius));
  }
};

std::string PoseFields(const Eigen::Isometry3d& pose, const std::string& indent) {
  return fmt::format("position: {}\n{}orientation: {}\n", Vector(pose.translation()), indent,
                     Orientation(pose));
}

std::string ShapeList(const std::vector<const PlacedShape*>& shapes, const std::string& shapes_key,
                      const std::string& poses_key, const std::string& indent) {
  if (shapes.empty()) return "";
  std::string yaml = indent + shapes_key + ":\n";
  for (const PlacedShape* placed : shapes) {
    yaml += indent + "  - " + std::visit(ShapeWriter{indent + "    "}, placed->shape);
  }
  yaml += indent + poses_key + ":\n";
  for (const PlacedShape* placed : shapes) {
    yaml += indent + "  - " + PoseFields(placed->X_FS, indent + "    ");
  }
  return yaml;
}

// The fields of a moveit_msgs/CollisionObject, each line at `indent`.
std::string ObjectFields(const SceneObject& object, const std::string& frame,
                         const std::string& indent) {
  if (object.id == kOctomapId) {
    throw InputError(fmt::format("'{}': octomaps cannot be written", object.id));
  }
  std::string yaml = fmt::format("{}id: {}\n", indent, YamlText(object.id)) + Header(frame, indent);
  if (object.X_WO.matrix() != Eigen::Isometry3d::Identity().matrix()) {
    yaml += indent + "pose:\n" + indent + "  " + PoseFields(object.X_WO, indent + "  ");
  }
  std::vector<const PlacedShape*> primitives;
  std::vector<const PlacedShape*> meshes;
  std::vector<const PlacedShape*> planes;
  for (const PlacedShape& placed : object.shapes) {
    if (std::holds_alternative<Capsule>(placed.shape)) {
      throw InputError(fmt::format("object '{}': MoveIt's files have no capsules", object.id));
    }
    (std::holds_alternative<Mesh>(placed.shape)        ? meshes
     : std::holds_alternative<HalfSpace>(placed.shape) ? planes
                                                       : primitives)
        .push_back(&placed);
  }
  return yaml + ShapeList(primitives, "primitives", "primitive_poses", indent) +
         ShapeList(meshes, "meshes", "mesh_poses", indent) +
         ShapeList(planes, "planes", "plane_poses", indent);
}

// Makes the fields of a map, each line at `indent` + "  ", an element of a list.
std::string ListElement(std::string fields, const std::string& indent) {
  fields[indent.size()] = '-';
  return fields;
}

std::string AttachedYaml(const std::vector<AttachedObject>& all, const std::string& indent) {
  std::string yaml = indent + "attached_collision_objects:\n";
  const std::string inner = indent + "    ";
  for (const AttachedObject& attached : all) {
    std::string fields = fmt::format("{}link_name: {}\n", inner, YamlText(attached.link));
    fields += inner + "object:\n" + ObjectFields(attached.object, attached.link, inner + "  ");
    fields += fmt::format("{}touch_links: {}\n", inner, TextList(attached.touch_links));
    yaml += ListElement(std::move(fields), indent + "  ");
  }
  return yaml;
}

// As MoveIt writes it: the frame in the header, the one that it is given in as the child.
std::string FrameYaml(const FrameTransform& frame, const std::string& world_frame) {
  return fmt::format(
      "  - header:\n      frame_id: {}\n    child_frame_id: {}\n    transform:\n"
      "      translation: {}\n      rotation: {}\n",
      YamlText(frame.frame), YamlText(world_frame), Vector(frame.X_WF.translation()),
      Orientation(frame.X_WF));
}

std::string AllowedCollisionsYaml(const AllowedCollisionMatrix& full_matrix) {
  const AllowedCollisionMatrix matrix = full_matrix.Simplified();
  if (matrix.entries().empty() && matrix.default_entries().empty()) return "";
  std::set<std::string> names;
  for (const auto& [pair, allowed] : matrix.entries()) names.insert({pair.first, pair.second});
  std::string yaml = "allowed_collision_matrix:\n";
  yaml += "  entry_names: " + TextList({names.begin(), names.end()}) + "\n";
  yaml += names.empty() ? "  entry_values: []\n" : "  entry_values:\n";
  for (const std::string& a : names) {
    std::vector<bool> row;
    for (const std::string& b : names) row.push_back(a != b && matrix.Allowed(a, b));
    yaml += fmt::format("    - [{}]\n", fmt::join(row, ", "));
  }
  if (!matrix.default_entries().empty()) {
    std::vector<std::string> default_names;
    std::vector<bool> values;
    for (const auto& [name, allowed] : matrix.default_entries()) {
      default_names.push_back(name);
      values.push_back(allowed);
    }
    yaml += "  default_entry_names: " + TextList(default_names) + "\n";
    yaml += fmt::format("  default_entry_values: [{}]\n", fmt::join(values, ", "));
  }
  return yaml;
}

}  // namespace

std::string SceneToYaml(const Problem& problem) {
  const Scene& scene = problem.scene;
  std::string yaml = fmt::format("name: {}\nrobot_model_name: {}\n", YamlText(scene.name),
                                 YamlText(scene.robot_name));
  yaml += "robot_state:\n" + JointStateYaml(problem.start, scene.world_frame, "  ");
  if (!scene.attached.empty()) yaml += AttachedYaml(scene.attached, "  ");
  if (!scene.world_frame.empty() || !scene.fixed_frames.empty()) {
    yaml += "fixed_frame_transforms:\n";
    if (!scene.world_frame.empty())
      yaml += FrameYaml({.frame = scene.world_frame}, scene.world_frame);
    for (const FrameTransform& frame : scene.fixed_frames) {
      yaml += FrameYaml(frame, scene.world_frame);
    }
  }
  yaml += AllowedCollisionsYaml(scene.allowed_collisions);
  yaml += "world:\n";
  yaml += scene.objects.empty() ? "  collision_objects: []\n" : "  collision_objects:\n";
  for (const SceneObject& object : scene.objects) {
    yaml += ListElement(ObjectFields(object, scene.world_frame, "      "), "    ");
  }
  return yaml;
}

std::string RequestToYaml(const Problem& problem) {
  std::string yaml = fmt::format("group_name: {}\nallowed_planning_time: {}\n",
                                 YamlText(problem.group), YamlNumber(problem.time_limit_s));
  if (problem.workspace) {
    yaml += "workspace_parameters:\n" + Header(problem.workspace->frame, "  ");
    yaml += "  min_corner: " + Vector(problem.workspace->min_corner) + "\n";
    yaml += "  max_corner: " + Vector(problem.workspace->max_corner) + "\n";
  }
  yaml += "start_state:\n" + JointStateYaml(problem.start, problem.scene.world_frame, "  ");
  yaml += "goal_constraints:\n";
  std::set<std::string> seen;  // Of the alternative; none names a joint twice.
  for (const JointGoal& goal : problem.goal) {
    if (seen.contains(goal.joint)) seen.clear();
    if (seen.empty()) yaml += "  - joint_constraints:\n";
    seen.insert(goal.joint);
    yaml += fmt::format("      - joint_name: {}\n        position: {}\n", YamlText(goal.joint),
                        YamlNumber(goal.position));
    if (goal.tolerance_above != 0 || goal.tolerance_below != 0) {
      yaml += fmt::format("        tolerance_above: {}\n        tolerance_below: {}\n",
                          YamlNumber(goal.tolerance_above), YamlNumber(goal.tolerance_below));
    }
  }
  return yaml;
}

void WriteProblem(const Problem& problem, const std::filesystem::path& scene_file,
                  const std::filesystem::path& request_file) {
  WriteFile(scene_file, SceneToYaml(problem));
  WriteFile(request_file, RequestToYaml(problem));
}

}  // namespace planbench
