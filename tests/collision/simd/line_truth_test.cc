// Triangles of meshes that are but lines or points, of the world, of the robot and attached: both
// engines against an oracle that knows how far a point is from a solid.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "collision/fcl/fcl_checker.h"
#include "collision/simd/simd_checker.h"
#include "geometry/polyhedra.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/flying_tool.h"
#include "tests/support/line_meshes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

Shape MeshShape(TriangleMesh triangles) {
  Mesh mesh;
  mesh.triangles = std::move(triangles);
  return mesh;
}

/// Something convex, and the same for the oracle.
struct Solid {
  Shape shape;
  Shape of_oracle;
};

std::vector<Solid> Solids() {
  std::vector<Solid> solids;
  for (const Shape& shape :
       {Shape(Box{{0.4, 0.3, 0.2}}), Shape(Sphere{0.2}), Shape(Cylinder{0.15, 0.4}),
        Shape(Cone{0.2, 0.3}), Shape(Capsule{0.1, 0.3}), Shape(HalfSpace{})}) {
    solids.push_back({shape, shape});
  }
  for (const Eigen::Vector3d& size : {Eigen::Vector3d(0.4, 0.3, 0.5), Eigen::Vector3d(2, 2, 2)}) {
    solids.push_back({MeshShape(BoxMesh(size)), Box{size}});
  }
  solids.push_back({MeshShape(LineMesh({{{0, 0, -0.25}, {0, 0, 0.25}}})), Capsule{0, 0.5}});
  return solids;
}

/// How far lines, at pose X_SL in the frame of a shape, are from it.
double LinesDistance(const Shape& shape, const Lines& lines, const Eigen::Isometry3d& X_SL) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : lines) {
    least = std::min(least, OracleLeastAlong(X_SL * a, X_SL * b, [&](const Eigen::Vector3d& p) {
                       return OracleDistance(shape, p);
                     }));
  }
  return least;
}

/// Both engines at random configurations of a flyer, and where contact begins between them.
void ExpectAsTheOracle(const Robot& robot, const Scene& scene,
                       const std::function<double(const Eigen::Isometry3d& X_WT)>& oracle,
                       std::mt19937_64* random) {
  FclChecker exact(robot, robot.groups.front(), CollisionModel::kMeshes);
  SimdChecker fast(robot, robot.groups.front(), CollisionModel::kMeshes);
  const std::vector<double> base(6, 0.0);
  exact.SetScene(scene, base);
  fast.SetScene(scene, base);
  const auto tool = static_cast<std::size_t>(robot.model.FindLink("tool"));
  const auto distance_at = [&](const std::vector<double>& q) {
    return oracle(ComputeLinkPoses(robot.model, q)[tool]);
  };
  const auto judge = [&](const std::vector<double>& q) {
    const double truth = distance_at(q);
    EXPECT_NEAR(std::max(exact.FindClosest(q).distance_m, 0.0), std::max(truth, 0.0), 1e-6);
    if (std::abs(truth) > 1e-6) {
      EXPECT_EQ(exact.IsFree(q), truth > 0) << truth;
    }
    if (truth <= 0 || truth > kBand_m) {
      EXPECT_EQ(fast.IsFree(q), truth > 0) << truth;
    }
  };
  std::vector<double> free_q;
  std::vector<double> hit_q;
  for (int i = 0; i < Trials(20); ++i) {
    std::vector<double> q;
    for (int j = 0; j < 6; ++j) {
      // Every other one is parallel to the axes of the world.
      q.push_back(
          j >= 3 && i % 2 == 0 ? 0.0 : std::uniform_real_distribution<double>(-0.9, 0.9)(*random));
    }
    judge(q);
    (distance_at(q) > 0 ? free_q : hit_q) = q;
    if (free_q.empty() || hit_q.empty()) continue;
    std::vector<double> near = free_q;
    std::vector<double> beyond = hit_q;
    for (int step = 0; step < 16; ++step) {
      std::vector<double> middle;
      for (std::size_t j = 0; j < 6; ++j) middle.push_back((near[j] + beyond[j]) / 2);
      (distance_at(middle) > 0 ? near : beyond) = middle;
    }
    judge(near);
    judge(beyond);
  }
}

TEST(LineTruthTest, OfTheRobot) {
  std::mt19937_64 random(41);
  for (const int num : {3, 4, 12}) {
    const Lines lines = RandomLines(num, 0.5, &random);
    const TemporaryFolder folder;
    const Robot robot = MakeFlyer(folder, LineMesh(lines));
    for (const Solid& solid : Solids()) {
      SCOPED_TRACE(std::to_string(num) + " and " + ShapeTypeName(solid.shape));
      const Eigen::Isometry3d X_WO = RandomPose(&random, 0.2);
      ExpectAsTheOracle(
          robot, SceneWith("thing", solid.shape, X_WO),
          [&](const Eigen::Isometry3d& X_WT) {
            return LinesDistance(solid.of_oracle, lines,
                                 X_WO.inverse() * X_WT * FlyerGeometryPose());
          },
          &random);
    }
  }
}

