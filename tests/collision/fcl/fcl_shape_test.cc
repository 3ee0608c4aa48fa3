#include "collision/fcl/fcl_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "common/numbers.h"
#include "tests/contract/collision_oracle.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/line_meshes.h"

namespace planbench {
namespace {

Mesh Cuboid(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.triangles = BoxMesh(size);
  return mesh;
}

Pose Shift(double x, double y, double z) {
  Pose pose;
  pose.translation << x, y, z;
  return pose;
}

const std::vector<Shape>& AllShapes() {
  static const std::vector<Shape> kShapes = {
      Box{{0.4, 0.6, 1.0}}, Sphere{0.5},    Cylinder{0.3, 0.8}, Cylinder{1.0, 0.01},
      Cone{0.4, 0.9},       Cone{0.5, 0.1}, Capsule{0.2, 0.5},  Cuboid({0.4, 0.6, 1.0})};
  return kShapes;
}

TEST(FclShapeTest, BallsAgreeWithTheOracle) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  std::uniform_real_distribution<double> size(0, 0.3);
  for (const Shape& shape : AllShapes()) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape fcl_shape(shape, "test");
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p(coordinate(generator), coordinate(generator), coordinate(generator));
      const double radius = size(generator);
      const double expected = OracleDistance(shape, p) - radius;
      EXPECT_NEAR(fcl_shape.BallDistance(p, radius), expected, 1e-9) << p.transpose();
      if (std::abs(expected) > 1e-12) {
        EXPECT_EQ(fcl_shape.TouchesBall(p, radius), expected < 0) << p.transpose();
      }
      // Boxes and bounding spheres enclose.
      if (expected + radius > 0) continue;
      EXPECT_TRUE(((p - fcl_shape.box_center()).cwiseAbs().array() <=
                   fcl_shape.box_half_size().array() + 1e-12)
                      .all());
      EXPECT_LE((p - fcl_shape.bounding_sphere().center).norm(),
                fcl_shape.bounding_sphere().radius + 1e-12);
    }
  }
}

TEST(FclShapeTest, EveryPairOfShapesMeetsAndParts) {
  for (const Shape& a : AllShapes()) {
    for (const Shape& b : AllShapes()) {
      SCOPED_TRACE(ShapeTypeName(a) + " and " + ShapeTypeName(b));
      const FclShape first(a, "a");
      const FclShape second(b, "b");
      // Along x both are convex and symmetric, so they meet at the sum of their half widths at
      // mid-height, or later.
      const double width = first.box_half_size().x() + second.box_half_size().x();
      EXPECT_TRUE(first.Touches(second, Shift(0.001, 0.002, 0.003)));
      EXPECT_LE(first.Distance(second, Shift(0.001, 0.002, 0.003), kInfinity), 0);
      EXPECT_FALSE(first.Touches(second, Shift(width + 0.01, 0, 0)));
      const double distance = first.Distance(second, Shift(width + 0.2, 0, 0), kInfinity);
      EXPECT_GE(distance, 0.2 - 1e-5);
      EXPECT_NEAR(second.Distance(first, Shift(-width - 0.2, 0, 0), kInfinity), distance, 1e-5);
      EXPECT_NEAR(first.Distance(second, Shift(width + 0.2, 0, 0), 0.1), 0.1, 0);
    }
  }
}

/// How far a line, in the frame of a convex shape, is from it; 0 if it touches.
double LineDistance(const Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return OracleLeastAlong(
      a, b, [&](const Eigen::Vector3d& p) { return std::max(0.0, OracleDistance(shape, p)); });
}

/// Poses anywhere, and along the axes at places that are exact in binary.
Eigen::Isometry3d PoseOrGrid(int i, std::mt19937_64* generator) {
  if (i % 2 == 0) return RandomPose(generator, 1);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (double& p : X.translation()) p = static_cast<double>((*generator)() % 9) / 4 - 1;
  return X;
}

/// Of depths, which are told of spheres, nothing is expected.
void ExpectDistance(const FclShape& shape, const FclShape& other, const Pose& X_SO, double truth) {
  EXPECT_NEAR(std::max(0.0, shape.Distance(other, X_SO, kInfinity)), truth, 1e-7);
  EXPECT_NEAR(std::max(0.0, other.Distance(shape, X_SO.Inverse(), kInfinity)), truth, 1e-7);
  EXPECT_NEAR(std::max(0.0, shape.Distance(other, X_SO, 0.2)), std::min(truth, 0.2), 1e-7);
  if (truth > 0 && truth < 1e-7) return;
  EXPECT_EQ(shape.Touches(other, X_SO), truth <= 0) << truth;
  EXPECT_EQ(other.Touches(shape, X_SO.Inverse()), truth <= 0) << truth;
}

