#include <fmt/format.h>

#include <cmath>
#include <set>
#include <type_traits>
#include <variant>

#include "messaging/mesh_store.h"
#include "messaging/wire.h"
#include "planbench/lcmt_pose.hpp"
#include "planbench/lcmt_scene.hpp"
#include "planbench/lcmt_scene_object.hpp"
#include "planbench/lcmt_scene_request.hpp"
#include "planbench/lcmt_shape.hpp"
#include "scene/pose.h"

namespace planbench {
namespace wire {
namespace {

// How far from 1 the length of a quaternion on the wire may be.
constexpr double kUnitTolerance = 1e-6;

lcmt_pose ToWire(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q = OrientationOf(pose);
  lcmt_pose wire{};
  for (int i = 0; i < 3; ++i) wire.position[i] = pose.translation()[i];
  wire.orientation_wxyz[0] = q.w();
  wire.orientation_wxyz[1] = q.x();
  wire.orientation_wxyz[2] = q.y();
  wire.orientation_wxyz[3] = q.z();
  return wire;
}

Eigen::Isometry3d FromWire(const lcmt_pose& wire, const Field& at) {
  Eigen::Vector3d position;
  for (std::size_t i = 0; i < 3; ++i) {
    position[static_cast<int>(i)] = Finite(wire.position[i], at("position", i));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    Finite(wire.orientation_wxyz[i], at("orientation_wxyz", i));
  }
  const Eigen::Quaterniond q(wire.orientation_wxyz[0], wire.orientation_wxyz[1],
                             wire.orientation_wxyz[2], wire.orientation_wxyz[3]);
  if (!(std::abs(q.norm() - 1) <= kUnitTolerance)) {
    at("orientation_wxyz").Fail(fmt::format("length {} instead of 1", q.norm()));
  }
  return PoseFromPositionOrientation(position, q);
}

struct ShapeWriter {
  lcmt_shape* wire;

  void operator()(const Box& box) const {
    Set(lcmt_shape::BOX, {box.size.x(), box.size.y(), box.size.z()});
  }
  void operator()(const Sphere& sphere) const { Set(lcmt_shape::SPHERE, {sphere.radius}); }
  void operator()(const Cylinder& cylinder) const {
    Set(lcmt_shape::CYLINDER, {cylinder.radius, cylinder.length});
  }
  void operator()(const Cone& cone) const { Set(lcmt_shape::CONE, {cone.radius, cone.length}); }
  void operator()(const Capsule& capsule) const {
    Set(lcmt_shape::CAPSULE, {capsule.radius, capsule.length});
  }
  void operator()(const HalfSpace&) const { Set(lcmt_shape::HALF_SPACE, {}); }
  // The store holds the scaled triangles, wherever they came from, so that the receiver needs
  // neither the package the resource is in nor the sender's working folder.
  void operator()(const Mesh& mesh) const {
    Set(lcmt_shape::MESH, {});
    wire->mesh_resource = StoreMesh(mesh.triangles);
    wire->mesh_id = MeshId(mesh.triangles);
  }

