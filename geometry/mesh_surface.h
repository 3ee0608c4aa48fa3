#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// The triangles of a mesh, in a tree of boxes, for distances from points. Immutable.
class MeshSurface {
 public:
  explicit MeshSurface(const TriangleMesh& mesh);

  /// Distance from a point to the nearest point of the triangles, m, up to rounding; infinity
  /// without triangles.
  double Distance(const Eigen::Vector3d& point) const;

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;
  struct Node {
    Eigen::Vector3d low, high;
    std::uint32_t begin = 0;  // Triangles below it: those from begin to end.
    std::uint32_t end = 0;
    std::uint32_t second = 0;  // Its second child, the first follows it; 0: a leaf.
  };
  void Build(std::uint32_t begin, std::uint32_t end);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace planbench