TEST(FclShapeTest, LinesAndPointsOfMeshesAreWhereTheyAre) {
  std::mt19937_64 generator(13);
  std::vector<Shape> shapes = AllShapes();
  shapes.emplace_back(HalfSpace{});
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape solid(shape, "solid");
    for (int i = 0; i < 100; ++i) {
      const Lines lines = RandomLines(1 + i % 5, 1, &generator);
      Mesh mesh;
      mesh.triangles = LineMesh(lines);
      const Eigen::Isometry3d X = PoseOrGrid(i, &generator);
      double truth = kInfinity;
      for (const auto& [a, b] : lines) truth = std::min(truth, LineDistance(shape, X * a, X * b));
      ExpectDistance(solid, FclShape(mesh, "lines"), Pose::From(X), truth);
      // A mesh of something else as well.
      mesh.triangles = Joined(BoxMesh({0.1, 0.1, 0.1}), LineMesh(lines), {0, 0, 0});
      Mesh box;
      box.triangles = BoxMesh({0.1, 0.1, 0.1});
      const double of_box = solid.Distance(FclShape(box, "box"), Pose::From(X), kInfinity);
      ExpectDistance(solid, FclShape(mesh, "both"), Pose::From(X), std::clamp(of_box, 0.0, truth));
    }
  }
}

TEST(FclShapeTest, LinesAgainstLinesAndSheets) {
  std::mt19937_64 generator(14);
  for (int i = 0; i < 400; ++i) {
    const Lines lines = RandomLines(2, 1, &generator);
    const Lines others = RandomLines(3, 1, &generator);
    const Eigen::Isometry3d X = PoseOrGrid(i, &generator);
    double truth = kInfinity;
    for (const auto& [a, b] : lines) {
      for (const auto& [c, d] : others) {
        const Eigen::Vector3d along = X * d - X * c;
        const Eigen::Vector3d from = X * c;
        const auto to_other = [&](const Eigen::Vector3d& p) {
          if (along.isZero()) return (p - from).norm();
          const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
          return (p - from - t * along).norm();
        };
        truth = std::min(truth, OracleLeastAlong(a, b, to_other));
      }
    }
    if (truth < 1e-7) truth = 0;
    Mesh mesh;
    mesh.triangles = LineMesh(lines);
    const FclShape first(mesh, "lines");
    mesh.triangles = LineMesh(others);
    ExpectDistance(first, FclShape(mesh, "others"), Pose::From(X), truth);
  }
  // Through a sheet and beside it in its plane, where only its edge is near.
  Mesh sheet;
  TriangleMesh triangle;
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.triangles = {{0, 1, 2}};
  sheet.triangles = triangle;
  const FclShape shape(sheet, "sheet");
  const auto distance = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    Mesh mesh;
    mesh.triangles = LineMesh({{a, b}});
    return shape.Distance(FclShape(mesh, "line"), Pose(), kInfinity);
  };
  EXPECT_EQ(distance({0.2, 0.3, -1}, {0.3, 0.2, 1}), 0);
  EXPECT_EQ(distance({0.2, 0.3, 0}, {0.3, 0.2, 0}), 0);
  EXPECT_EQ(distance({0.2, 0.3, 0}, {0.2, 0.3, 0}), 0);
  EXPECT_NEAR(distance({0.9, 0.4, 0}, {0.4, 0.9, 0}), 0.3 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(distance({0.7, 0.7, 0}, {0.95, 0.95, 0}), 0.4 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(distance({0.1, 0.1, 0.5}, {0.2, 0.2, 0.5}), 0.5, 1e-9);
}

TEST(FclShapeTest, CapsulesAreExactAndMayJustTouch) {
  std::mt19937_64 generator(15);
  const Capsule capsule{0.25, 0.5};
  const FclShape pill(capsule, "pill");
  std::vector<Shape> shapes = AllShapes();
  shapes.emplace_back(Box{{0.5, 0.5, 0.5}});
  shapes.emplace_back(Cylinder{0.25, 0.5});
  shapes.emplace_back(Cone{0.25, 0.5});
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape solid(shape, "solid");
    for (int i = 0; i < 400; ++i) {
      const Eigen::Isometry3d X = PoseOrGrid(i, &generator);
      const Eigen::Vector3d end(0, 0, capsule.length / 2);
      const double truth = LineDistance(shape, X * -end, X * end) - capsule.radius;
      const Pose X_SP = Pose::From(X);
      if (std::abs(truth) < 1e-7) {
        EXPECT_LE(solid.Distance(pill, X_SP, kInfinity), 1e-7);
        EXPECT_LE(pill.Distance(solid, X_SP.Inverse(), kInfinity), 1e-7);
      } else {
        ExpectDistance(solid, pill, X_SP, std::max(0.0, truth));
      }
    }
  }
}

