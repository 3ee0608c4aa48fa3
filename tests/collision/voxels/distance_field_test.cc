#include "collision/voxels/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/contract/collision_oracle.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

VoxelSettings Grid(int x, int y, int z, bool walls) {
  VoxelSettings settings;
  settings.resolution_m = 0.5;
  settings.lower = {-1, 2, 0.25};
  settings.upper = settings.lower + 0.5 * Vector3d(x, y, z);
  settings.walls = walls;
  return settings;
}

using Cells = std::vector<std::uint8_t>;

std::array<int, 3> Place(int cell, const std::array<int, 3>& size) {
  return {cell % size[0], cell / size[0] % size[1], cell / size[0] / size[1]};
}

// Distance in cells to the nearest occupied one, infinity if there is none.
double BruteForce(const Cells& cells, const std::array<int, 3>& size, bool walls, int from) {
  const std::array<int, 3> at = Place(from, size);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t to = 0; to < cells.size(); ++to) {
    if (cells[to] == 0) continue;
    const std::array<int, 3> other = Place(static_cast<int>(to), size);
    best = std::min(best, std::hypot(at[0] - other[0], at[1] - other[1], at[2] - other[2]));
  }
  for (std::size_t axis = 0; axis < 3 && walls; ++axis) {
    best = std::min({best, at[axis] + 1.0, 1.0 * size[axis] - at[axis]});
  }
  return best;
}

void ExpectExactTransform(const VoxelSettings& settings, const Cells& cells) {
  DistanceFieldBuilder builder(settings);
  const DistanceField& field = builder.Transform(cells);
  ASSERT_EQ(field.values.size(), cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double expected =
        0.5 * BruteForce(cells, field.size, settings.walls, static_cast<int>(i));
    ASSERT_FLOAT_EQ(field.values[i], static_cast<float>(expected)) << "cell " << i;
  }
}

TEST(DistanceTransform, EqualsBruteForce) {
  std::mt19937_64 generator(11);
  const std::array<int, 3> sizes[] = {{1, 1, 1},  {7, 1, 1},   {1, 9, 1},   {1, 1, 5},
                                      {2, 3, 5},  {16, 4, 17}, {17, 16, 1}, {11, 13, 9},
                                      {33, 2, 3}, {3, 35, 4},  {5, 3, 37}};
  for (const auto& size : sizes) {
    const auto num = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                     static_cast<std::size_t>(size[2]);
    for (const bool walls : {false, true}) {
      const VoxelSettings settings = Grid(size[0], size[1], size[2], walls);
      SCOPED_TRACE(testing::Message()
                   << size[0] << " x " << size[1] << " x " << size[2] << (walls ? ", walls" : ""));
      ExpectExactTransform(settings, Cells(num, 0));
      ExpectExactTransform(settings, Cells(num, 1));
      for (const double share : {0.0, 0.005, 0.05, 0.5}) {
        Cells cells(num);
        for (auto& cell : cells) cell = std::bernoulli_distribution(share)(generator) ? 1 : 0;
        cells[generator() % num] = 1;  // with a share of 0: one cell
        ExpectExactTransform(settings, cells);
      }
    }
  }
}

TEST(DistanceTransform, RefusesAnotherNumberOfCells) {
  DistanceFieldBuilder builder(Grid(2, 2, 2, false));
  EXPECT_THROW(builder.Transform(Cells(7)), std::invalid_argument);
}

constexpr int kCells = 21;

VoxelSettings ShapeGrid() {
  VoxelSettings settings;
  settings.resolution_m = 0.1;
  settings.lower = Vector3d(-1, -1.05, -0.9);
  settings.upper = settings.lower + Vector3d::Constant(kCells * 0.1);
  return settings;
}

