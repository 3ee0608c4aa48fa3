#include "geometry/solid_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "geometry/polyhedra.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

/// Joins meshes; each vertex is repeated for every triangle, as in an STL file.
TriangleMesh Join(const std::vector<std::pair<TriangleMesh, Eigen::Vector3d>>& meshes) {
  TriangleMesh all;
  for (const auto& [mesh, offset] : meshes) {
    for (const auto& triangle : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      for (std::uint32_t index : triangle) all.vertices.push_back(mesh.vertices[index] + offset);
      all.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return all;
}

TriangleMesh Inverted(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
}

TriangleMesh Cube(double size) { return BoxMesh(Eigen::Vector3d::Constant(size)); }
const Eigen::Vector3d kHere = Eigen::Vector3d::Zero();

TEST(SolidMeshTest, TellsInsideFromOutside) {
  const Eigen::Vector3d size(1, 2, 3);
  const SolidMesh solid(Join({{BoxMesh(size), kHere}}));
  EXPECT_TRUE(solid.has_inside());
  EXPECT_EQ(solid.component_points().size(), 1u);
  std::mt19937_64 generator(6);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p(coordinate(generator), coordinate(generator), coordinate(generator));
    EXPECT_EQ(solid.Contains(p), ((p.cwiseAbs() - size / 2).array() < 0).all()) << p.transpose();
  }
}

TEST(SolidMeshTest, LinesAndPointsApartAreParts) {
  TriangleMesh mesh = Cube(1);
  mesh.vertices.insert(mesh.vertices.end(), {{3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {0, 7, 0}});
  // A line from the cube, two that join, a point; none of them opens the cube.
  mesh.triangles.insert(mesh.triangles.end(), {{0, 0, 1}, {8, 8, 9}, {9, 10, 9}, {11, 11, 11}});
  const SolidMesh solid(mesh);
  EXPECT_EQ(solid.component_points().size(), 3u);
  EXPECT_EQ(solid.survey().components, 1);
  EXPECT_TRUE(solid.Contains(kHere));
}

TEST(SolidMeshTest, SliversCloseAPartAndOpenNone) {
  TriangleMesh mesh = Cube(2);
  const auto [a, b, c] = mesh.triangles[0];
  const Eigen::Vector3d corner = mesh.vertices[c];
  // The middle of an edge that one side alone has.
  mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
  mesh.triangles[0] = {a, 8, c};
  mesh.triangles.push_back({8, b, c});
  EXPECT_FALSE(SolidMesh(mesh).has_inside());
  mesh.triangles.push_back({a, b, 8});
  const auto expect_cube = [&](std::size_t num_points) {
    const SolidMesh solid(mesh);
    EXPECT_EQ(solid.component_points().size(), num_points);
    EXPECT_EQ(solid.survey().components, 1);
    EXPECT_EQ(solid.survey().open, 0);
    EXPECT_EQ(solid.survey().not_oriented, 0);
    EXPECT_NEAR(solid.survey().volume, 8, 1e-12);
    EXPECT_TRUE(solid.Contains(kHere));
  };
  expect_cube(1);
  // From its short edges outwards, behind it in the file, and from theirs.
  const Eigen::Vector3d from = mesh.vertices[a];
  const Eigen::Vector3d along = mesh.vertices[b] - from;
  for (const double share : {2, 3, 4, 5}) mesh.vertices.emplace_back(from + share * along);
  mesh.triangles.insert(mesh.triangles.end(), {{a, 8, 9}, {8, b, 10}});
  expect_cube(1);
  mesh.triangles.insert(mesh.triangles.end(), {{8, 9, 11}, {b, 10, 12}});
  expect_cube(1);
  mesh.triangles.push_back({a, b, 8});  // once more
  expect_cube(1);
  // From a corner outwards, three that share edges; and one apart.
  for (const double share : {2, 3, 4, 5}) mesh.vertices.emplace_back(share * corner);
  mesh.triangles.insert(mesh.triangles.end(), {{c, 13, 14}, {13, 14, 15}, {c, 13, 16}});
  expect_cube(1);
  mesh.vertices.insert(mesh.vertices.end(), {{7, 0, 0}, {8, 0, 0}, {9, 0, 0}});
  mesh.triangles.push_back({17, 18, 19});
  expect_cube(2);
}

TEST(SolidMeshTest, TanglesOfSliversCloseAPart) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    TriangleMesh mesh = Cube(2);
    const std::size_t split = random() % mesh.triangles.size();
    const auto [a, b, c] = mesh.triangles[split];
    const Eigen::Vector3d from = mesh.vertices[a];
    const Eigen::Vector3d along = mesh.vertices[b] - from;
    std::vector<std::uint32_t> row = {a, b};
    for (const double share : {0.5, -1.0, -0.25, 0.125, 0.7, 1.5, 2.0}) {
      row.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(from + share * along);
    }
    mesh.triangles[split] = {a, row[2], c};
    mesh.triangles.push_back({row[2], b, c});
    mesh.triangles.push_back({a, b, row[2]});
    for (int i = 0; i < 9; ++i) {  // anywhere in the file
      std::ranges::shuffle(row, random);
      const auto place = static_cast<std::ptrdiff_t>(random() % mesh.triangles.size());
      mesh.triangles.insert(mesh.triangles.begin() + place, {row[0], row[1], row[2]});
    }
    const SolidMesh solid(mesh);
    EXPECT_EQ(solid.survey().components, 1);
    EXPECT_EQ(solid.survey().open, 0);
    EXPECT_EQ(solid.survey().not_oriented, 0);
    EXPECT_NEAR(solid.survey().volume, 8, 1e-12);
  }
}

