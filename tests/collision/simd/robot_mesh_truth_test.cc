// The robot's own meshes in the vectorised engine against the exact one: a mesh that flies freely,
// among solids of every kind and beside another link's mesh; wherever the exact distance is more
// than 0.1 mm from zero the verdicts agree, nearer the vectorised engine errs towards collision.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "collision/edge_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/link_geometry.h"
#include "collision/simd/robot_meshes.h"
#include "collision/simd/simd_checker.h"
#include "geometry/polyhedra.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/flying_tool.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/line_meshes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

struct GeneratedMesh {
  std::string what;
  TriangleMesh triangles;
};

/// Closed and open, convex and not, of many parts, large and small triangles, some but lines or
/// points, on edges or apart.
std::vector<GeneratedMesh> ToolMeshes() {
  std::mt19937_64 random(20);
  TriangleMesh lines = BoxMesh({0.3, 0.2, 0.25});
  lines.vertices.push_back((lines.vertices[0] + 3 * lines.vertices[1]) / 4);
  const auto last = static_cast<std::uint32_t>(lines.vertices.size() - 1);
  lines.triangles.insert(lines.triangles.begin() + 3, {{0, 1, last}, {last, last, last}});
  const TriangleMesh torus = TorusMesh(0.25, 0.1, 16, 12);
  return {{"box with lines", lines},
          {"splinter", BoxMesh({0.002, 0.6, 0.001})},
          {"crumb", BoxMesh({0.004, 0.004, 0.004})},
          {"ball", SphereMesh(0.2, 24, 20)},
          {"torus", TorusMesh(0.25, 0.1, 40, 25)},
          {"torus inside out", TurnedInsideOut(torus)},
          {"sheet", SheetMesh(0.2, 0.5, 20, 20)},
          {"torus, ball and sheet", Joined(Joined(torus, SphereMesh(0.05, 12, 9), {0.4, 0, 0.1}),
                                           SheetMesh(0.1, 0.2, 5, 5), {0, 0.1, 0.3})},
          {"ball in a ball", Joined(SphereMesh(0.3, 20, 20),
                                    TurnedInsideOut(SphereMesh(0.25, 20, 20)), {0, 0, 0.02})},
          {"rods", LineMesh(RandomLines(12, 0.6, &random))},
          {"box among rods",
           Joined(BoxMesh({0.1, 0.2, 0.1}), LineMesh(RandomLines(12, 0.6, &random)), {0, 0, 0})}};
}

Mesh MeshFrom(TriangleMesh triangles) {
  Mesh mesh;
  mesh.triangles = std::move(triangles);
  return mesh;
}

std::vector<Shape> SolidsOfEveryKind() {
  return {Box{{0.4, 0.3, 0.2}},
          Box{{0.01, 0.01, 0.01}},
          Cylinder{0.15, 0.4},
          Cylinder{0.4, 0.01},
          Cylinder{0.003, 0.5},
          Sphere{0.2},
          Sphere{0.01},
          Capsule{0.1, 0.3},
          Capsule{0.02, 0.6},
          Cone{0.2, 0.3},
          HalfSpace{},
          MeshFrom(TorusMesh(0.3, 0.15, 30, 20)),
          MeshFrom(SheetMesh(0.3, 0.3, 8, 8)),
          MeshFrom(BoxMesh({0.02, 0.02, 0.02})),
          MeshFrom(LineMesh({{{-0.3, 0, 0}, {0.3, 0, 0}}, {{0, 0.2, 0.1}, {0, 0.2, 0.1}}})),
          MeshFrom(BoxMesh({1.5, 1.5, 1.5}))};
}

class MeshComparison {
 public:
  explicit MeshComparison(const Robot& robot)
      : exact_(robot, robot.groups.front(), CollisionModel::kMeshes),
        fast_(robot, robot.groups.front(), CollisionModel::kMeshes) {}
  void SetScene(const Scene& scene) {
    const std::vector<double> base(6, 0.0);
    exact_.SetScene(scene, base);
    fast_.SetScene(scene, base);
  }
  SimdChecker& fast() { return fast_; }
  FclChecker& exact() { return exact_; }

  int num_free = 0;
  int num_hit = 0;
  double band_m = kBand_m;  ///< Within which the engine may err towards collision.

