#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.h"
#include "messaging/field_rules.h"
#include "messaging/fields.h"
#include "messaging/mesh_store.h"
#include "planbench/lcmt_attached_object.hpp"
#include "planbench/lcmt_pose.hpp"
#include "planbench/lcmt_scene.hpp"
#include "planbench/lcmt_scene_object.hpp"
#include "planbench/lcmt_shape.hpp"
#include "scene/pose.h"
#include "scene/scene.h"

/// The field lists (fields.h) of scenes, and what is converted there: poses, shapes, matrices.
namespace planbench {

template <>
struct Fields<Eigen::Isometry3d> {
  using Wire = lcmt_pose;
  template <typename Io>
  static void List(Io& io, auto& pose, auto& w) {
    std::array<double, 3> position{};
    std::array<double, 4> wxyz{};
    if constexpr (!Io::kReads) {
      const Eigen::Vector3d p = pose.translation();
      const Eigen::Quaterniond q = OrientationOf(pose);
      position = {p.x(), p.y(), p.z()};
      wxyz = {q.w(), q.x(), q.y(), q.z()};
    }
    io.Field("position", position, w.position);
    io.Field("orientation_wxyz", wxyz, w.orientation_wxyz, kUnitLength);
    if constexpr (Io::kReads) {
      pose = PoseFromPositionOrientation({position[0], position[1], position[2]},
                                         {wxyz[0], wxyz[1], wxyz[2], wxyz[3]});
    }
  }
};

/// A shape as lcmt_shape has it.
struct ShapeFields {
  std::int8_t type = 0;
  std::vector<double> dimensions = {};
  std::string mesh_resource = {};
  std::string mesh_id = {};
  std::array<double, 3> mesh_scale = {1, 1, 1};
};

/// Puts meshes into the mesh store: the scaled triangles, wherever they came from, so that the
/// receiver needs neither the package the resource is in nor the sender's working folder.
ShapeFields FieldsOfShape(const Shape& shape);

/// What cannot be a shape is refused by io.Require.
template <typename Io>
Shape ShapeOfFields(Io& io, ShapeFields fields) {
  const std::vector<double>& d = fields.dimensions;
  const auto require_size = [&](std::size_t size) {
    io.Require(d.size() == size, "num_dimensions", "{} instead of {}", d.size(), size);
  };
  switch (fields.type) {
    case lcmt_shape::BOX:
      require_size(3);
      return Box{{d[0], d[1], d[2]}};
    case lcmt_shape::SPHERE:
      require_size(1);
      return Sphere{d[0]};
    case lcmt_shape::CYLINDER:
      require_size(2);
      return Cylinder{d[0], d[1]};
    case lcmt_shape::CONE:
      require_size(2);
      return Cone{d[0], d[1]};
    case lcmt_shape::CAPSULE:
      require_size(2);
      return Capsule{d[0], d[1]};
    case lcmt_shape::HALF_SPACE:
      require_size(0);
      return HalfSpace{};
    case lcmt_shape::MESH:
      require_size(0);
      break;
    default:
      io.Require(false, "type", "no such value: {}", static_cast<int>(fields.type));
  }
  io.Require(!fields.mesh_resource.empty(), "mesh_resource", "is empty");
  Mesh mesh;
  mesh.resource = std::move(fields.mesh_resource);
  mesh.scale = {fields.mesh_scale[0], fields.mesh_scale[1], fields.mesh_scale[2]};
  try {
    mesh.triangles = LoadStoredMesh(mesh.resource, mesh.scale);
  } catch (const InputError& error) {
    io.Require(false, "mesh_resource", "{}", error.what());
  }
  const std::string id = MeshId(mesh.triangles);
  io.Require(id == fields.mesh_id, "mesh_id", "{} is {}, not {}", mesh.resource, id,
             fields.mesh_id);
  return mesh;
}

template <>
struct Fields<PlacedShape> {
  using Wire = lcmt_shape;
  template <typename Io>
  static void List(Io& io, auto& placed, auto& w) {
    ShapeFields shape;
    if constexpr (!Io::kReads) shape = FieldsOfShape(placed.shape);
    io.Field("type", shape.type, w.type);
    io.List("dimension", shape.dimensions, w.dimension, w.num_dimensions, kPositive);
    io.Field("mesh_resource", shape.mesh_resource, w.mesh_resource);
    io.Field("mesh_id", shape.mesh_id, w.mesh_id);
    io.Field("mesh_scale", shape.mesh_scale, w.mesh_scale, kNonZero);
    io.Field("pose", placed.X_FS, w.pose);
    if constexpr (Io::kReads) {
      placed.shape = ShapeOfFields(io, std::move(shape));
    }
  }
};

template <>
struct Fields<SceneObject> {
  using Wire = lcmt_scene_object;
  static constexpr const char* kKey = "id";
  static const std::string& Key(const SceneObject& object) { return object.id; }
  static void List(auto& io, auto& object, auto& w) {
    io.Field("id", object.id, w.id, kNotEmpty);
    io.Field("pose", object.X_WO, w.pose);
    io.List("shape", object.shapes, w.shape, w.num_shapes);
  }
};

template <>
struct Fields<AttachedObject> {
  using Wire = lcmt_attached_object;
  static constexpr const char* kKey = "object.id";
  static const std::string& Key(const AttachedObject& attached) { return attached.object.id; }
  static void List(auto& io, auto& attached, auto& w) {
    io.Field("link", attached.link, w.link, kNotEmpty);
    io.Field("object", attached.object, w.object);
    io.List("touch_link", attached.touch_links, w.touch_link, w.num_touch_links, kNames);
  }
};

/// All that is in lcmt_scene of the scene itself.
template <>
struct Fields<Scene> {
  using Wire = lcmt_scene;
  template <typename Io>
  static void List(Io& io, auto& scene, auto& w) {
    io.Field("name", scene.name, w.name);
    io.Field("robot_name", scene.robot_name, w.robot_name);
    io.Field("world_frame", scene.world_frame, w.world_frame);
    io.List("object", scene.objects, w.object, w.num_objects);
    io.List("attached", scene.attached, w.attached, w.num_attached);
    if constexpr (Io::kReads) {
      std::set<std::string_view> ids;
      for (const SceneObject& object : scene.objects) ids.insert(object.id);
      for (const AttachedObject& attached : scene.attached) {
        io.Require(!ids.contains(attached.object.id), "attached",
                   "'{}' is the name of an object of the world, too", attached.object.id);
      }
    }
    ListAllowedCollisions(io, scene.allowed_collisions, w);
    ListFrames(io, scene.fixed_frames, w);
  }

