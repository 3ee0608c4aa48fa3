#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// Points of a cone's surface that reach furthest: its apex and the rim of its base.
std::vector<Vector3d> ConeExtremes(const Cone& cone) {
  std::vector<Vector3d> points = {Vector3d(0, 0, cone.length / 2)};
  for (int i = 0; i < 64; ++i) {
    const double angle = 2 * std::numbers::pi * i / 64;
    points.emplace_back(cone.radius * std::cos(angle), cone.radius * std::sin(angle),
                        -cone.length / 2);
  }
  return points;
}

double FarthestDistance(const std::vector<Vector3d>& points, const Vector3d& center) {
  double farthest = 0;
  for (const Vector3d& point : points) farthest = std::max(farthest, (point - center).norm());
  return farthest;
}

TEST(ShapeTypeName, NamesEveryShape) {
  EXPECT_EQ(ShapeTypeName(Box{Vector3d::Ones()}), "box");
  EXPECT_EQ(ShapeTypeName(Sphere{1}), "sphere");
  EXPECT_EQ(ShapeTypeName(Cylinder{1, 1}), "cylinder");
  EXPECT_EQ(ShapeTypeName(Cone{1, 1}), "cone");
  EXPECT_EQ(ShapeTypeName(Capsule{1, 1}), "capsule");
  EXPECT_EQ(ShapeTypeName(HalfSpace{}), "half-space");
  EXPECT_EQ(ShapeTypeName(Mesh{}), "mesh");
}

TEST(BoundingSphere, IsExactForBoxSphereAndCylinder) {
  const BoundingSphere box = ComputeBoundingSphere(Box{Vector3d(2, 3, 6)});
  EXPECT_EQ(box.center, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(box.radius, 3.5);

  const BoundingSphere sphere = ComputeBoundingSphere(Sphere{0.25});
  EXPECT_EQ(sphere.center, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(sphere.radius, 0.25);

  const BoundingSphere cylinder = ComputeBoundingSphere(Cylinder{0.3, 0.8});
  EXPECT_EQ(cylinder.center, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(cylinder.radius, 0.5);
}

TEST(BoundingSphere, OfCapsulesAndHalfSpaces) {
  const BoundingSphere capsule = ComputeBoundingSphere(Capsule{0.3, 0.8});
  EXPECT_EQ(capsule.center, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(capsule.radius, 0.7);
  EXPECT_TRUE(std::isinf(ComputeBoundingSphere(HalfSpace{}).radius));
}

TEST(BoundingSphere, OfConesIsTheSmallestThatHoldsApexAndBase) {
  for (const Cone cone : {Cone{0.1, 1}, Cone{1, 1}, Cone{1, 0.1}, Cone{0.6, 0.8}}) {
    SCOPED_TRACE(cone.radius / cone.length);
    const BoundingSphere sphere = ComputeBoundingSphere(cone);
    const std::vector<Vector3d> extremes = ConeExtremes(cone);
    EXPECT_NEAR(FarthestDistance(extremes, sphere.center), sphere.radius, 1e-12);
    // By symmetry the smallest sphere's centre is on the axis: none there does better.
    for (int i = -100; i <= 100; ++i) {
      EXPECT_GE(FarthestDistance(extremes, Vector3d(0, 0, 0.01 * i)), sphere.radius - 1e-12);
    }
  }
}

TEST(BoundingSphere, OfMeshesHoldsEveryVertexAndIsNotMuchTooLarge) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    // Vertices on a sphere of radius 2 that is somewhere: the smallest sphere is known.
    const Vector3d center(uniform(random), uniform(random), uniform(random));
    TriangleMesh mesh;
    for (int i = 0; i < 500; ++i) {
      const Vector3d direction(uniform(random), uniform(random), uniform(random));
      mesh.vertices.push_back(center + 2 * direction.normalized());
    }
    mesh.triangles.push_back({0, 1, 2});
    const BoundingSphere sphere = ComputeBoundingSphere(Mesh{"", Vector3d::Ones(), mesh});
    EXPECT_LE(FarthestDistance(mesh.vertices, sphere.center), sphere.radius + 1e-12);
    EXPECT_LE(sphere.radius, 2 * 1.05);
  }
}

TEST(BoundingSphere, OfAMeshTakesTheBetterOfTwoMethods) {
  // The corners of a cube: centre of the box is exact there.
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i) {
    cube.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  }
  EXPECT_NEAR(ComputeBoundingSphere(Mesh{"", Vector3d::Ones(), cube}).radius, std::sqrt(3) / 2,
              1e-12);

  // A lone point on a face pulls the box' centre away from nowhere, a single vertex has radius 0.
  Mesh point;
  point.triangles = TriangleMesh{{Vector3d(1, 2, 3)}, {}};
  EXPECT_EQ(ComputeBoundingSphere(point).center, Vector3d(1, 2, 3));
  EXPECT_EQ(ComputeBoundingSphere(point).radius, 0);
}

TEST(SharedMesh, KnowsItsIdAndIsEqualToThoseThatHaveIt) {
  TriangleMesh triangle;
  triangle.vertices = {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()};
  triangle.triangles = {{0, 1, 2}};
  TriangleMesh other = triangle;
  other.vertices[1].x() = 2;
  EXPECT_EQ(SharedMesh(triangle).id(), MeshId(triangle));
  EXPECT_EQ(SharedMesh(triangle), SharedMesh(triangle));
  EXPECT_NE(SharedMesh(triangle), SharedMesh(other));
}

TEST(BoundingSphere, RefusesAMeshThatIsNotLoaded) {
  ExpectInputError(
      [] {
        ComputeBoundingSphere(Mesh{"package://a/b.stl", Vector3d::Ones(), {}});
      },
      {"package://a/b.stl", "no vertices"});
}

}  // namespace
}  // namespace planbench