/// Its walls are slivers, which share corners that are all but one.
TEST(SolidMeshTest, AFilmIsOpenWithoutOneSide) {
  TriangleMesh film = BoxMesh({2, 2, 1e-7});
  EXPECT_TRUE(SolidMesh(film).has_inside());
  std::erase_if(film.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::ranges::all_of(triangle,
                               [&](std::uint32_t corner) { return film.vertices[corner].z() < 0; });
  });
  EXPECT_FALSE(SolidMesh(film).has_inside());
}

/// They share their short edges, so that they are in no row.
TEST(SolidMeshTest, FansOfNeedlesOpenNone) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto near = [&](const Eigen::Vector3d& middle, double reach) {
    Eigen::Vector3d point = middle;
    for (int axis = 0; axis < 3; ++axis) point[axis] += reach * coordinate(random);
    return point;
  };
  for (int trial = 0; trial < Trials(100); ++trial) {
    const bool is_film = trial % 2 == 0;
    TriangleMesh mesh = BoxMesh({2, 2, is_film ? 1e-7 : 2});
    // A strip from a wall of the film, or a corner of the cube, with others from its sides.
    std::uint32_t a = 0;
    std::uint32_t b = 8;
    if (is_film) {
      b = 4;  // above it
    } else {
      mesh.vertices.push_back(near(mesh.vertices[a], 1e-8));
    }
    for (int i = 0; i < 6; ++i) {
      const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(near(mesh.vertices[a] + Eigen::Vector3d(2, 0, 0), 1));
      mesh.triangles.push_back({a, b, tip});
      if (random() % 2 == 0) continue;
      mesh.vertices.push_back(near(mesh.vertices[tip], 1e-8));
      mesh.triangles.push_back({tip, b, tip + 1});
      a = tip;
      b = tip + 1;
    }
    std::ranges::shuffle(mesh.triangles, random);
    const SolidMesh solid(mesh);
    EXPECT_EQ(solid.survey().components, 1);
    EXPECT_EQ(solid.survey().open, 0);
    EXPECT_EQ(solid.survey().not_oriented, 0);
    EXPECT_TRUE(solid.Contains(kHere));
  }
}

TEST(SolidMeshTest, RaysThroughEdgesAndVerticesCountOnce) {
  // An octahedron: the ray along z meets its tip, its edges and, from the side, its rim.
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
                    {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  const SolidMesh solid(mesh);
  for (double x = -1.5; x <= 1.5; x += 0.125) {
    for (double y = -1.5; y <= 1.5; y += 0.125) {
      for (double z = -1.5625; z <= 1.5; z += 0.125) {
        const double off_surface = std::abs(x) + std::abs(y) + std::abs(z) - 1;
        if (std::abs(off_surface) < 1e-9) continue;
        EXPECT_EQ(solid.Contains({x, y, z}), off_surface < 0) << x << " " << y << " " << z;
      }
    }
  }
}

/// A turned box of whose edges, of sides and within them, some are split for one triangle alone,
/// with slivers between; points are above and below its edges and vertices.
TEST(SolidMeshTest, RaysThroughSplitEdgesCountOnce) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::vector<Eigen::Vector3d> axes = {
      Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), {0.48, 0.6, 0.64}};
  for (int trial = 0; trial < Trials(300); ++trial) {
    const double length = 0.1 + 3 * unit(random);
    const Eigen::Vector3d size(length, 1, 0.3);
    const double angle = 6 * unit(random);
    const Eigen::AngleAxisd turn(angle, axes[static_cast<std::size_t>(trial) % axes.size()]);
    TriangleMesh mesh = BoxMesh(size);
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex = turn * vertex;
    std::vector<std::array<std::uint32_t, 3>> slivers;
    for (int i = 0; i < 8; ++i) {
      auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
      const auto [a, b, c] = triangle;
      const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
      const double share = 0.25 + 0.5 * unit(random);
      mesh.vertices.emplace_back(mesh.vertices[a] + share * (mesh.vertices[b] - mesh.vertices[a]));
      triangle = {b, c, middle};  // so that all edges have their turn
      mesh.triangles.push_back({c, a, middle});
      slivers.push_back({a, b, middle});
    }
    mesh.triangles.insert(mesh.triangles.end(), slivers.begin(), slivers.end());
    const SolidMesh solid(mesh);
    ASSERT_EQ(solid.survey().open + solid.survey().not_oriented, 0);
    ASSERT_NEAR(solid.survey().volume, size.prod(), 1e-12);
    for (const auto& triangle : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& from = mesh.vertices[triangle[k]];
        const Eigen::Vector3d& to = mesh.vertices[triangle[(k + 1) % 3]];
        const double share = std::min(1.0, 1.2 * unit(random));
        for (const double above : {-2.0, -0.3, -0.01, -1e-6, 1e-6, 0.01, 0.3, 2.0}) {
          const Eigen::Vector3d point =
              from + share * (to - from) + above * Eigen::Vector3d::UnitZ();
          const Eigen::Vector3d in_box = turn.inverse() * point;
          const double off_surface = (in_box.cwiseAbs() - size / 2).maxCoeff();
          if (std::abs(off_surface) < 1e-9) continue;
          EXPECT_EQ(solid.Contains(point), off_surface < 0)
              << "trial " << trial << ": " << point.transpose();
        }
      }
    }
  }
}

