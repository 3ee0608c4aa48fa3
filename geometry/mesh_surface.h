#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/segment.h"
#include "geometry/shapes.h"

namespace planbench {

/// Of a triangle, m, in the frame of a mesh or a body.
using Corners = std::array<Eigen::Vector3d, 3>;

/// The triangles of a mesh, in a tree of boxes, for distances from points and segments. Triangles
/// may be lines and points. Immutable.
class MeshSurface {
 public:
  MeshSurface() = default;
  explicit MeshSurface(const TriangleMesh& mesh);
  explicit MeshSurface(std::vector<Corners> triangles);

  /// Distance from a point to the nearest point of the triangles, m, up to rounding, or `at_most`,
  /// which is not negative, if that is less.
  double Distance(const Eigen::Vector3d& point,
                  double at_most = std::numeric_limits<double>::infinity()) const;
  /// The same from a segment: up to 1e-12 of its length, so that it is rarely 0 where they cross.
  double Distance(const Segment& segment,
                  double at_most = std::numeric_limits<double>::infinity()) const;

  /// The least value for a triangle of `of_triangle(corners, at_most)`, or `at_most` if that is
  /// less. `of_box(low, high, at_most)` is a lower bound for what is in a box. Either may give
  /// `at_most` for anything greater: what was found so far.
  template <typename OfBox, typename OfTriangle>
  double Least(double at_most, const OfBox& of_box, const OfTriangle& of_triangle) const;

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

template <typename OfBox, typename OfTriangle>
double MeshSurface::Least(double at_most, const OfBox& of_box,
                          const OfTriangle& of_triangle) const {
  if (nodes_.empty()) return at_most;
  double best = at_most;
  struct Open {
    double bound;
    std::uint32_t node;
  };
  const auto open_node = [&](std::uint32_t index) {
    return Open{of_box(nodes_[index].low, nodes_[index].high, best), index};
  };
  std::array<Open, 64> stack;  // Halving leaves no tree of 2^32 triangles deeper than that.
  std::size_t size = 0;
  stack[size++] = open_node(0);
  while (size > 0) {
    const Open open = stack[--size];
    if (open.bound >= best) continue;
    const Node& node = nodes_[open.node];
    if (node.second == 0) {
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        best = std::min(best, of_triangle(triangles_[t], best));
      }
      continue;
    }
    Open near = open_node(open.node + 1);
    Open far = open_node(node.second);
    if (far.bound < near.bound) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return best;
}

}  // namespace planbench