  /// By rows of 6.
  void Judge(const std::vector<double>& qs) {
    const auto num = qs.size() / 6;
    std::vector<unsigned char> free(num);
    fast_.CheckAll(qs, static_cast<int>(num), free);
    for (std::size_t i = 0; i < num; ++i) {
      const auto q = std::span(qs).subspan(6 * i, 6);
      const bool exact_free = exact_.IsFree(q);
      ++(exact_free ? num_free : num_hit);
      EXPECT_EQ(fast_.IsFree(q), free[i] != 0) << "lanes matter";
      if ((free[i] != 0) == exact_free) continue;
      EXPECT_FALSE(free[i]) << "errs towards free";
      EXPECT_LE(exact_.FindClosest(q).distance_m, band_m);
    }
  }

  /// Random configurations, and of those that differ what is between them where contact begins.
  void JudgeRandom(int num, std::mt19937_64* random) {
    std::uniform_real_distribution<double> place(-0.7, 0.7);
    std::uniform_real_distribution<double> angle(-2, 2);
    std::vector<double> qs;
    std::vector<double> free_q;
    std::vector<double> hit_q;
    for (int i = 0; i < num; ++i) {
      std::vector<double> q;
      for (int j = 0; j < 6; ++j) q.push_back(j < 3 ? place(*random) : angle(*random));
      if (i % 4 == 1) q[0] = q[1] = q[2] = 0;
      qs.insert(qs.end(), q.begin(), q.end());
      (exact_.IsFree(q) ? free_q : hit_q) = q;
      if (free_q.empty() || hit_q.empty()) continue;
      double low = 0;
      double high = 1;
      for (int step = 0; step < 16; ++step) {
        const double middle = (low + high) / 2;
        (exact_.IsFree(Mix(free_q, hit_q, middle)) ? low : high) = middle;
      }
      for (const double beyond : {-1e-3, -1e-4, -1e-5, 1e-5, 1e-4, 1e-3}) {
        const std::vector<double> touching = Mix(free_q, hit_q, low + beyond);
        qs.insert(qs.end(), touching.begin(), touching.end());
      }
    }
    Judge(qs);
  }

 private:
  static std::vector<double> Mix(const std::vector<double>& a, const std::vector<double>& b,
                                 double fraction) {
    std::vector<double> q = a;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += fraction * (b[j] - a[j]);
    return q;
  }

  FclChecker exact_;
  SimdChecker fast_;
};

TEST(RobotMeshTruthTest, AMeshAmongSolidsOfEveryKind) {
  std::mt19937_64 random(21);
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    const TemporaryFolder folder;
    const Robot robot = MakeFlyer(folder, mesh.triangles);
    MeshComparison comparison(robot);
    for (const Shape& solid : SolidsOfEveryKind()) {
      SCOPED_TRACE(mesh.what + " and " + ShapeTypeName(solid));
      Eigen::Isometry3d X_WO = RandomPose(&random, 0.2);
      if (random() % 2 == 0) {  // upright ones have formulas of their own
        X_WO.linear() =
            Eigen::AngleAxisd(X_WO.linear()(0, 0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
      }
      comparison.SetScene(SceneWith("thing", solid, X_WO));
      comparison.JudgeRandom(Trials(6), &random);
    }
    EXPECT_GT(comparison.num_free, Trials(10)) << mesh.what;
    EXPECT_GT(comparison.num_hit, Trials(10)) << mesh.what;
  }
}

TEST(RobotMeshTruthTest, LinksBesideAndInsideEachOther) {
  constexpr const char* kBases[] = {R"(<mesh filename="ring.obj"/>)",
                                    R"(<cylinder radius="0.2" length="0.3"/>)",
                                    R"(<sphere radius="0.25"/>)", R"(<box size="1.6 1.5 1.2"/>)"};
  std::size_t next = 0;
  std::mt19937_64 random(22);
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    const TemporaryFolder folder;
    folder.Write("ring.obj", MeshAsObj(TorusMesh(0.35, 0.12, 30, 20)));
    const char* base = kBases[next++ % std::size(kBases)];
    SCOPED_TRACE(mesh.what + " and " + base);
    const Robot robot = MakeFlyer(folder, mesh.triangles, base, next % 2 == 0);
    MeshComparison comparison(robot);
    comparison.SetScene({});
    comparison.JudgeRandom(Trials(8), &random);
  }
}

/// How far from the origin robots are tried, m.
constexpr double kFarAway[] = {10, 100, 1000, 1e5};