TEST(LineTruthTest, Attached) {
  std::mt19937_64 random(42);
  const TemporaryFolder folder;
  const Robot robot = MakeFlyer(folder, BoxMesh({0.01, 0.01, 0.01}));
  for (const int num : {1, 2, 9}) {
    const Lines lines = RandomLines(num, 0.5, &random);
    for (const Solid& solid : Solids()) {
      SCOPED_TRACE(std::to_string(num) + " and " + ShapeTypeName(solid.shape));
      // Where the turned axes are the shape's, lines are parallel to its faces.
      Eigen::Isometry3d X_WO = RandomPose(&random, 0.2);
      if (num == 9) X_WO.linear().setIdentity();
      Scene scene = SceneWith("thing", solid.shape, X_WO);
      scene.allowed_collisions.SetEntry("tool", "thing", true);
      scene.attached = {{"tool",
                         {"wires",
                          Eigen::Isometry3d::Identity(),
                          {{MeshShape(LineMesh(lines)), Eigen::Isometry3d::Identity()}}},
                         {}}};
      ExpectAsTheOracle(
          robot, scene,
          [&](const Eigen::Isometry3d& X_WT) {
            return LinesDistance(solid.of_oracle, lines, X_WO.inverse() * X_WT);
          },
          &random);
    }
  }
}

TEST(LineTruthTest, OfTheWorldAmongSolids) {
  std::mt19937_64 random(43);
  const Box box{{0.3, 0.2, 0.5}};
  const TemporaryFolder folder;
  const Robot robot = MakeFlyer(folder, BoxMesh(box.size));
  for (const int num : {1, 2, 9, 200}) {
    SCOPED_TRACE(num);
    const Lines lines = RandomLines(num, num == 200 ? 2 : 1, &random);
    const Eigen::Isometry3d X_WO = RandomPose(&random, 0.2);
    ExpectAsTheOracle(
        robot, SceneWith("wires", MeshShape(LineMesh(lines)), X_WO),
        [&](const Eigen::Isometry3d& X_WT) {
          return LinesDistance(box, lines, (X_WT * FlyerGeometryPose()).inverse() * X_WO);
        },
        &random);
  }
}

/// Carries lines past something at the origin, which its own tool may touch.
class LineCarrier {
 public:
  LineCarrier()
      : robot_(MakeFlyer(folder_, BoxMesh({0.01, 0.01, 0.01}))),
        checker_(robot_, robot_.groups.front(), CollisionModel::kMeshes) {}

  bool IsFree(const Shape& shape, const Lines& lines, const Eigen::Vector3d& angles = {0, 0, 0}) {
    Scene scene = SceneWith("thing", shape);
    scene.allowed_collisions.SetEntry("tool", "thing", true);
    scene.attached = {{"tool",
                       {"lines",
                        Eigen::Isometry3d::Identity(),
                        {{MeshShape(LineMesh(lines)), Eigen::Isometry3d::Identity()}}},
                       {}}};
    checker_.SetScene(scene, std::vector<double>(6, 0.0));
    return checker_.IsFree(std::vector<double>{0, 0, 0, angles.x(), angles.y(), angles.z()});
  }

 private:
  TemporaryFolder folder_;
  Robot robot_;
  SimdChecker checker_;
};

/// Single precision finds normals of triangles that are lines, and sides of lines that it sees from
/// their ends.
TEST(LineTruthTest, ThroughBoxesBesideCylindersAndPosts) {
  std::mt19937_64 random(44);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] {
    Eigen::Vector3d v;
    for (double& x : v) x = unit(random);
    return v;
  };
  LineCarrier carrier;
  for (int i = 0; i < Trials(300); ++i) {
    const Eigen::Vector3d middle = 0.05 * vector();
    const Eigen::Vector3d along = 0.3 * vector();
    const double rest = std::abs(unit(random));
    const Lines rod = {{middle + along, middle - rest * along}};
    for (int k = 0; k < 20; ++k) EXPECT_FALSE(carrier.IsFree(Box{{0.4, 0.3, 0.2}}, rod, vector()));
  }
  for (int i = 0; i < Trials(100); ++i) {  // around it, so that no plane is between
    Lines rods;
    for (int k = 0; k < 4; ++k) {
      const double angle = 0.7 + 0.1 * unit(random) + k * std::numbers::pi / 2;
      const Eigen::Vector3d foot(0.22 * std::cos(angle), 0.22 * std::sin(angle), 0);
      rods.emplace_back(foot, foot + Eigen::Vector3d(0, 0, unit(random)));
    }
    EXPECT_TRUE(carrier.IsFree(Cylinder{0.2, 0.4}, rods));
  }
  const Shape post = Capsule{0.01, 0.5};
  for (int i = 0; i < Trials(300); ++i) {  // beside a rod and two points
    Lines lines = {{0.2 * vector(), 0.2 * vector()}};
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d point = 0.2 * vector();
      lines.emplace_back(point, point);
    }
    const double distance = LinesDistance(post, lines, Eigen::Isometry3d::Identity());
    if (distance > kBand_m || distance < 0) {
      EXPECT_EQ(carrier.IsFree(post, lines), distance > 0) << distance;
    }
  }
}

/// The ends of rods that cross in their middles are the nearer the longer these are.
TEST(LineTruthTest, RodsThatCrossAndAreNearlyParallel) {
  LineCarrier carrier;
  for (const double half : {0.5, 1.0, 2.5}) {
    for (const double angle : {1e-3, 9e-5, 5e-5, 1e-5}) {
      SCOPED_TRACE(std::to_string(half) + " " + std::to_string(angle));
      const auto rod = [&](double turned, double height) -> Lines {
        const Eigen::Vector3d along(half * std::cos(turned), half * std::sin(turned), 0);
        return {{along + Eigen::Vector3d(0, 0, height), Eigen::Vector3d(0, 0, height) - along}};
      };
      EXPECT_FALSE(carrier.IsFree(MeshShape(LineMesh(rod(0.3, 0))), rod(0.3 + angle, 0)));
      EXPECT_TRUE(carrier.IsFree(MeshShape(LineMesh(rod(0.3, 0))), rod(0.3 + angle, 0.0002)));
    }
  }
}

}  // namespace
}  // namespace planbench