TEST(SolidMeshTest, OverlappingSolidsJoinAndInvertedOnesAreCavities) {
  const SolidMesh joined(Join({{Cube(2), kHere}, {Cube(2), Eigen::Vector3d(1, 0.1, 0.2)}}));
  EXPECT_EQ(joined.component_points().size(), 2u);
  EXPECT_TRUE(joined.Contains({0.5, 0.3, 0.3}));
  EXPECT_TRUE(joined.Contains({1.5, 0.3, 0.3}));
  const SolidMesh hollow(Join({{Cube(2), kHere}, {Inverted(Cube(1)), kHere}}));
  EXPECT_TRUE(hollow.Contains({0.75, 0.1, 0.2}));
  EXPECT_FALSE(hollow.Contains({0.25, 0.1, 0.2}));
  EXPECT_TRUE(SolidMesh(Inverted(Cube(2))).Contains({0.25, 0.1, 0.2}));
}

TEST(SolidMeshTest, InconsistentOrientationIsCountedByParity) {
  TriangleMesh mesh = Cube(2);
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  EXPECT_TRUE(SolidMesh(mesh).Contains({0.25, 0.1, 0.2}));
  EXPECT_FALSE(SolidMesh(mesh).Contains({0.25, 0.1, 1.2}));
}

TEST(SolidMeshTest, FacesThatAreThereTwiceCountOnce) {
  const Eigen::Vector3d off(0.9, 0, 0);
  for (const bool other_way : {false, true}) {
    SCOPED_TRACE(other_way);
    const TriangleMesh again = other_way ? Inverted(Cube(1)) : Cube(1);
    TriangleMesh mesh = Cube(1);
    for (const auto& triangle : again.triangles) {
      mesh.triangles.push_back(triangle);  // One, two, ... all of them.
      const SolidMesh solid(mesh);
      EXPECT_EQ(solid.survey().open, 0);
      EXPECT_NEAR(std::abs(solid.survey().volume), 1, 1e-9);
      EXPECT_TRUE(solid.Contains(kHere));
      EXPECT_FALSE(solid.Contains(off));
    }
  }
  // Two that share a face, which is there for either.
  for (const bool inverted : {false, true}) {
    const TriangleMesh second = inverted ? Inverted(Cube(1)) : Cube(1);
    const SolidMesh solid(Join({{Cube(1), kHere}, {second, Eigen::Vector3d::UnitX()}}));
    EXPECT_EQ(solid.survey().components, 1);
    EXPECT_EQ(solid.survey().open, 0);
    EXPECT_TRUE(solid.Contains(kHere));
    EXPECT_TRUE(solid.Contains(off));
    EXPECT_FALSE(solid.Contains(2 * off));
  }
}

TEST(SolidMeshTest, OpenSurfacesHaveNoInside) {
  TriangleMesh open = Cube(2);
  open.triangles.pop_back();
  EXPECT_FALSE(SolidMesh(open).has_inside());
  EXPECT_FALSE(SolidMesh(open).Contains({0.25, 0.1, 0.2}));
  // An open component beside a closed one takes nothing from it.
  const SolidMesh both(Join({{open, kHere}, {Cube(2), Eigen::Vector3d(5, 0, 0)}}));
  EXPECT_FALSE(both.Contains({0.25, 0.1, 0.2}));
  EXPECT_TRUE(both.Contains({5.25, 0.1, 0.2}));
}

}  // namespace
}  // namespace planbench