// Every cell that a solid reaches by a sample is marked; one whose samples are all too far for the
// solid to be between them is not.
template <int kSamples = 9, typename Distance>  // along an edge, both ends among them
void ExpectCellsMet(const VoxelGrid& grid, Distance distance) {
  const double spacing = grid.resolution() / (kSamples - 1);
  int num_occupied = 0;
  for (int k = 0; k < grid.size()[2]; ++k) {
    for (int j = 0; j < grid.size()[1]; ++j) {
      for (int i = 0; i < grid.size()[0]; ++i) {
        const bool occupied = grid.cells()[grid.Index(i, j, k)] != 0;
        num_occupied += occupied ? 1 : 0;
        const Vector3d corner = grid.origin() + grid.resolution() * Vector3d(i, j, k);
        double least = std::numeric_limits<double>::infinity();
        // Where the centre is too far from the solid, or too deep in it, one sample is enough.
        const double of_center = distance(grid.Center(i, j, k));
        if (std::abs(of_center) > grid.resolution()) least = of_center;
        const int num_samples = std::isfinite(least) ? 0 : kSamples * kSamples * kSamples;
        for (int s = 0; s < num_samples && least > 0; ++s) {
          const Eigen::Vector3i step(s % kSamples, s / kSamples % kSamples,
                                     s / kSamples / kSamples);
          least = std::min(least, distance(corner + spacing * step.cast<double>()));
        }
        if (least <= 0) {
          ASSERT_TRUE(occupied) << i << " " << j << " " << k << ": missed";
        } else if (least > spacing * std::sqrt(3) / 2) {
          ASSERT_FALSE(occupied) << i << " " << j << " " << k << ": " << least << " m away";
        }
      }
    }
  }
  EXPECT_GT(num_occupied, 0);
}

void ExpectVoxelised(const Shape& shape, const Eigen::Isometry3d& X_WS, const Shape& oracle) {
  VoxelGrid grid(ShapeGrid());
  grid.Mark(shape, X_WS);
  const Eigen::Isometry3d X_SW = X_WS.inverse();
  ExpectCellsMet(grid, [&](const Vector3d& p) { return OracleDistance(oracle, X_SW * p); });
}

// `oracle` is the same solid for the oracle.
void ExpectVoxelised(const Shape& shape, const Shape& oracle) {
  std::mt19937_64 generator(5);
  {
    SCOPED_TRACE("not turned");
    ExpectVoxelised(shape, Eigen::Isometry3d(Eigen::Translation3d(0.13, -0.21, 0.17)), oracle);
  }
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    ExpectVoxelised(shape, RandomPose(&generator, 0.8), oracle);  // some in part outside
  }
}

void ExpectVoxelised(const Shape& shape) { ExpectVoxelised(shape, shape); }

TEST(VoxelGrid, Boxes) {
  ExpectVoxelised(Box{{0.6, 0.5, 0.4}});
  ExpectVoxelised(Box{{1.3, 0.7, 0.04}});
  ExpectVoxelised(Box{{0, 0.9, 0.4}});
  ExpectVoxelised(Box{{9, 0.15, 9}});
}

TEST(VoxelGrid, Spheres) {
  ExpectVoxelised(Sphere{0.5});
  ExpectVoxelised(Sphere{0.12});
  VoxelGrid grid(ShapeGrid());
  const Eigen::Isometry3d X_WS(Eigen::Translation3d(40, 0, 0));
  grid.Mark(Sphere{40}, X_WS);
  ExpectCellsMet(grid, [&](const Vector3d& p) { return (p - X_WS.translation()).norm() - 40; });
}

TEST(VoxelGrid, Cylinders) {
  ExpectVoxelised(Cylinder{0.3, 0.8});
  ExpectVoxelised(Cylinder{0.8, 0.12});
  ExpectVoxelised(Cylinder{0.11, 2});
  ExpectVoxelised(Cylinder{10, 0.3});
}

TEST(VoxelGrid, Cones) {
  ExpectVoxelised(Cone{0.4, 0.8});
  ExpectVoxelised(Cone{0.9, 0.3});
  ExpectVoxelised(Cone{5, 5});
}

TEST(VoxelGrid, Capsules) {
  ExpectVoxelised(Capsule{0.3, 0.8});
  ExpectVoxelised(Capsule{0.06, 1.2});
}

TEST(VoxelGrid, HalfSpaces) { ExpectVoxelised(HalfSpace{}); }

TEST(VoxelGrid, ClosedMeshesAreSolid) {
  for (const Vector3d& size : {Vector3d(0.7, 0.6, 0.5), Vector3d(5, 5, 0.3)}) {
    ExpectVoxelised(Mesh{"", Vector3d::Ones(), BoxMesh(size)}, Box{size});
  }
}

