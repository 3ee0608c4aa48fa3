#include "geometry/mesh_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/random.h"
#include "geometry/polyhedra.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

Vector3d RandomPoint(double range, std::mt19937_64* random) {
  return range * Vector3d(2 * UniformFraction(random) - 1, 2 * UniformFraction(random) - 1,
                          2 * UniformFraction(random) - 1);
}

TEST(MeshSurface, KnowsHowFarBoxesAre) {
  std::mt19937_64 random(1);
  const Vector3d half(0.5, 0.2, 0.7);
  const MeshSurface surface(BoxMesh(2 * half));
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p = RandomPoint(1.5, &random);
    const Vector3d beyond = p.cwiseAbs() - half;
    const double truth = beyond.maxCoeff() > 0 ? beyond.cwiseMax(0).norm() : -beyond.maxCoeff();
    EXPECT_NEAR(surface.Distance(p), truth, 1e-12) << p.transpose();
    EXPECT_NEAR(surface.Distance(p, 0.3), std::min(truth, 0.3), 1e-12) << p.transpose();
  }
}

TEST(MeshSurface, KnowsHowFarRingsAre) {
  std::mt19937_64 random(2);
  const MeshSurface surface(TorusMesh(1, 0.3, 200, 100));
  for (int i = 0; i < 300; ++i) {
    const Vector3d p = RandomPoint(2, &random);
    const double truth = std::abs(std::hypot(p.head<2>().norm() - 1, p.z()) - 0.3);
    EXPECT_NEAR(surface.Distance(p), truth, 1e-3);  // Chords lie within the ring.
  }
}

TEST(MeshSurface, TakesTrianglesWithoutAreaAsLines) {
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}, {0, 0, 0}};
  const MeshSurface surface(line);
  EXPECT_DOUBLE_EQ(surface.Distance({1.5, 2, 0}), 2);
  EXPECT_DOUBLE_EQ(surface.Distance({-3, 4, 0}), 5);
  EXPECT_EQ(MeshSurface(TriangleMesh()).Distance({0, 0, 0}),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace planbench
