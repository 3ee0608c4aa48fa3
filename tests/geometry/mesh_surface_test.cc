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
  EXPECT_EQ(MeshSurface(TriangleMesh()).Distance(Vector3d(0, 0, 0)),
            std::numeric_limits<double>::infinity());
  // In a row up to rounding, and asked at points of the same line, where normals are rounding
  // alone.
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d from = RandomPoint(1, &random);
    const Vector3d along = RandomPoint(1, &random);
    line.vertices = {from, from + 0.3 * along, from + along};
    line.triangles = {{0, 1, 2}};
    EXPECT_NEAR(MeshSurface(line).Distance(from + 2 * along), along.norm(), 1e-12);
  }
}

TEST(MeshSurface, KnowsHowFarSegmentsAre) {
  std::mt19937_64 random(4);
  const MeshSurface surface(TorusMesh(1, 0.3, 20, 10));
  for (int i = 0; i < 100; ++i) {
    const Segment segment{RandomPoint(2, &random), RandomPoint(2, &random)};
    constexpr int kSteps = 500;
    double truth = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= kSteps; ++step) {
      const Vector3d p = segment.a + step * (segment.b - segment.a) / kSteps;
      truth = std::min(truth, surface.Distance(p));
    }
    const double distance = surface.Distance(segment);
    EXPECT_LE(distance, truth + 1e-12);
    EXPECT_GE(distance, truth - (segment.b - segment.a).norm() / kSteps / 2);
    EXPECT_NEAR(surface.Distance(segment, 0.1), std::min(distance, 0.1), 1e-12);
    EXPECT_NEAR(surface.Distance(Segment{segment.a, segment.a}), surface.Distance(segment.a),
                1e-12);
  }
  // Along edges, across faces, through them.
  const MeshSurface box(BoxMesh({1, 1, 1}));
  EXPECT_NEAR(box.Distance(Segment{{1, 1, -3}, {1, 1, 3}}), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(box.Distance(Segment{{-5, 0, 0.75}, {7, 0.25, 0.75}}), 0.25, 1e-12);
  EXPECT_NEAR(box.Distance(Segment{{-5, 0, 0}, {7, 0.25, 0.25}}), 0, 1e-10);
  EXPECT_NEAR(box.Distance(Segment{{-0.125, 0, 0}, {0.25, 0, 0}}), 0.25, 1e-12);
}

}  // namespace
}  // namespace planbench