TEST(RobotMeshTruthTest, FarFromTheOriginNoContactIsMissed) {
  std::mt19937_64 random(25);
  std::size_t next = 0;
  for (const double far_m : kFarAway) {
    for (const GeneratedMesh& mesh : ToolMeshes()) {
      const TemporaryFolder folder;
      folder.Write("ring.obj", MeshAsObj(TorusMesh(0.35, 0.12, 12, 8)));
      const Robot robot =
          MakeFlyer(folder, mesh.triangles, R"(<mesh filename="ring.obj"/>)", false, far_m);
      MeshComparison comparison(robot);
      comparison.band_m = kBand_m * (far_m + 10) / 5;
      for (const Shape& solid : SolidsOfEveryKind()) {
        if (++next % 4 != 0) continue;
        SCOPED_TRACE(mesh.what + " and " + ShapeTypeName(solid) + " at " + std::to_string(far_m));
        Eigen::Isometry3d X_WO = RandomPose(&random, 0.2);
        X_WO.pretranslate(Eigen::Vector3d(far_m, 0, 0));
        comparison.SetScene(SceneWith("thing", solid, X_WO));
        comparison.JudgeRandom(2, &random);
      }
    }
  }
}

/// What single precision makes of an angle moves the end of a long boom most.
TEST(RobotMeshTruthTest, AtTheEndOfALongBoomNoContactIsMissed) {
  std::mt19937_64 random(26);
  for (const double far_m : kFarAway) {
    const TemporaryFolder folder;
    folder.Write("tool.obj", MeshAsObj(BoxMesh({0.1, 0.1, 0.1})));
    Robot robot;
    robot.name = "boom";
    robot.model = RobotModel::FromUrdf(
        R"(<robot name="boom"> <link name="base"/> <link name="arm"/>
           <link name="tool"> <collision> <geometry> <mesh filename="tool.obj"/> </geometry>
           </collision> </link>
           <joint name="yaw" type="continuous"> <parent link="base"/> <child link="arm"/>
           <origin xyz="0.1 0.2 1"/> <axis xyz="0.1 0.2 1"/> </joint>)" +
            Boom("arm", "tool", far_m) + "</robot>",
        "boom.urdf");
    robot.groups = {robot.model.MakeGroup("arm", {"yaw"}, "tool")};
    robot.resources.base_folder = folder.path();
    SimdChecker fast(robot, robot.groups.front(), CollisionModel::kMeshes);
    FclChecker exact(robot, robot.groups.front(), CollisionModel::kMeshes);
    const int tool = robot.model.FindLink("tool");
    // A corner of a box is 0.01 mm inside of a face of the tool's.
    Eigen::Isometry3d X_TO(Eigen::Translation3d(0.01, 0.05 + 0.05 * std::sqrt(3.0) - 1e-5, 0.02));
    X_TO.rotate(
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitY()));
    int num_hit = 0;
    for (int i = 0; i < Trials(60); ++i) {
      const std::vector<double> q = {6 * UniformFraction(&random) - 3};
      const Eigen::Isometry3d X_WT =
          ComputeLinkPoses(robot.model, q)[static_cast<std::size_t>(tool)];
      const Scene scene = SceneWith("wall", Box{{0.1, 0.1, 0.1}}, X_WT * X_TO);
      fast.SetScene(scene, std::vector<double>{0.0});
      exact.SetScene(scene, std::vector<double>{0.0});
      if (exact.IsFree(q)) continue;
      ++num_hit;
      EXPECT_FALSE(fast.IsFree(q)) << far_m;
    }
    EXPECT_GT(num_hit, Trials(60) / 2) << far_m;
  }
}

TEST(RobotMeshTruthTest, CertifiedEdgesAreFreeAllAlong) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(-0.6, 0.6);
  int num_valid = 0;
  int num_refused = 0;
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    SCOPED_TRACE(mesh.what);
    const TemporaryFolder folder;
    const Robot robot = MakeFlyer(folder, mesh.triangles, R"(<box size="0.3 0.1 0.2"/>)", true);
    Scene scene;
    int i = 0;
    for (const Shape& solid : {Shape(Box{{0.2, 0.2, 0.1}}), Shape(Cylinder{0.05, 0.4}),
                               Shape(MeshFrom(SphereMesh(0.1, 10, 8)))}) {
      AddObject(&scene, "thing" + std::to_string(i++), solid, RandomPose(&random, 0.6));
    }
    MeshComparison comparison(robot);
    comparison.SetScene(scene);
    EdgeChecker certified(&comparison.fast(), 0.02, EdgeCheck::kCertified);
    EdgeChecker fine(&comparison.exact(), 0.002, EdgeCheck::kFixed);
    for (int k = 0; k < Trials(20); ++k) {
      std::vector<double> from;
      std::vector<double> to;
      for (int j = 0; j < 6; ++j) {
        from.push_back(unit(random));
        to.push_back(from.back() + unit(random) / 3);
      }
      const bool valid = certified.IsValidEdge(from, to);
      const bool free = fine.IsValidEdge(from, to);
      EXPECT_TRUE(free || !valid);
      num_valid += valid ? 1 : 0;
      num_refused += free && !valid ? 1 : 0;
    }
  }
  EXPECT_GT(num_valid, Trials(40));
  EXPECT_LE(num_refused, num_valid / 10);
}