  void Set(std::int8_t type, std::vector<double> dimensions) const {
    wire->type = type;
    wire->dimension = std::move(dimensions);
    wire->num_dimensions = Count(wire->dimension.size());
  }
};

lcmt_shape ToWire(const PlacedShape& placed) {
  lcmt_shape wire{};
  std::visit(ShapeWriter{&wire}, placed.shape);
  for (double& factor : wire.mesh_scale) factor = 1;
  wire.pose = ToWire(placed.X_FS);
  return wire;
}

Mesh MeshFromWire(const lcmt_shape& wire, const Field& at) {
  Mesh mesh;
  mesh.resource = NotEmpty(wire.mesh_resource, at("mesh_resource"));
  for (std::size_t i = 0; i < 3; ++i) {
    if (wire.mesh_scale[i] == 0) at("mesh_scale", i).Fail("is 0");
    mesh.scale[static_cast<int>(i)] = wire.mesh_scale[i];
  }
  try {
    mesh.triangles = LoadStoredMesh(mesh.resource, mesh.scale);
  } catch (const InputError& error) {
    at("mesh_resource").Fail(error.what());
  }
  const std::string id = MeshId(mesh.triangles);
  if (id != wire.mesh_id) {
    at("mesh_id").Fail(fmt::format("{} is {}, not {}", mesh.resource, id, wire.mesh_id));
  }
  return mesh;
}

Shape ShapeFromWire(const lcmt_shape& wire, const Field& at) {
  std::size_t num_dimensions = 0;
  switch (wire.type) {
    case lcmt_shape::BOX:
      num_dimensions = 3;
      break;
    case lcmt_shape::SPHERE:
      num_dimensions = 1;
      break;
    case lcmt_shape::CYLINDER:
    case lcmt_shape::CONE:
    case lcmt_shape::CAPSULE:
      num_dimensions = 2;
      break;
    case lcmt_shape::HALF_SPACE:
    case lcmt_shape::MESH:
      break;
    default:
      at("type").Fail(fmt::format("no such value: {}", static_cast<int>(wire.type)));
  }
  const std::vector<double>& d = wire.dimension;
  if (d.size() != num_dimensions) {
    at("num_dimensions").Fail(fmt::format("{} instead of {}", d.size(), num_dimensions));
  }
  for (std::size_t i = 0; i < d.size(); ++i) Positive(d[i], at("dimension", i));
  for (std::size_t i = 0; i < 3; ++i) Finite(wire.mesh_scale[i], at("mesh_scale", i));
  switch (wire.type) {
    case lcmt_shape::BOX:
      return Box{{d[0], d[1], d[2]}};
    case lcmt_shape::SPHERE:
      return Sphere{d[0]};
    case lcmt_shape::CYLINDER:
      return Cylinder{d[0], d[1]};
    case lcmt_shape::CONE:
      return Cone{d[0], d[1]};
    case lcmt_shape::CAPSULE:
      return Capsule{d[0], d[1]};
    case lcmt_shape::HALF_SPACE:
      return HalfSpace{};
    default:
      return MeshFromWire(wire, at);
  }
}

lcmt_scene_object ToWire(const SceneObject& object) {
  lcmt_scene_object wire{};
  wire.id = object.id;
  wire.pose = ToWire(object.X_WO);
  for (const PlacedShape& placed : object.shapes) wire.shape.push_back(ToWire(placed));
  wire.num_shapes = Count(wire.shape.size());
  return wire;
}

lcmt_scene_object ToWire(const AttachedObject& attached) {
  if (attached.link.empty()) throw std::logic_error("an attached object without a link");
  lcmt_scene_object wire = ToWire(attached.object);
  wire.attached_link = attached.link;
  wire.touch_link = attached.touch_links;
  wire.num_touch_links = Count(wire.touch_link.size());
  return wire;
}

SceneObject FromWire(const lcmt_scene_object& wire, const Field& at) {
  SceneObject object;
  object.id = NotEmpty(wire.id, at("id"));
  object.X_WO = FromWire(wire.pose, at("pose"));
  for (std::size_t i = 0; i < wire.shape.size(); ++i) {
    const Field where = at("shape", i);
    object.shapes.push_back(
        {ShapeFromWire(wire.shape[i], where), FromWire(wire.shape[i].pose, where("pose"))});
  }
  return object;
}

void WriteScene(const Scene& scene, lcmt_scene* wire) {
  wire->name = scene.name;
  wire->robot_name = scene.robot_name;
  wire->world_frame = scene.world_frame;
  for (const SceneObject& object : scene.objects) wire->object.push_back(ToWire(object));
  for (const AttachedObject& attached : scene.attached) wire->object.push_back(ToWire(attached));
  wire->num_objects = Count(wire->object.size());
  for (const auto& [pair, allowed] : scene.allowed_collisions.entries()) {
    wire->body_a.push_back(pair.first);
    wire->body_b.push_back(pair.second);
    wire->allowed.push_back(allowed ? 1 : 0);
  }
  wire->num_allowed = Count(wire->allowed.size());
  for (const auto& [name, allowed] : scene.allowed_collisions.default_entries()) {
    wire->default_body.push_back(name);
    wire->default_allowed.push_back(allowed ? 1 : 0);
  }
  wire->num_defaults = Count(wire->default_allowed.size());
  for (const FrameTransform& frame : scene.fixed_frames) {
    wire->frame.push_back(frame.frame);
    wire->frame_pose.push_back(ToWire(frame.X_WF));
  }
  wire->num_frames = Count(wire->frame.size());
}

Scene ReadScene(const lcmt_scene& wire, const Field& at) {
  Scene scene;
  scene.name = wire.name;
  scene.robot_name = wire.robot_name;
  scene.world_frame = wire.world_frame;
  std::set<std::string_view> ids;
  for (std::size_t i = 0; i < wire.object.size(); ++i) {
    const Field where = at("object", i);
    const lcmt_scene_object& object = wire.object[i];
    if (!ids.insert(object.id).second) {
      where("id").Fail(fmt::format("'{}' occurs twice", object.id));
    }
    if (object.attached_link.empty()) {
      scene.objects.push_back(FromWire(object, where));
    } else {
      scene.attached.push_back({object.attached_link, FromWire(object, where),
                                Names(object.touch_link, where, "touch_link")});
    }
  }
  for (std::size_t i = 0; i < wire.allowed.size(); ++i) {
    scene.allowed_collisions.SetEntry(NotEmpty(wire.body_a[i], at("body_a", i)),
                                      NotEmpty(wire.body_b[i], at("body_b", i)),
                                      Bool(wire.allowed[i], at("allowed", i)));
  }
  Names(wire.default_body, at, "default_body");
  for (std::size_t i = 0; i < wire.default_body.size(); ++i) {
    scene.allowed_collisions.SetDefaultEntry(
        wire.default_body[i], Bool(wire.default_allowed[i], at("default_allowed", i)));
  }
  Names(wire.frame, at, "frame");
  for (std::size_t i = 0; i < wire.frame.size(); ++i) {
    scene.fixed_frames.push_back(
        {wire.frame[i], FromWire(wire.frame_pose[i], at("frame_pose", i))});
  }
  return scene;
}

}  // namespace
}  // namespace wire

using wire::Field;

template <>
std::vector<std::uint8_t> Encode(const SceneRequestMessage& message) {
  lcmt_scene_request wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.scene_id = message.scene_id;
  return wire::Pack(wire);
}

template <>
SceneRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_scene_request>(bytes, channel);
  const Field at(channel, message.request_id);
  return {wire::NotEmpty(message.request_id, at("request_id")),
          wire::NotEmpty(message.scene_id, at("scene_id"))};
}

template <>
std::vector<std::uint8_t> Encode(const SceneMessage& message) {
  lcmt_scene wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.scene_id = message.scene_id;
  wire.ok = message.ok;
  wire.message = message.message;
  if (message.ok) wire::WriteScene(message.scene, &wire);
  return wire::Pack(wire);
}

template <>
SceneMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_scene>(bytes, channel);
  const Field at(channel, wire.request_id);
  SceneMessage message;
  message.request_id = wire.request_id;
  message.scene_id = wire.scene_id;
  message.ok = wire::Bool(wire.ok, at("ok"));
  message.message = wire.message;
  if (!message.ok) return message;
  message.scene = wire::ReadScene(wire, at);
  const std::string id = SceneId(message.scene);
  if (id != message.scene_id) {
    at("scene_id").Fail(fmt::format("the content is {}, not {}", id, message.scene_id));
  }
  return message;
}

}  // namespace planbench
