#pragma once

#include <Eigen/Geometry>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/error.h"
#include "messaging/field_rules.h"
#include "messaging/fields.h"
#include "messaging/mesh_store.h"
#include "planbench/lcmt_all.hpp"
#include "scene/pose.h"
#include "scene/scene.h"

/// The field lists (fields.h) of scenes, and what is converted there: poses, shapes, matrices.
namespace planbench {

template <>
struct Fields<Eigen::Isometry3d> : On<lcmt_pose> {
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

/// Calls `use` with each dimension of a shape, in the order that lcmt_shape has them in.
void ForEachDimension(auto& shape, const auto& use) {
  if constexpr (requires { shape.size; }) {
    for (int i = 0; i < 3; ++i) use(shape.size[i]);
  }
  if constexpr (requires { shape.radius; }) use(shape.radius);
  if constexpr (requires { shape.length; }) use(shape.length);
}

template <>
struct Fields<PlacedShape> : On<lcmt_shape> {
  template <typename Io>
  static void List(Io& io, auto& placed, auto& w) {
    std::int8_t type = 0;
    std::vector<double> dimensions;
    std::string resource, id;
    if constexpr (!Io::kReads) {
      type = static_cast<std::int8_t>(placed.shape.index());
      const auto add = [&](double dimension) { dimensions.push_back(dimension); };
      std::visit([&](const auto& shape) { ForEachDimension(shape, add); }, placed.shape);
      if (const auto* mesh = std::get_if<Mesh>(&placed.shape)) {
        // The store holds the scaled triangles, wherever they came from, so that the receiver needs
        // neither the package the resource is in nor the sender's working folder.
        resource = StoreMesh(mesh->triangles);
        id = mesh->triangles.id();
      }
    }
    io.Field("type", type, w.type);
    io.List("dimension", dimensions, w.dimension, w.num_dimensions, kPositive);
    io.Field("mesh_resource", resource, w.mesh_resource);
    io.Field("mesh_id", id, w.mesh_id);
    io.Field("pose", placed.X_FS, w.pose);
    if constexpr (Io::kReads) {
      static const std::array<Shape, std::variant_size_v<Shape>> kOfEachType = {
          Box{{0, 0, 0}}, Sphere{}, Cylinder{}, Cone{}, Capsule{}, HalfSpace{}, Mesh{}};
      io.Require(type >= 0 && type < std::ssize(kOfEachType), "type", "no such value: {}",
                 static_cast<int>(type));
      placed.shape = kOfEachType[static_cast<unsigned char>(type)];
      std::size_t size = 0;
      const auto set = [&](double& dimension) {
        if (size < dimensions.size()) dimension = dimensions[size];
        ++size;
      };
      std::visit([&](auto& shape) { ForEachDimension(shape, set); }, placed.shape);
      io.Require(dimensions.size() == size, "num_dimensions", "{} instead of {}", dimensions.size(),
                 size);
      if (auto* mesh = std::get_if<Mesh>(&placed.shape)) Load(io, resource, id, mesh);
    }
  }

 private:
  static void Load(auto& io, const std::string& resource, const std::string& id, Mesh* mesh) {
    io.Require(!resource.empty(), "mesh_resource", "is empty");
    mesh->resource = resource;
    try {
      mesh->triangles = LoadStoredMesh(resource, id);
    } catch (const InputError& error) {
      io.Require(false, "mesh_resource", "{}", error.what());
    }
    const std::string& found = mesh->triangles.id();
    io.Require(found == id, "mesh_id", "{} is {}, not {}", resource, found, id);
  }
};

template <>
struct Fields<SceneObject> : On<lcmt_scene_object> {
  static constexpr const char* kKey = "id";
  static const std::string& Key(const SceneObject& object) { return object.id; }
  static void List(auto& io, auto& object, auto& w) {
    io.Field("id", object.id, w.id, kNotEmpty);
    io.Field("pose", object.X_WO, w.pose);
    io.List("shape", object.shapes, w.shape, w.num_shapes);
  }
};

template <>
struct Fields<AttachedObject> : On<lcmt_attached_object> {
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
struct Fields<Scene> : On<lcmt_scene> {
  template <typename Io>
  static void List(Io& io, auto& scene, auto& w) {
    io.Field("name", scene.name, w.name);
    io.Field("robot_name", scene.robot_name, w.robot_name);
    io.Field("world_frame", scene.world_frame, w.world_frame);
    io.List("object", scene.objects, w.object, w.num_objects);
    io.List("attached", scene.attached, w.attached, w.num_attached);
    if constexpr (Io::kReads) {
      std::set<std::string_view> attached;
      for (const AttachedObject& one : scene.attached) attached.insert(one.object.id);
      for (const SceneObject& object : scene.objects) {
        io.Require(!attached.contains(object.id), "attached",
                   "'{}' is the name of an object of the world, too", object.id);
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
      for (std::size_t i = 0; i < a.size(); ++i) {
        matrix.SetEntry(std::move(a[i]), std::move(b[i]), allowed[i] != 0);
      }
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