TEST(VoxelGrid, OpenMeshesAreSurfaces) {
  TriangleMesh m = BoxMesh({0.9, 0.8, 0.7});
  m.triangles.pop_back();
  const Mesh mesh{"", Vector3d::Ones(), m};
  std::mt19937_64 generator(7);
  for (int round = 0; round < 2; ++round) {
    const Eigen::Isometry3d X_WS = RandomPose(&generator, 0.4);
    VoxelGrid grid(ShapeGrid());
    grid.Mark(mesh, X_WS);
    EXPECT_EQ(grid.cells()[grid.Index(0, 0, 0)], 0);
    // The oracle knows a mesh's surface by the absolute value; no sample lies on the surface, so
    // that what must be marked is told by points of the triangles.
    const Eigen::Isometry3d X_SW = X_WS.inverse();
    ExpectCellsMet<4>(grid, [&](const Vector3d& p) {
      return std::abs(OracleDistance(mesh, X_SW * p)) + std::numeric_limits<double>::min();
    });
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const auto& t : m.triangles) {
      for (int i = 0; i < 1000; ++i) {
        const double u = uniform(generator);
        const double v = uniform(generator) * (1 - u);
        const Vector3d p_W = X_WS * (m.vertices[t[0]] + u * (m.vertices[t[1]] - m.vertices[t[0]]) +
                                     v * (m.vertices[t[2]] - m.vertices[t[0]]));
        const Vector3d cell = ((p_W - grid.origin()) / grid.resolution()).array().floor();
        if (cell.minCoeff() < 0 || cell.maxCoeff() >= kCells) continue;
        ASSERT_EQ(grid.cells()[grid.Index(static_cast<int>(cell.x()), static_cast<int>(cell.y()),
                                          static_cast<int>(cell.z()))],
                  1);
      }
    }
  }
}

TEST(VoxelGrid, HollowObjectsAreTheCellsThatTheirSurfaceMeets) {
  const Shape shapes[] = {Box{{0.9, 0.7, 1.1}}, Sphere{0.6}, Cylinder{0.5, 0.9}, Cone{0.6, 1.2},
                          Capsule{0.4, 0.6}};
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.rotate(Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()));
  VoxelSettings settings = ShapeGrid();
  settings.hollow = true;
  for (const Shape& shape : shapes) {
    VoxelGrid solid(ShapeGrid());
    VoxelGrid hollow(settings);
    solid.Mark(shape, X_WS);
    hollow.Mark(shape, X_WS);
    int num_inside = 0;
    for (std::size_t i = 0; i < solid.cells().size(); ++i) {
      ASSERT_LE(hollow.cells()[i], solid.cells()[i]);
      num_inside += solid.cells()[i] - hollow.cells()[i];
    }
    EXPECT_GT(num_inside, 10) << "shape " << shape.index();
    // What is left out has no way out but through the shell: all its neighbours are of the solid.
    for (int k = 1; k + 1 < kCells; ++k) {
      for (int j = 1; j + 1 < kCells; ++j) {
        for (int i = 1; i + 1 < kCells; ++i) {
          const std::size_t at = solid.Index(i, j, k);
          if (solid.cells()[at] == hollow.cells()[at]) continue;
          for (const int step : {-1, 1}) {
            EXPECT_EQ(solid.cells()[solid.Index(i + step, j, k)], 1);
            EXPECT_EQ(solid.cells()[solid.Index(i, j + step, k)], 1);
            EXPECT_EQ(solid.cells()[solid.Index(i, j, k + step)], 1);
          }
        }
      }
    }
  }
}

TEST(VoxelGrid, TouchingIsMeetingWhateverTheRounding) {
  VoxelSettings settings;
  settings.resolution_m = 0.02;
  settings.upper = {0.1, 0.1, 0.2};
  VoxelGrid grid(settings);
  // From 0.06 to 0.1 m, on the grid's own planes.
  grid.Mark(Box{{0.02, 0.02, 0.04}},
            Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 0.1 * 0.8)));
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(grid.cells()[grid.Index(2, 2, k)], k >= 2 && k <= 5 ? 1 : 0) << k;
  }
  grid.Clear();
  grid.Mark(Sphere{0}, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 0.05)));
  EXPECT_EQ(std::count(grid.cells().begin(), grid.cells().end(), 1), 1);
  EXPECT_EQ(grid.cells()[grid.Index(2, 2, 2)], 1);
}

