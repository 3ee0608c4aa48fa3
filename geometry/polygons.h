#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace planbench {

/// Polygons as a file has them, in its frame and unit.
class Polygons {
 public:
  /// Vertices are held in single precision about an origin, the first of them if that is far out,
  /// as other formats have them: so corners meet that differ by how they were written.
  void AddVertex(const Eigen::Vector3d& vertex);
  /// Places of vertices, which may come later; three at least.
  void AddPolygon(std::span<const std::uint32_t> corners);

  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  std::size_t size() const { return ends_.size(); }
  std::span<const std::uint32_t> corners(std::size_t polygon) const {
    const std::size_t begin = polygon == 0 ? 0 : ends_[polygon - 1];
    return std::span(corners_).subspan(begin, ends_[polygon] - begin);
  }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::size_t> ends_;  ///< Of each polygon's corners.
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

/// Cuts a polygon of n corners into n - 2 triangles of its corners' places, turned as it is, by
/// clipping ears (Meisters, "Polygons have ears", 1975), and convex ones into a fan about the
/// corner that is least by x, y and z. The cut is the same whichever corner and side it begins
/// with: faces that are there for both sides are so as triangles. Whatever it is (corners in a row
/// or in one place, bridges to holes, not flat, across itself), each of its edges is one of one
/// triangle and any other of two, so that no surface is opened; of a flat one that does not cross
/// itself the triangles are exactly what is within.
std::vector<std::array<std::uint32_t, 3>> Triangulate(std::span<const Eigen::Vector3d> polygon);

}  // namespace planbench
