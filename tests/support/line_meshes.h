#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// Lines from the first point to the second, points where these are equal.
using Lines = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;

/// A mesh of triangles that are these lines: with three corners in a row or two in one place.
inline TriangleMesh LineMesh(const Lines& lines) {
  TriangleMesh mesh;
  for (const auto& [a, b] : lines) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, a + 0.3 * (b - a)});
    if (first % 2 == 0) {
      mesh.triangles.push_back({first + 2, first, first + 1});
    } else {
      mesh.triangles.push_back({first, first + 1, first});
    }
  }
  return mesh;
}

/// Points and lines within half `size` of the origin along each axis: some along the axes, some on
/// a grid, so that much is parallel to what else there is.
inline Lines RandomLines(int num, double size, std::mt19937_64* random) {
  std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
  const auto on_grid = [&] { return static_cast<double>((*random)() % 9) / 8 - 0.5; };
  Lines lines;
  for (int i = 0; i < num; ++i) {
    Eigen::Vector3d a;
    Eigen::Vector3d b;
    for (int axis = 0; axis < 3; ++axis) {
      a[axis] = i % 2 == 0 ? anywhere(*random) : on_grid();
      b[axis] = i % 2 == 0 ? anywhere(*random) : on_grid();
    }
    if (i % 3 == 0) b = a;
    if (i % 3 == 1) {  // along an axis
      const int axis = i % 9 / 3;
      const double end = b[axis];
      b = a;
      b[axis] = end;
    }
    lines.emplace_back(size * a, size * b);
  }
  return lines;
}

}  // namespace planbench