TEST(FclShapeTest, HalfSpacesAreExact) {
  const FclShape floor(HalfSpace{}, "floor");
  EXPECT_DOUBLE_EQ(floor.BallDistance({7, -8, 0.5}, 0.2), 0.3);
  EXPECT_DOUBLE_EQ(floor.BallDistance({7, -8, -0.5}, 0.2), -0.7);
  EXPECT_TRUE(floor.TouchesBall({1e9, 0, 0.25}, 0.25));
  EXPECT_FALSE(floor.TouchesBall({1e9, 0, 0.26}, 0.25));

  std::mt19937_64 generator(9);
  for (const Shape& shape : AllShapes()) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape other(shape, "other");
    for (int i = 0; i < 100; ++i) {
      Eigen::Isometry3d X = RandomPose(&generator, 1.5);
      const Pose pose = Pose::From(X);
      // A box so wide that its top is a plane, for FCL.
      const FclShape slab(Cuboid({50, 50, 10}), "slab");
      Pose on_slab = pose;
      on_slab.translation.z() += 5;
      const double expected = slab.Distance(other, on_slab, kInfinity);
      const double distance = floor.Distance(other, pose, kInfinity);
      EXPECT_NEAR(std::max(distance, 0.0), std::max(expected, 0.0), 1e-4);
      EXPECT_EQ(floor.Touches(other, pose), distance <= 0);
      EXPECT_EQ(other.Touches(floor, pose.Inverse()), distance <= 0);
      EXPECT_NEAR(other.Distance(floor, pose.Inverse(), kInfinity), distance, 1e-12);
      EXPECT_LE(floor.Distance(other, pose, 0.1), 0.1);
    }
  }
  Pose facing = Shift(0, 0, 0.5);
  EXPECT_TRUE(floor.Touches(floor, facing));
  facing.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_FALSE(floor.Touches(floor, facing));
  EXPECT_DOUBLE_EQ(floor.Distance(floor, facing, kInfinity), 0.5);
}

TEST(FclShapeTest, ConesPointUp) {
  const FclShape cone(Cone{0.5, 1.0}, "cone");
  const std::vector<Shape> probes = {Box{{0.02, 0.02, 0.02}}, Cylinder{0.01, 0.02},
                                     Cuboid({0.02, 0.02, 0.02})};
  for (const Shape& shape : probes) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape probe(shape, "probe");
    EXPECT_TRUE(cone.Touches(probe, Shift(0.4, 0, -0.45)));
    EXPECT_FALSE(cone.Touches(probe, Shift(0.4, 0, 0.45)));
    EXPECT_TRUE(cone.Touches(probe, Shift(0, 0, 0.48)));
    EXPECT_NEAR(cone.Distance(probe, Shift(0, 0, 0.71), kInfinity), 0.2, 1e-5);
    EXPECT_NEAR(cone.Distance(probe, Shift(0, 0, -0.71), kInfinity), 0.2, 1e-5);
  }
}

TEST(FclShapeTest, AMeshOfABoxIsTheBox) {
  const Eigen::Vector3d size(0.4, 0.6, 1.0);
  const FclShape box(Box{size}, "box");
  const FclShape mesh(Cuboid(size), "mesh");
  std::mt19937_64 generator(8);
  int num_touching = 0;
  for (const Shape& shape : AllShapes()) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape other(shape, "other");
    for (int i = 0; i < 200; ++i) {
      const Pose pose = Pose::From(RandomPose(&generator, 1.0));
      const double distance = box.Distance(other, pose, kInfinity);
      if (distance > 0 && distance < 1e-4) continue;
      EXPECT_EQ(box.Touches(other, pose), mesh.Touches(other, pose));
      num_touching += box.Touches(other, pose) ? 1 : 0;
      EXPECT_NEAR(std::max(mesh.Distance(other, pose, kInfinity), 0.0), std::max(distance, 0.0),
                  1e-4);
    }
  }
  EXPECT_GT(num_touching, 100);
}

