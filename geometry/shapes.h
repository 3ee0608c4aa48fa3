#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace planbench {

/// Box centred at its frame's origin, edges along the axes.
struct Box {
  Eigen::Vector3d size;  ///< Edge lengths along x, y, z, m.
  bool operator==(const Box&) const = default;
};

/// Sphere centred at its frame's origin.
struct Sphere {
  double radius;  ///< m
  bool operator==(const Sphere&) const = default;
};

/// Cylinder with flat caps, axis along z, centred at its frame's origin.
struct Cylinder {
  double radius;  ///< m
  double length;  ///< Along z, m.
  bool operator==(const Cylinder&) const = default;
};

/// Cone, axis along z, centred at its frame's origin: apex at z = +length/2, base at z = -length/2.
struct Cone {
  double radius;  ///< Of the base, m.
  double length;  ///< Along z, m.
  bool operator==(const Cone&) const = default;
};

/// All points within `radius` of a segment along z, centred at its frame's origin.
struct Capsule {
  double radius;  ///< m
  double length;  ///< Of the segment: between the centres of the caps, m.
  bool operator==(const Capsule&) const = default;
};

/// Everything below a plane: z <= 0 in its frame. Unbounded.
struct HalfSpace {
  bool operator==(const HalfSpace&) const = default;
};

/// Triangles of a surface.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;                ///< m, in the shape's frame.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
  bool operator==(const TriangleMesh&) const = default;
};

/// Content hash of a mesh's scaled vertices and triangles, 32 hexadecimal digits.
std::string MeshId(const TriangleMesh& mesh);

/// A mesh that its copies share and that nobody changes; without triangles by default. What is
/// known of it is found out once.
class SharedMesh {
  struct Content;

 public:
  /// Finds a mesh again for as long as a copy of it is left.
  using Weak = std::weak_ptr<const Content>;

  SharedMesh();
  SharedMesh(TriangleMesh mesh);  // NOLINT(google-explicit-constructor): it is the same mesh
  /// What a Weak has found.
  explicit SharedMesh(std::shared_ptr<const Content> found) : content_(std::move(found)) {}
  Weak weak() const { return content_; }

  operator const TriangleMesh&() const { return content_->mesh; }  // NOLINT: as above
  const TriangleMesh* operator->() const { return &content_->mesh; }

  /// Its MeshId.
  const std::string& id() const { return content_->id; }
  /// Around its triangles; empty if anything is wrong with it.
  const Eigen::AlignedBox3d& box() const { return content_->box; }
  /// What is wrong with it, as "has no triangles"; empty if all is well.
  const std::string& fault() const { return content_->fault; }

  bool operator==(const SharedMesh& other) const { return id() == other.id(); }

 private:
  struct Content {
    TriangleMesh mesh;
    std::string id;
    Eigen::AlignedBox3d box;
    std::string fault;
  };

  std::shared_ptr<const Content> content_;
};

/// A mesh, named by resource or given inline.
struct Mesh {
  std::string resource;  ///< URI (package://, file://) or path; empty for an inline mesh.
  Eigen::Vector3d scale =
      Eigen::Vector3d::Ones();  ///< Applied to the resource's vertices, per axis.
  SharedMesh
      triangles;  ///< Already scaled; empty until loaded (see LoadMesh) if a resource is named.
  bool operator==(const Mesh&) const = default;
};

using Shape = std::variant<Box, Sphere, Cylinder, Cone, Capsule, HalfSpace, Mesh>;

/// "box", "sphere", "cylinder", "cone", "capsule", "half-space" or "mesh".
std::string ShapeTypeName(const Shape& shape);

/// A shape and its pose X_FS in the frame F of what it belongs to (a link, an object).
struct PlacedShape {
  Shape shape;
  Eigen::Isometry3d X_FS = Eigen::Isometry3d::Identity();
  bool operator==(const PlacedShape& other) const {
    return shape == other.shape && X_FS.matrix() == other.X_FS.matrix();
  }
};

/// Smallest sphere known to enclose a shape, in the shape's frame. That of a half-space has an
/// infinite radius, the centre on its surface.
struct BoundingSphere {
  Eigen::Vector3d center;
  double radius;
};
BoundingSphere ComputeBoundingSphere(const Shape& shape);

}  // namespace planbench
