#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// Of a triangle, m, in the frame of a mesh or a body.
using Corners = std::array<Eigen::Vector3d, 3>;

/// The triangles of a mesh, in a tree of boxes, for distances from points. Immutable.
class MeshSurface {
 public:
  explicit MeshSurface(const TriangleMesh& mesh);
  explicit MeshSurface(std::vector<Corners> triangles);

  /// Distance from a point to the nearest point of the triangles, m, up to rounding, or `at_most`,
  /// which is not negative, if that is less.
  double Distance(const Eigen::Vector3d& point,
                  double at_most = std::numeric_limits<double>::infinity()) const;

 private:
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