TEST(FclShapeTest, WhatIsInsideAClosedMeshTouchesIt) {
  const FclShape room(Cuboid({4, 4, 4}), "room");
  for (const Shape& shape : AllShapes()) {
    SCOPED_TRACE(ShapeTypeName(shape));
    const FclShape inside(shape, "inside");
    const Pose pose = Shift(0.3, 0.2, 0.1);
    EXPECT_TRUE(room.Touches(inside, pose));
    EXPECT_TRUE(inside.Touches(room, pose.Inverse()));
    EXPECT_LE(room.Distance(inside, pose, kInfinity), 0);
    EXPECT_LE(inside.Distance(room, pose.Inverse(), kInfinity), 0);
  }
}

TEST(FclShapeTest, RefusesWhatIsNoShape) {
  ExpectInputError([] { FclShape(Box{{1, -1, 1}}, "crate"); }, {"crate", "box", "-1"});
  ExpectInputError([] { FclShape(Sphere{std::nan("")}, "ball"); }, {"ball", "sphere"});
  ExpectInputError([] { FclShape(Cylinder{kInfinity, 1}, "pipe"); }, {"pipe", "cylinder"});
  ExpectInputError([] { FclShape(Capsule{-1, 2}, "pill"); }, {"pill", "capsule", "-1"});
  ExpectInputError([] { FclShape(Cone{1, -2}, "hat"); }, {"hat", "cone", "-2"});
  Mesh named;
  named.resource = "package://robot/hand.stl";
  ExpectInputError([&] { FclShape(named, "hand"); }, {"hand", named.resource, "no triangles"});
  Mesh broken;
  TriangleMesh cube = BoxMesh({1, 1, 1});
  cube.triangles[3][1] = 8;
  broken.triangles = cube;
  ExpectInputError([&] { FclShape(broken, "vase"); }, {"vase", "vertex 8"});
  cube = BoxMesh({1, 1, 1});
  cube.vertices[2].y() = kInfinity;
  broken.triangles = cube;
  ExpectInputError([&] { FclShape(broken, "vase"); }, {"vase", "not finite"});
}

TEST(FclShapeTest, DepthIsTheWayOut) {
  const FclShape plate(Box{{1, 1, 0.1}}, "plate");
  const FclShape box(Box{{0.2, 0.4, 0.6}}, "box");
  const FclShape cuboid(Cuboid({0.2, 0.4, 0.6}), "cuboid");
  const FclShape ball(Sphere{0.3}, "ball");
  // 0.02 m into a face; through the plate, out by its nearer face; past its rim.
  const std::vector<std::pair<Pose, double>> cases = {
      {Shift(0, 0, 0.33), 0.02}, {Shift(0.1, 0.2, -0.1), 0.25}, {Shift(0.57, 0, 0), 0.03}};
  for (const auto& [X_PO, depth] : cases) {
    for (const FclShape* shape : {&box, &cuboid}) {
      EXPECT_NEAR(plate.Depth(*shape, X_PO), depth, 2e-6);
      EXPECT_NEAR(shape->Depth(plate, X_PO.Inverse()), depth, 2e-6);
    }
  }
  EXPECT_NEAR(plate.Depth(ball, Shift(0, 0, 0.33)), 0.02, 1e-9);
  // A corner, with the diagonal of a cube downwards.
  Pose tilted = Shift(0, 0, 0.05 + std::sqrt(3.0) * 0.2 - 0.01);
  tilted.rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  const FclShape cube(Cuboid({0.4, 0.4, 0.4}), "cube");
  EXPECT_NEAR(plate.Depth(cube, tilted), 0.01, 2e-6);
  // One inside the other: out by the nearest side.
  EXPECT_NEAR(FclShape(Cuboid({4, 4, 4}), "room").Depth(cuboid, Shift(1, 0, 0)), 1.1, 2e-6);
}

}  // namespace
}  // namespace planbench