TEST(RobotMeshTruthTest, DistancesAreExact) {
  std::mt19937_64 random(24);
  const TemporaryFolder folder;
  const Robot robot = MakeFlyer(folder, TorusMesh(0.25, 0.1, 20, 12), R"(<sphere radius="0.1"/>)");
  MeshComparison comparison(robot);
  comparison.SetScene(SceneWith("box", Box{{0.3, 0.3, 0.3}}, RandomPose(&random, 0.5)));
  std::vector<double> qs;
  for (int i = 0; i < 6 * 32; ++i) qs.push_back(1.5 * UniformFraction(&random) - 0.75);
  std::vector<double> distances(32);
  comparison.fast().FindDistances(qs, 32, 0.4, distances);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double exact =
        std::min(0.4, comparison.exact().FindClosest(std::span(qs).subspan(6 * i, 6)).distance_m);
    if (exact > 0) {
      EXPECT_NEAR(distances[i], exact, kBand_m);
    } else {
      EXPECT_LE(distances[i], 0);
    }
  }
}

TEST(RobotMeshTruthTest, WhatIsClosestDoesNotDependOnWhatWasAskedBefore) {
  const TemporaryFolder folder;
  std::mt19937_64 random(12);
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    SCOPED_TRACE(mesh.what);
    const Robot robot = MakeFlyer(folder, mesh.triangles, {}, true);
    MeshComparison walking(robot);
    MeshComparison fresh(robot);
    for (const Shape& shape : SolidsOfEveryKind()) {
      SCOPED_TRACE(ShapeTypeName(shape));
      const Scene scene = SceneWith("thing", shape, RandomPose(&random, 0.5));
      walking.SetScene(scene);
      std::vector<double> q(6);
      std::vector<double> step(6);
      for (double& value : q) value = UniformFraction(&random) - 0.5;
      for (double& value : step) value = 0.04 * (UniformFraction(&random) - 0.5);
      for (int i = 0; i < 10; ++i) {
        for (std::size_t j = 0; j < q.size(); ++j) q[j] += step[j];
        fresh.SetScene(scene);
        EXPECT_NEAR(walking.exact().FindClosest(q).distance_m,
                    fresh.exact().FindClosest(q).distance_m, 1e-9);
      }
    }
  }
}

/// Beside every solid, while the tool holds each of `held` in turn, or nothing (nullopt). Returns
/// how many clearances were greater than 0.
int ExpectClearancesNotFarBelow(const Robot& robot, const std::vector<std::optional<Shape>>& held,
                                std::mt19937_64* random) {
  int num_clear = 0;
  MeshComparison comparison(robot);
  for (const Shape& shape : SolidsOfEveryKind()) {
    SCOPED_TRACE(ShapeTypeName(shape));
    Scene scene = SceneWith("thing", shape, RandomPose(random, 0.5));
    scene.allowed_collisions.SetEntry("base", "thing", true);  // No motion makes these touch.
    for (const std::optional<Shape>& in_tool : held) {
      SCOPED_TRACE(in_tool ? ShapeTypeName(*in_tool) : "nothing held");
      scene.attached.clear();
      if (in_tool) {
        AttachedObject& attached = scene.attached.emplace_back();
        attached.link = "tool";
        attached.object.id = "held";
        attached.object.shapes.push_back({*in_tool, Eigen::Isometry3d::Identity()});
      }
      comparison.SetScene(scene);
      for (int i = 0; i < Trials(10); ++i) {
        std::vector<double> q;
        for (int j = 0; j < 6; ++j) q.push_back(2 * UniformFraction(random) - 1);
        double clearance = std::numeric_limits<double>::quiet_NaN();
        comparison.fast().FindClearances(q, 1, 0.4, {&clearance, 1});
        const double exact = std::min(0.4, comparison.exact().FindClosest(q).distance_m);
        EXPECT_LE(clearance, std::max(exact, 0.0) + kBand_m);
        // Cones are known by boxes and balls around them.
        if (in_tool || std::holds_alternative<Cone>(shape) || exact <= 0) continue;
        // Margins go down in steps of a factor of 1.54, and reach up to the square root of 3
        // further from boxes.
        EXPECT_GE(clearance, 0.37 * exact - kBand_m - 4e-4);
        num_clear += clearance > 0 ? 1 : 0;
      }
    }
  }
  return num_clear;
}

