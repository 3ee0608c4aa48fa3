#pragma once

#include <memory>
#include <vector>

#include "geometry/ball.h"
#include "geometry/mesh_surface.h"
#include "geometry/shapes.h"
#include "geometry/solid_mesh.h"

namespace planbench {

/// A triangle mesh, and what it encloses as SolidMesh has it. Immutable.
class Solid {
 public:
  explicit Solid(TriangleMesh mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  const SolidMesh& inside() const { return inside_; }
  /// How deep a point is inside: its distance from the surface, m; outside minus that distance.
  double Depth(const Eigen::Vector3d& point) const;

 private:
  TriangleMesh mesh_;
  SolidMesh inside_;
  MeshSurface surface_;
};

/// The collision geometry of one link, in the link's frame: spheres and solids, which are meshes,
/// boxes and cylinders. Of a solid there are three meshes, so that whatever is proven errs to the
/// safe side: the hull, which spheres have to enclose, the shape, which they are measured against,
/// and the core, which holds what is truly inside. They differ for a cylinder, which is between two
/// prisms, and for a mesh with small holes, which are filled but in the core.
class LinkBody {
 public:
  /// Adds a shape. Meshes must be loaded (triangles, finite, vertices joined). Returns how many
  /// holes were filled. Throws InputError for shapes that a URDF does not have.
  int Add(const PlacedShape& placed);

  bool empty() const { return spheres_.empty() && solids_.empty(); }
  const std::vector<Ball>& spheres() const { return spheres_; }
  bool has_solids() const { return !solids_.empty(); }
  std::vector<const Solid*> hulls() const;
  /// How deep a point is in a hull, in a shape or sphere, in a core: in that where it is deepest,
  /// m; less than 0 outside of all, minus infinity where there is none.
  double HullDepth(const Eigen::Vector3d& point) const;
  double Depth(const Eigen::Vector3d& point) const;
  double CoreDepth(const Eigen::Vector3d& point) const;
  /// True if Depth is greater than 0, at less expense.
  bool Encloses(const Eigen::Vector3d& point) const;

 private:
  struct Forms {
    std::shared_ptr<const Solid> hull;
    std::shared_ptr<const Solid> shape;
    std::shared_ptr<const Solid> core;
  };
  std::vector<Ball> spheres_;
  std::vector<Forms> solids_;
};

}  // namespace planbench
