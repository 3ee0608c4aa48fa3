#include "geometry/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/content_hash.h"
#include "common/error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// Changes with the layout of what is hashed, so that ids of different layouts never meet.
constexpr const char* kMeshLayout = "planbench mesh 1";

double FarthestDistance(const TriangleMesh& mesh, const Vector3d& from) {
  double farthest = 0;
  for (const Vector3d& vertex : mesh.vertices) {
    farthest = std::max(farthest, (vertex - from).squaredNorm());
  }
  return std::sqrt(farthest);
}

const Vector3d& FarthestVertex(const TriangleMesh& mesh, const Vector3d& from) {
  return *std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                           [&from](const Vector3d& a, const Vector3d& b) {
                             return (a - from).squaredNorm() < (b - from).squaredNorm();
                           });
}

BoundingSphere BoxCentredSphere(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return {box.center(), FarthestDistance(mesh, box.center())};
}

// Ritter, "An efficient bounding sphere", Graphics Gems 1990: the sphere over two distant vertices,
// grown to take in every other.
BoundingSphere RitterSphere(const TriangleMesh& mesh) {
  const Vector3d& a = FarthestVertex(mesh, mesh.vertices.front());
  const Vector3d& b = FarthestVertex(mesh, a);
  Vector3d center = (a + b) / 2;
  double radius = (b - a).norm() / 2;
  for (const Vector3d& vertex : mesh.vertices) {
    const double distance = (vertex - center).norm();
    if (distance <= radius) continue;
    const double grown = (radius + distance) / 2;
    center += (vertex - center) * ((grown - radius) / distance);
    radius = grown;
  }
  // Rounding in the growth must not leave a vertex outside.
  return {center, FarthestDistance(mesh, center)};
}

struct BoundingSphereOf {
  BoundingSphere operator()(const Box& box) const {
    return {Vector3d::Zero(), box.size.norm() / 2};
  }

  BoundingSphere operator()(const Sphere& sphere) const {
    return {Vector3d::Zero(), sphere.radius};
  }

  BoundingSphere operator()(const Cylinder& cylinder) const {
    return {Vector3d::Zero(), std::hypot(cylinder.radius, cylinder.length / 2)};
  }

  // The circumscribed circle of the triangle through apex and base, unless that triangle is obtuse
  // at the apex: then the base circle alone decides.
  BoundingSphere operator()(const Cone& cone) const {
    const double r = cone.radius;
    const double l = cone.length;
    if (r >= l) return {Vector3d(0, 0, -l / 2), r};
    const double circumradius = (r * r + l * l) / (2 * l);
    return {Vector3d(0, 0, l / 2 - circumradius), circumradius};
  }

  BoundingSphere operator()(const Capsule& capsule) const {
    return {Vector3d::Zero(), capsule.radius + capsule.length / 2};
  }

  BoundingSphere operator()(const HalfSpace&) const {
    return {Vector3d::Zero(), std::numeric_limits<double>::infinity()};
  }

  BoundingSphere operator()(const Mesh& mesh) const {
    if (mesh.triangles->vertices.empty()) {
      throw InputError("mesh '" + mesh.resource + "': has no vertices (not loaded?)");
    }
    const BoundingSphere by_box = BoxCentredSphere(mesh.triangles);
    const BoundingSphere by_ritter = RitterSphere(mesh.triangles);
    return by_ritter.radius < by_box.radius ? by_ritter : by_box;
  }
};

std::string FaultOf(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "has no triangles";
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index < mesh.vertices.size()) continue;
      return fmt::format("has {} vertices, a triangle names vertex {}", mesh.vertices.size(),
                         index);
    }
  }
  for (const Vector3d& vertex : mesh.vertices) {
    if (!vertex.allFinite()) return "has a vertex that is not finite";
  }
  return "";
}

struct TypeNameOf {
  std::string operator()(const Box&) const { return "box"; }
  std::string operator()(const Sphere&) const { return "sphere"; }
  std::string operator()(const Cylinder&) const { return "cylinder"; }
  std::string operator()(const Cone&) const { return "cone"; }
  std::string operator()(const Capsule&) const { return "capsule"; }
  std::string operator()(const HalfSpace&) const { return "half-space"; }
  std::string operator()(const Mesh&) const { return "mesh"; }
};

}  // namespace

std::string MeshId(const TriangleMesh& mesh) {
  ContentHash hash;
  hash.Add(kMeshLayout);
  hash.Add(mesh.vertices.size());
  for (const Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : vertex) hash.Add(coordinate);
  }
  hash.Add(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) hash.Add(static_cast<std::int64_t>(index));
  }
  return hash.HexDigest();
}

SharedMesh::SharedMesh() {
  static const SharedMesh empty = TriangleMesh();
  content_ = empty.content_;
}

SharedMesh::SharedMesh(TriangleMesh mesh) {
  Content content;
  content.fault = FaultOf(mesh);
  if (content.fault.empty()) {
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) content.box.extend(mesh.vertices[index]);
    }
  }
  content.id = MeshId(mesh);
  content.mesh = std::move(mesh);
  content_ = std::make_shared<const Content>(std::move(content));
}

std::string ShapeTypeName(const Shape& shape) { return std::visit(TypeNameOf{}, shape); }

BoundingSphere ComputeBoundingSphere(const Shape& shape) {
  return std::visit(BoundingSphereOf{}, shape);
}

}  // namespace planbench
