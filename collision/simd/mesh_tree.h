#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "collision/simd/kernels/triangle_tree.h"
#include "geometry/mesh_surface.h"
#include "geometry/shapes.h"
#include "geometry/solid_mesh.h"

namespace planbench {

/// Boxes that are far away, all of them.
kernels::BoxGroup MakeBoxGroup();

/// Writes a box, enlarged by so much (m), and its child into a place of a group.
void SetBox(const Eigen::AlignedBox3d& box, double padding, std::int32_t child, std::size_t i,
            kernels::BoxGroup* group);

/// Writes a triangle into a place of a group.
void SetTriangle(const Corners& triangle, std::size_t i, kernels::TriangleGroup* group);

/// A triangle mesh with what the kernels take of it. Immutable; any number of threads may use it.
class MeshTree {
 public:
  /// At least one triangle; indices must be valid, vertices finite.
  explicit MeshTree(const SharedMesh& mesh);
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

  const kernels::TriangleTree& tree() const { return tree_; }

 private:
  SolidMesh solid_;
  kernels::TriangleTree tree_;
};

}  // namespace planbench
