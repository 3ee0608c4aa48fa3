#include "geometry/polyhedra.h"

#include <cmath>
#include <numbers>

namespace planbench {

TriangleMesh BoxMesh(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back(((corner & 1) != 0 ? 0.5 : -0.5) * size.x(),
                               ((corner & 2) != 0 ? 0.5 : -0.5) * size.y(),
                               ((corner & 4) != 0 ? 0.5 : -0.5) * size.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh PrismMesh(double radius, double length, int sides) {
  TriangleMesh mesh;
  // Corner 2 i at the bottom, 2 i + 1 above it.
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double z : {-length / 2, length / 2}) {
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t here = 2 * i;
    const std::uint32_t next = 2 * ((i + 1) % n);
    mesh.triangles.push_back({here, next, next + 1});
    mesh.triangles.push_back({here, next + 1, here + 1});
    if (i == 0 || i + 1 == n) continue;
    mesh.triangles.push_back({0, next, here});
    mesh.triangles.push_back({1, here + 1, next + 1});
  }
  return mesh;
}

}  // namespace planbench