TEST(RobotMeshTruthTest, ClearancesAreLowerBoundsNotFarBelow) {
  const TemporaryFolder folder;
  std::mt19937_64 random(11);
  int num_clear = 0;
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    SCOPED_TRACE(mesh.what);
    num_clear += ExpectClearancesNotFarBelow(MakeFlyer(folder, mesh.triangles, {}, true),
                                             {std::nullopt}, &random);
  }
  EXPECT_GT(num_clear, Trials(100));
}

TEST(RobotMeshTruthTest, ClearancesOfARobotWithoutMeshesAreLowerBounds) {
  std::mt19937_64 random(12);
  const Robot robot = MakeFlyer(R"(<sphere radius="0.15"/>)", R"(<sphere radius="0.1"/>)");
  const int num_clear = ExpectClearancesNotFarBelow(
      robot, {std::nullopt, Cone{0.1, 0.4}, std::nullopt, Box{{0.1, 0.1, 0.5}}, std::nullopt},
      &random);
  EXPECT_GT(num_clear, Trials(50));
}

TEST(RobotMeshTruthTest, APartOfALargeMeshIsInsideALink) {
  const TemporaryFolder folder;
  const Robot robot = MakeFlyer(folder, BoxMesh({0.4, 0.4, 0.4}));
  MeshComparison comparison(robot);
  const TriangleMesh crumb = BoxMesh({0.01, 0.01, 0.01});
  const std::vector<double> origin(6, 0.0);
  comparison.SetScene(SceneWith("crumbs", MeshFrom(Joined(crumb, crumb, {3, 0, 0}))));
  EXPECT_FALSE(comparison.exact().IsFree(origin));
  EXPECT_FALSE(comparison.fast().IsFree(origin));

  TriangleMesh ring;  // of many crumbs, none of them in the link
  for (int i = 0; i < 60; ++i) {
    const double angle = i * std::numbers::pi / 30;
    ring = Joined(ring, crumb, 2 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
  }
  comparison.SetScene(SceneWith("crumbs", MeshFrom(ring)));
  EXPECT_TRUE(comparison.fast().IsFree(origin));
  comparison.SetScene(SceneWith("crumbs", MeshFrom(Joined(ring, crumb, {0.1, 0.1, 0}))));
  EXPECT_FALSE(comparison.exact().IsFree(origin));
  EXPECT_FALSE(comparison.fast().IsFree(origin));
}

TEST(RobotMeshTruthTest, AllowedPairsStandingContactsAndAttachedObjects) {
  const TemporaryFolder folder;
  const Robot robot = MakeFlyer(folder, SphereMesh(0.1, 12, 10), R"(<box size="0.4 0.4 0.4"/>)");
  SimdChecker checker(robot, robot.groups.front(), CollisionModel::kMeshes);
  const std::vector<double> base(6, 0.0);
  const std::vector<double> inside(6, 0.0);
  std::vector<double> outside(6, 0.0);
  outside[0] = 0.6;
  checker.SetScene({}, base);
  EXPECT_FALSE(checker.IsFree(inside));
  EXPECT_EQ(checker.FindContact(inside)->body_b, "tool");
  EXPECT_TRUE(checker.IsFree(outside));
  Scene scene;
  scene.allowed_collisions.SetEntry("base", "tool", true);
  checker.SetScene(scene, base);
  EXPECT_TRUE(checker.IsFree(inside));
  // Something that stands in the base is in collision always.
  checker.SetScene(SceneWith("crumb", Sphere{0.01}), base);
  EXPECT_FALSE(checker.IsFree(outside));
  // The hand holds something that is inside of the base, and touches none of its surface.
  scene = {};
  scene.attached = {{"tool",
                     {"ball",
                      Eigen::Isometry3d(Eigen::Translation3d(-0.6, 0, 0)),
                      {{Sphere{0.02}, Eigen::Isometry3d::Identity()}}},
                     {}}};
  checker.SetScene(scene, base);
  EXPECT_FALSE(checker.IsFree(outside));
  outside[0] = 1.2;
  EXPECT_TRUE(checker.IsFree(outside));
}

/// Checks that what a node claims to enclose of `patches` it does; adds that.
void ExpectEncloses(const RobotMeshes& meshes, const BallTree& node, std::vector<int>* patches,
                    std::vector<Eigen::Vector3d>* corners) {
  const std::size_t first = corners->size();
  for (const BallTree& child : node.children()) ExpectEncloses(meshes, child, patches, corners);
  if (node.patch() >= 0) {
    patches->push_back(node.patch());
    for (const auto& group : meshes.patches[static_cast<std::size_t>(node.patch())].groups) {
      corners->insert(corners->end(), group.corners.begin(), group.corners.end());
    }
  }
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < 50; ++i) {
    directions.push_back(
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
  }
  ASSERT_FALSE(node.hull().points.empty());
  for (const Eigen::Vector3d& direction : directions) {
    double hull = -1e9;
    for (const auto& point : node.hull().points) hull = std::max(hull, direction.dot(point));
    for (std::size_t i = first; i < corners->size(); ++i) {
      EXPECT_LE(direction.dot((*corners)[i]), hull + node.hull().slack + 1e-9);
    }
  }
  for (std::size_t i = first; i < corners->size(); ++i) {
    EXPECT_LE(((*corners)[i] - node.ball().center).norm(), node.ball().radius + 1e-9);
  }
}

/// Points all over the surface are each on a triangle of a patch, and within the box around what of
/// its group belongs to the patch.
void ExpectHoldsSurface(const RobotMeshes& meshes, const TriangleMesh& mesh) {
  struct Box {
    Eigen::AlignedBox3d box;
    const std::vector<std::array<Eigen::Vector3d, 3>>* triangles;
  };
  std::vector<Box> boxes;
  for (const RobotMeshes::Patch& patch : meshes.patches) {
    EXPECT_LE(patch.groups.size(), 16u);
    for (const RobotMeshes::Group& group : patch.groups) {
      EXPECT_LE(group.triangles.size(), 16u);
      Box& box = boxes.emplace_back();
      box.triangles = &group.triangles;
      for (const Eigen::Vector3d& corner : group.corners) box.box.extend(corner);
    }
  }
  std::mt19937_64 random(2);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corners = {mesh.vertices[a], mesh.vertices[b],
                                                    mesh.vertices[c]};
    for (int i = 0; i < 4; ++i) {
      const double u = UniformFraction(&random);
      const double v = UniformFraction(&random) * (1 - u);
      const Eigen::Vector3d point =
          corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
      EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
        return box.box.squaredExteriorDistance(point) < 1e-18 &&
               std::find(box.triangles->begin(), box.triangles->end(), corners) !=
                   box.triangles->end();
      }));
    }
  }
}

