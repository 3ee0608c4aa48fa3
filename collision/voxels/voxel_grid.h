#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "robot_model/voxel_settings.h"
#include "scene/scene.h"

namespace planbench {

/// Cubic cells of a box of space, each occupied or not. Cell (i, j, k) is the cube from
/// origin + resolution (i, j, k) to origin + resolution (i + 1, j + 1, k + 1).
class VoxelGrid {
 public:
  /// All cells free. Throws InputError for what NumVoxels refuses.
  explicit VoxelGrid(const VoxelSettings& settings);

  const Eigen::Vector3d& origin() const { return origin_; }  ///< m, in W.
  double resolution() const { return resolution_; }          ///< m
  const std::array<int, 3>& size() const { return size_; }
  /// By cell, x fastest; 1 is occupied.
  const std::vector<std::uint8_t>& cells() const { return cells_; }
  std::size_t Index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(i);
  }
  Eigen::Vector3d Center(int i, int j, int k) const {
    return origin_ + resolution_ * (Eigen::Vector3d(i, j, k).array() + 0.5).matrix();
  }

  void Clear();
  /// Marks the cells that a shape at pose X_WS meets, be it in one point of their surfaces (1e-9 m
  /// apart counts as touching); of a grid that is to be hollow, not those wholly inside. Shapes are
  /// solid; a mesh is, as far as closed components of it
  /// enclose space (SolidMesh), else a surface. Sizes and triangles must be valid
  /// (RequireSolid).
  void Mark(const Shape& shape, const Eigen::Isometry3d& X_WS);
  /// Marks all objects of a scene, but not what is attached to the robot. Throws InputError for
  /// what RequireSolid refuses.
  void Mark(const Scene& scene);

 private:
  struct Range {
    std::array<int, 3> first, last;  // cells; last < first: none
  };
  struct Cells {
    int first, last;  // of a row
  };
  Range CellsAround(const Eigen::AlignedBox3d& box) const;
  Eigen::AlignedBox3d BoxOf(int first, int last, int j, int k) const;
  template <typename Solid>
  Cells CellsMet(const Solid& solid, int j, int k, const Cells& of) const;
  template <typename Solid>
  void MarkConvex(const Solid& solid, const Eigen::AlignedBox3d& around);
  void MarkMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& X_WS);

  Eigen::Vector3d origin_;
  double resolution_;
  bool hollow_;
  std::array<int, 3> size_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace planbench