TEST(VoxelGrid, SolidsOutsideMarkNothing) {
  VoxelGrid grid(ShapeGrid());
  for (const Shape& shape : {Shape(Box{{1, 1, 1}}), Shape(Sphere{1}), Shape(Cylinder{1, 1}),
                             Shape(Cone{1, 1}), Shape(Mesh{"", {1, 1, 1}, BoxMesh({1, 1, 1})})}) {
    for (const Vector3d& p : {Vector3d(1e6, 0, 0), Vector3d(0, -3, 0), Vector3d(0, 0, 2.5)}) {
      grid.Mark(shape, Eigen::Isometry3d(Eigen::Translation3d(p)));
    }
  }
  EXPECT_EQ(std::count(grid.cells().begin(), grid.cells().end(), 1), 0);
}

TEST(DistanceField, IsThatOfTheObjectsAtTheirPoses) {
  Scene scene;
  std::mt19937_64 generator(3);
  const Eigen::Isometry3d X_WO = RandomPose(&generator, 0.3);
  const Eigen::Isometry3d X_OS = RandomPose(&generator, 0.3);
  const Box box{{0.5, 0.3, 0.2}};
  scene.objects = {{"ball", X_WO, {{Sphere{0.2}, Eigen::Isometry3d::Identity()}, {box, X_OS}}}};
  scene.attached = {{"hand", {"held", X_WO, {{Sphere{5}, Eigen::Isometry3d::Identity()}}}, {}}};

  VoxelGrid expected(ShapeGrid());
  expected.Mark(Sphere{0.2}, X_WO);
  expected.Mark(box, X_WO * X_OS);
  DistanceFieldBuilder reference(ShapeGrid());
  reference.Transform(expected.cells());

  DistanceFieldBuilder builder(ShapeGrid());
  builder.Rebuild(Scene{{}, {}, {}, {{"all", X_WO, {{Sphere{9}, X_OS}}}}, {}, {}, {}});
  EXPECT_EQ(*std::max_element(builder.field().values.begin(), builder.field().values.end()), 0);
  Scene broken = scene;
  broken.objects[0].shapes[0].shape = Mesh{};
  ExpectInputError([&] { builder.Rebuild(broken); }, {"ball", "no triangles"});
  const DistanceField& field = builder.Rebuild(scene);
  EXPECT_EQ(field.values, reference.field().values);
  EXPECT_EQ(field.size, (std::array<int, 3>{kCells, kCells, kCells}));
  EXPECT_EQ(field.origin, (std::array<float, 3>{-1, -1.05f, -0.9f}));
  EXPECT_EQ(field.resolution, 0.1f);
}

TEST(DistanceField, WallsStandAroundTheGrid) {
  VoxelSettings settings = ShapeGrid();
  DistanceFieldBuilder open(settings);
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(open.Rebuild({}).outside, infinity);
  EXPECT_EQ(open.field().values.front(), infinity);

  settings.walls = true;
  DistanceFieldBuilder walled(settings);
  const DistanceField& field = walled.Rebuild({});
  const VoxelGrid grid(settings);
  EXPECT_EQ(field.outside, 0);
  EXPECT_FLOAT_EQ(field.values[grid.Index(0, 7, 9)], 0.1f);
  EXPECT_FLOAT_EQ(field.values[grid.Index(9, 20, 9)], 0.1f);
  EXPECT_FLOAT_EQ(field.values[grid.Index(10, 10, 18)], 0.3f);
  EXPECT_FLOAT_EQ(field.values[grid.Index(10, 10, 10)], 1.1f);
}

TEST(DistanceField, RefusesImpossibleGrids) {
  VoxelSettings settings;
  ExpectInputError([&] { DistanceFieldBuilder{settings}; }, {"along x"});
  settings.upper = {1, 1, 1};
  settings.resolution_m = 0;
  ExpectInputError([&] { DistanceFieldBuilder{settings}; }, {"resolution_m"});
  settings.resolution_m = 0.001;
  ExpectInputError([&] { DistanceFieldBuilder{settings}; }, {"1000000000 cells", "64000000"});
}

}  // namespace
}  // namespace planbench
