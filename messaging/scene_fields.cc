#include "messaging/scene_fields.h"

#include <variant>

namespace planbench {
namespace {

struct ToFields {
  ShapeFields operator()(const Box& box) const {
    return {lcmt_shape::BOX, {box.size.x(), box.size.y(), box.size.z()}};
  }
  ShapeFields operator()(const Sphere& sphere) const {
    return {lcmt_shape::SPHERE, {sphere.radius}};
  }
  ShapeFields operator()(const Cylinder& cylinder) const {
    return {lcmt_shape::CYLINDER, {cylinder.radius, cylinder.length}};
  }
  ShapeFields operator()(const Cone& cone) const {
    return {lcmt_shape::CONE, {cone.radius, cone.length}};
  }
  ShapeFields operator()(const Capsule& capsule) const {
    return {lcmt_shape::CAPSULE, {capsule.radius, capsule.length}};
  }
  ShapeFields operator()(const HalfSpace&) const { return {lcmt_shape::HALF_SPACE, {}}; }
  ShapeFields operator()(const Mesh& mesh) const {
    return {lcmt_shape::MESH, {}, StoreMesh(mesh.triangles), MeshId(mesh.triangles)};
  }
};

}  // namespace

ShapeFields FieldsOfShape(const Shape& shape) { return std::visit(ToFields{}, shape); }

}  // namespace planbench