TEST(RobotMeshesTest, HoldEveryTriangleInEveryBallAndHullAboveIt) {
  const std::vector<LinkSphere> middles = {
      {0, {0.2, 0, 0}, 0.15}, {0, {-0.2, 0.1, 0}, 0.1}, {0, {0, 0, 0.1}, 0.3}};
  for (const GeneratedMesh& mesh : ToolMeshes()) {
    SCOPED_TRACE(mesh.what);
    const LinkGeometry link{0, {{Shape(MeshFrom(mesh.triangles)), Eigen::Isometry3d::Identity()}}};
    for (const bool with_middles : {false, true}) {
      const RobotMeshes meshes({link}, with_middles ? middles : std::vector<LinkSphere>());
      std::vector<int> patches;
      std::vector<Eigen::Vector3d> corners;
      ExpectEncloses(meshes, meshes.links.front().tree, &patches, &corners);
      std::sort(patches.begin(), patches.end());
      ASSERT_EQ(patches.size(), meshes.patches.size());
      for (std::size_t i = 0; i < patches.size(); ++i) EXPECT_EQ(patches[i], static_cast<int>(i));
      ExpectHoldsSurface(meshes, mesh.triangles);
      std::size_t num_points = 0;
      for (const RobotMeshes::Patch& patch : meshes.patches) num_points += patch.points.size();
      EXPECT_EQ(num_points, meshes.links.front().points.size());
    }
  }
}

}  // namespace
}  // namespace planbench
