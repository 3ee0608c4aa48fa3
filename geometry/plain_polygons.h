#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>

namespace planbench {

/// Polygons as an OBJ text that is as plain as every reader understands it: vertices (v) about an
/// origin, then polygons (f) of their numbers, counted from 1. Those who read it hold single
/// precision: of vertices far from the file's origin the first is the text's.
class PlainPolygons {
 public:
  void AddVertex(const Eigen::Vector3d& vertex);
  void AddPolygon(std::span<const std::uint32_t> corners);

  /// "" if there is no polygon.
  std::string Text() const { return faces_.empty() ? "" : vertices_ + faces_; }
  /// In the file's frame and unit.
  const Eigen::Vector3d& origin() const { return origin_; }

 private:
  std::string vertices_;
  std::string faces_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

}  // namespace planbench
