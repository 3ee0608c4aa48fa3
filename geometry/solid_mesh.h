#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// What a triangle mesh says of the space it encloses. Vertices at equal coordinates are one vertex
/// (STL files repeat them); a component is a set of triangles (SurfaceTriangles) joined by
/// vertices, and is closed if every edge is shared by an even number of them: those with the same
/// corners count as one, where that closes it.
class SolidMesh {
 public:
  /// What its components are.
  struct Survey {
    int components = 0;
    int open = 0;          ///< Of them not closed.
    int not_oriented = 0;  ///< Closed, but neighbours disagree about where the outside is.
    double volume = 0;     ///< Of the closed, oriented ones, m^3; less than 0: turned inside out.
  };
  explicit SolidMesh(const TriangleMesh& mesh);

  const Survey& survey() const { return survey_; }

  /// True if some component is closed, so that the mesh has an inside.
  bool has_inside() const { return !triangles_.empty(); }
  /// One vertex of each component, and of what is but lines and points apart from them.
  const std::vector<Eigen::Vector3d>& component_points() const { return component_points_; }
  /// True if closed components enclose the point: those of consistent orientation by a winding
  /// number that is not 0 (so that overlapping solids join and inverted ones are cavities), others
  /// by an odd number of crossings. Right for all points but those within rounding of the surface,
  /// or as near to a sliver as that is to its line (AsLine).
  bool Contains(const Eigen::Vector3d& point) const;

 private:
  struct Triangle {
    Eigen::Vector3d a, b, c;
    bool oriented;  // of a component of consistent orientation
  };
  bool InGrid(const Eigen::Vector3d& point, std::size_t* cell) const;
  void BuildGrid();

  Survey survey_;
  std::vector<Eigen::Vector3d> component_points_;
  std::vector<Triangle> triangles_;  // of the closed components
  // Triangles by the cells of a grid over x and y that their bounding rectangles touch.
  Eigen::Vector2d grid_low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d grid_high_ = Eigen::Vector2d::Zero();
  int grid_size_ = 1;  // cells along x and along y
  std::vector<std::uint32_t> cell_begin_;
  std::vector<std::uint32_t> cell_triangles_;
};

}  // namespace planbench