 private:
  template <typename Io>
  static void ListAllowedCollisions(Io& io, auto& matrix, auto& w) {
    std::vector<std::string> a, b, names;
    std::vector<std::int8_t> allowed, allowed_by_default;
    if constexpr (!Io::kReads) {
      for (const auto& [pair, is_allowed] : matrix.entries()) {
        a.push_back(pair.first);
        b.push_back(pair.second);
        allowed.push_back(is_allowed);
      }
      for (const auto& [name, is_allowed] : matrix.default_entries()) {
        names.push_back(name);
        allowed_by_default.push_back(is_allowed);
      }
    }
    io.List("body_a", a, w.body_a, w.num_allowed, kNotEmpty);
    io.Beside("body_b", b, w.body_b, w.num_allowed, kNotEmpty);
    io.Beside("allowed", allowed, w.allowed, w.num_allowed, kBoolean);
    io.List("default_body", names, w.default_body, w.num_defaults, kNames);
    io.Beside("default_allowed", allowed_by_default, w.default_allowed, w.num_defaults, kBoolean);
    if constexpr (Io::kReads) {
      for (std::size_t i = 0; i < a.size(); ++i) matrix.SetEntry(a[i], b[i], allowed[i] != 0);
      for (std::size_t i = 0; i < names.size(); ++i) {
        matrix.SetDefaultEntry(names[i], allowed_by_default[i] != 0);
      }
    }
  }

  template <typename Io>
  static void ListFrames(Io& io, auto& frames, auto& w) {
    std::vector<std::string> names;
    std::vector<Eigen::Isometry3d> poses;
    if constexpr (!Io::kReads) {
      for (const FrameTransform& frame : frames) {
        names.push_back(frame.frame);
        poses.push_back(frame.X_WF);
      }
    }
    io.List("frame", names, w.frame, w.num_frames, kNames);
    io.Beside("frame_pose", poses, w.frame_pose, w.num_frames);
    if constexpr (Io::kReads) {
      for (std::size_t i = 0; i < names.size(); ++i) frames.push_back({names[i], poses[i]});
    }
  }
};

}  // namespace planbench
