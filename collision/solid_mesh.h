#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// What a triangle mesh says of the space it encloses. Vertices at equal coordinates are one vertex
/// (STL files repeat them); a component is a set of triangles joined by vertices.
class SolidMesh {
 public:
  explicit SolidMesh(const TriangleMesh& mesh);

  /// True if every edge of the surface is shared by an even number of triangles, so that inside and
  /// outside are told apart.
  bool closed() const { return closed_; }
  /// One vertex of each component.
  const std::vector<Eigen::Vector3d>& component_points() const { return component_points_; }
  /// True if the mesh is closed and a ray from the point crosses it an odd number of times.
  bool Contains(const Eigen::Vector3d& point) const;

 private:
  struct Triangle {
    Eigen::Vector3d a, b, c;
  };
  bool InGrid(const Eigen::Vector3d& point, std::size_t* cell) const;
  void BuildGrid();

  bool closed_ = false;
  std::vector<Eigen::Vector3d> component_points_;
  std::vector<Triangle> triangles_;
  // Triangles by the cells of a grid over x and y that their bounding rectangles touch.
  Eigen::Vector2d grid_low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d grid_high_ = Eigen::Vector2d::Zero();
  int grid_size_ = 1;  // cells along x and along y
  std::vector<std::uint32_t> cell_begin_;
  std::vector<std::uint32_t> cell_triangles_;
};

}  // namespace planbench
