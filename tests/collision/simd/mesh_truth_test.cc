// Meshes in the vectorised engine against the exact one: balls far from them, touching, deep
// inside; wherever the exact distance is more than 0.1 mm from zero the verdicts agree, nearer the
// vectorised engine errs towards collision only.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "collision/edge_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/simd/mesh_tree.h"
#include "collision/simd/simd_checker.h"
#include "geometry/polyhedra.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/line_meshes.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

constexpr char kGantryUrdf[] = R"(<robot name="gantry">
  <link name="base"/> <link name="x"/> <link name="y"/> <link name="tool"/>
  <joint name="along_x" type="prismatic">
    <parent link="base"/> <child link="x"/> <axis xyz="1 0 0"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/>
  </joint>
  <joint name="along_y" type="prismatic">
    <parent link="x"/> <child link="y"/> <axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/>
  </joint>
  <joint name="along_z" type="prismatic">
    <parent link="y"/> <child link="tool"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/>
  </joint>
</robot>)";

/// Carries three balls to wherever it is told: q is where its tool is. They stand under one ball.
Robot MakeGantry(double radius) {
  Robot robot;
  robot.name = "gantry";
  robot.model = RobotModel::FromUrdf(kGantryUrdf, "gantry.urdf");
  robot.groups = {robot.model.MakeGroup("gantry", {"along_x", "along_y", "along_z"}, "tool")};
  const int tool = robot.model.FindLink("tool");
  robot.spheres = {{tool, Eigen::Vector3d::Zero(), radius},
                   {tool, Eigen::Vector3d(0, radius, 0), radius / 2},
                   {tool, Eigen::Vector3d(radius, 0, 0), radius / 3}};
  return robot;
}

struct NamedMesh {
  std::string what;
  TriangleMesh triangles;
};

/// A fan of triangles as thin as numbers go, lines and points among them.
TriangleMesh Splinters() {
  TriangleMesh mesh;
  mesh.vertices = {{-0.4, 0, 0}, {0.5, 0.1, 0.2}};
  double width = 0.3;
  for (std::uint32_t i = 2; width > 1e-18; ++i, width /= 7) {
    mesh.vertices.emplace_back(0.1 * (i % 3), width, -width / 2);
    mesh.triangles.push_back({0, 1, i});
    mesh.triangles.push_back({i, 0, 0});
  }
  mesh.triangles.push_back({0, 1, 0});
  mesh.triangles.push_back({1, 1, 1});
  // Three points of one line.
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 0.3}, {0, 0, 0.4}, {0, 0, 0.6}});
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({last - 2, last - 3, last - 1});
  return mesh;
}

/// With triangles that are lines and points on its edges, as files have them.
TriangleMesh BoxWithLines() {
  TriangleMesh mesh = BoxMesh({0.5, 0.7, 0.6});
  mesh.vertices.push_back((mesh.vertices[0] + 3 * mesh.vertices[1]) / 4);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.triangles.insert(mesh.triangles.begin() + 3, {{0, 1, last}, {1, 0, 1}, {last, last, last}});
  return mesh;
}

/// Distance from the nearest triangle, each as its edges and, if it has an area, its face.
double SurfaceDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double best = 1e9;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d* corners[3] = {&mesh.vertices[triangle[0]], &mesh.vertices[triangle[1]],
                                         &mesh.vertices[triangle[2]]};
    const Eigen::Vector3d normal =
        (*corners[1] - *corners[0]).cross(*corners[2] - *corners[0]).normalized();
    bool over_face = normal.norm() > 0.5;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d along = *corners[(k + 1) % 3] - *corners[k];
      const Eigen::Vector3d from = p - *corners[k];
      const double t =
          along.norm() > 0 ? std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
      best = std::min(best, (from - t * along).norm());
      over_face = over_face && along.cross(from).dot(normal) > 1e-9;
    }
    if (over_face) best = std::min(best, std::abs(normal.dot(p - *corners[0])));
  }
  return best;
}

std::vector<NamedMesh> Meshes() {
  std::mt19937_64 random(10);
  const TriangleMesh torus = TorusMesh(0.5, 0.2, 60, 40);
  return {{"box", BoxMesh({0.4, 0.6, 1.0})},
          {"needle", BoxMesh({1e-4, 2.0, 1e-4})},
          {"crumb", BoxMesh({1e-5, 1e-5, 1e-5})},
          {"ball", SphereMesh(0.6, 40, 30)},
          {"torus", torus},
          {"torus inside out", TurnedInsideOut(torus)},
          {"sheet", SheetMesh(0.5, 1.0, 50, 50)},
          {"torus, ball and sheet", Joined(Joined(torus, SphereMesh(0.2, 12, 9), {0.9, 0.3, 0}),
                                           SheetMesh(0.3, 0.4, 5, 5), {0, 0.1, 0.5})},
          {"ball in a ball",
           Joined(SphereMesh(0.7, 20, 20), TurnedInsideOut(SphereMesh(0.6, 20, 20)), {0, 0, 0.02})},
          {"box with lines", BoxWithLines()},
          {"points and rods", LineMesh(RandomLines(40, 1.5, &random))},
          {"point", LineMesh(RandomLines(1, 1, &random))},
          {"ball among points and rods",
           Joined(SphereMesh(0.2, 12, 9), LineMesh(RandomLines(20, 1.5, &random)), {0, 0, 0})},
          {"hall", BoxMesh({12, 30, 8})}};
}

Shape AsShape(TriangleMesh triangles) {
  Mesh mesh;
  mesh.triangles = std::move(triangles);
  return mesh;
}

class SceneMeshComparison {
 public:
  SceneMeshComparison(const Robot& robot, const Scene& scene)
      : exact_(robot, robot.groups.front(), CollisionModel::kSpheres),
        fast_(robot, robot.groups.front()) {
    const std::vector<double> base(3, 0.0);
    exact_.SetScene(scene, base);
    fast_.SetScene(scene, base);
  }
  SimdChecker& fast() { return fast_; }
  FclChecker& exact() { return exact_; }
  int num_free() const { return num_free_; }
  int num_hit() const { return num_hit_; }

  /// By rows of 3.
  void Judge(const std::vector<double>& qs) {
    const auto num = qs.size() / 3;
    std::vector<unsigned char> free(num);
    std::vector<double> distances(num);
    fast_.CheckAll(qs, static_cast<int>(num), free);
    fast_.FindDistances(qs, static_cast<int>(num), 0.3, distances);
    for (std::size_t i = 0; i < num; ++i) {
      const auto q = std::span(qs).subspan(3 * i, 3);
      const bool exact_free = exact_.IsFree(q);
      const double distance = exact_.FindClosest(q).distance_m;
      ++(exact_free ? num_free_ : num_hit_);
      EXPECT_EQ(fast_.IsFree(q), free[i] != 0) << "lanes matter";
      if (!exact_free) {
        EXPECT_FALSE(free[i]) << "errs towards free at " << distance;
        EXPECT_LE(distances[i], 0);
        continue;
      }
      EXPECT_TRUE(free[i] != 0 || distance <= kBand_m) << distance;
      EXPECT_LE(distances[i], std::min(distance, 0.3) + 1e-7);
      EXPECT_GE(distances[i], std::min(distance, 0.3) - kBand_m);
    }
  }

 private:
  FclChecker exact_;
  SimdChecker fast_;
  int num_free_ = 0;
  int num_hit_ = 0;
};

TEST(MeshTruthTest, BallsAnywhereAndAtTheSurface) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(-1.3, 1.3);
  for (const NamedMesh& mesh : Meshes()) {
    SCOPED_TRACE(mesh.what);
    int num_free = 0;
    int num_hit = 0;
    for (const double radius : {0.001, 0.02, 0.15}) {
      const Robot robot = MakeGantry(radius);
      const Eigen::Isometry3d X_WO = RandomPose(&random, 0.5);
      SceneMeshComparison comparison(robot, SceneWith("thing", AsShape(mesh.triangles), X_WO));
      std::vector<double> qs;
      const auto add = [&](const Eigen::Vector3d& p) {
        if (p.cwiseAbs().maxCoeff() < 3) qs.insert(qs.end(), p.data(), p.data() + 3);
      };
      for (int i = 0; i < Trials(40); ++i) {
        add({coordinate(random), coordinate(random), coordinate(random)});
        // Touching, from any side, within the band and out of it.
        const Eigen::Vector3d surface = X_WO * RandomSurfacePoint(mesh.triangles, &random);
        const Eigen::Vector3d away =
            Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random))
                .normalized();
        for (const double gap : {-2e-3, -1.5e-4, -1e-6, 0.0, 2e-5, 1.5e-4, 2e-3}) {
          add(surface + (radius + gap) * away);
        }
      }
      comparison.Judge(qs);
      num_free += comparison.num_free();
      num_hit += comparison.num_hit();
    }
    EXPECT_GT(num_hit, Trials(30));
    if (mesh.what != "hall") {
      EXPECT_GT(num_free, Trials(30));
    }
  }
}

TEST(MeshTruthTest, DistancesAreThoseOfTheOracle) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  constexpr double kRadius = 0.01;
  Robot robot = MakeGantry(kRadius);
  robot.spheres.resize(1);
  for (const TriangleMesh& mesh :
       {TorusMesh(0.4, 0.2, 25, 20), SphereMesh(0.5, 9, 7), BoxMesh({0.5, 0.2, 0.9}),
        LineMesh(RandomLines(30, 1, &random)), LineMesh(RandomLines(1, 1, &random)),
        Joined(BoxMesh({0.3, 0.2, 0.3}), LineMesh(RandomLines(30, 1, &random)), {0, 0, 0})}) {
    const Shape shape = AsShape(mesh);
    SceneMeshComparison comparison(robot, SceneWith("thing", shape));
    std::vector<double> qs;
    for (int i = 0; i < 160 * 3; ++i) qs.push_back(coordinate(random));
    std::vector<double> distances(160);
    comparison.fast().FindDistances(qs, 160, 0.4, distances);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const auto q = std::span(qs).subspan(3 * i, 3);
      const double truth = OracleDistance(shape, Eigen::Vector3d::Map(q.data())) - kRadius;
      EXPECT_NEAR(comparison.exact().FindClosest(q).distance_m, truth, 1e-9);
      const double oracle = std::min(0.4, truth);
      if (oracle > 0) {
        EXPECT_NEAR(distances[i], oracle, kBand_m);
      } else {
        EXPECT_LE(distances[i], 0);
      }
    }
  }
}

TEST(MeshTruthTest, SplintersAreWhatTheyAre) {
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> coordinate(-0.6, 0.6);
  Robot robot = MakeGantry(0.01);
  robot.spheres.resize(1);
  const TriangleMesh mesh = Splinters();
  SceneMeshComparison comparison(robot, SceneWith("splinters", AsShape(mesh)));
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d q(coordinate(random), coordinate(random), coordinate(random));
    if (i % 2 == 0) q = RandomSurfacePoint(mesh, &random) + 0.02 * q;
    const std::span<const double> at(q.data(), 3);
    const double truth = SurfaceDistance(mesh, q) - 0.01;
    EXPECT_NEAR(comparison.exact().FindClosest(at).distance_m, truth, 1e-7);
    if (std::abs(truth) > 1e-7) {
      EXPECT_EQ(comparison.exact().IsFree(at), truth > 0) << truth;
    }
    const double expected = std::min(0.2, truth);
    double distance = 0;
    comparison.fast().FindDistances(at, 1, 0.2, std::span(&distance, 1));
    EXPECT_LE(distance, expected + 1e-7);
    EXPECT_GE(distance, expected - kBand_m);
  }
}

TEST(MeshTruthTest, ManyMeshesObjectsOfSeveralAndAllowedPairs) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> coordinate(-0.9, 0.9);
  const Robot robot = MakeGantry(0.05);
  const TriangleMesh meshes[] = {TorusMesh(0.15, 0.06, 16, 10), SphereMesh(0.18, 12, 9),
                                 SheetMesh(0.15, 0.3, 9, 9)};
  for (const int num_objects : {7, 40}) {  // 40: the solids are found by a hierarchy
    Scene scene;
    for (int i = 0; i < num_objects; ++i) {
      const TriangleMesh& small = meshes[i % 3];
      AddObject(&scene, "thing" + std::to_string(i), AsShape(small), RandomPose(&random, 1.2));
      scene.objects.back().shapes.push_back(
          {Shape(Box{{0.1, 0.2, 0.1}}), RandomPose(&random, 0.3)});
      scene.objects.back().shapes.push_back({AsShape(small), RandomPose(&random, 0.3)});
    }
    scene.allowed_collisions.SetEntry("tool", "thing1", true);
    SceneMeshComparison comparison(robot, scene);
    std::vector<double> qs;
    for (int i = 0; i < Trials(400) * 3; ++i) qs.push_back(coordinate(random));
    comparison.Judge(qs);
    EXPECT_GT(comparison.num_free(), Trials(20));
    EXPECT_GT(comparison.num_hit(), 0);
  }
}

TEST(MeshTruthTest, CertifiedEdgesAreFreeAllAlong) {
  std::mt19937_64 random(14);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const Robot robot = MakeGantry(0.02);
  int num_valid = 0;
  int num_refused = 0;
  for (const NamedMesh& mesh : Meshes()) {
    if (mesh.what == "hall") continue;
    SCOPED_TRACE(mesh.what);
    SceneMeshComparison comparison(robot, SceneWith("thing", AsShape(mesh.triangles)));
    EdgeChecker certified(&comparison.fast(), 0.02, EdgeCheck::kCertified);
    EdgeChecker fine(&comparison.exact(), 0.001, EdgeCheck::kFixed);
    for (int i = 0; i < Trials(30); ++i) {
      const std::vector<double> from = {coordinate(random), coordinate(random), coordinate(random)};
      const std::vector<double> to = {coordinate(random), coordinate(random), coordinate(random)};
      const bool valid = certified.IsValidEdge(from, to);
      const bool free = fine.IsValidEdge(from, to);
      EXPECT_TRUE(free || !valid);
      num_valid += valid ? 1 : 0;
      num_refused += free && !valid ? 1 : 0;
    }
  }
  EXPECT_GT(num_valid, Trials(50));
  EXPECT_LE(num_refused, num_valid / 20);
}

TEST(MeshTruthTest, ASceneSetAgainWithOtherMeshesIsAnother) {
  const Robot robot = MakeGantry(0.05);
  const std::vector<double> base(3, 0.0);
  SimdChecker checker(robot, robot.groups.front());
  const std::vector<double> q = {0.3, 0, 0};
  TriangleMesh mesh = BoxMesh({0.4, 0.4, 0.4});
  checker.SetScene(SceneWith("thing", AsShape(mesh)), base);
  EXPECT_TRUE(checker.IsFree(q));
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.x() *= 2;
  checker.SetScene(SceneWith("thing", AsShape(mesh)), base);
  EXPECT_FALSE(checker.IsFree(q));
  Eigen::Isometry3d aside = Eigen::Isometry3d::Identity();
  aside.translation().x() = -0.4;
  checker.SetScene(SceneWith("thing", AsShape(mesh), aside), base);
  EXPECT_TRUE(checker.IsFree(q));
}

TEST(MeshTreeTest, HoldsEveryTriangleOnce) {
  for (const NamedMesh& mesh : Meshes()) {
    SCOPED_TRACE(mesh.what);
    const MeshTree built(mesh.triangles);
    const kernels::TriangleTree& tree = built.tree();
    std::size_t num_triangles = 0;
    std::vector<int> open = {0};
    while (!open.empty()) {
      const kernels::BoxGroup& group = tree.boxes[static_cast<std::size_t>(open.back())];
      open.pop_back();
      for (int i = 0; i < kernels::kWide; ++i) {
        if (group.low[0][i] > group.high[0][i] || group.low[0][i] > 1e6f) continue;
        if (group.child[i] >= 0) {
          open.push_back(group.child[i]);
          continue;
        }
        const kernels::TriangleGroup& leaf =
            tree.triangles[static_cast<std::size_t>(~group.child[i])];
        num_triangles += static_cast<std::size_t>(
            std::count_if(std::begin(leaf.position[2]), std::end(leaf.position[2]),
                          [](float position) { return position < 1e6f; }));
      }
    }
    EXPECT_EQ(num_triangles, mesh.triangles.triangles.size());
  }
}

TEST(MeshTreeTest, BallsHoldAPointOfEveryPartOnce) {
  std::mt19937_64 random(8);
  const MeshTree built(SharedMesh(LineMesh(RandomLines(1000, 2, &random))));
  const kernels::TriangleTree& tree = built.tree();
  ASSERT_GT(tree.points.size(), 500u);
  std::int32_t next = 0;
  double radii = 0;
  for (const kernels::PointBall& ball : tree.point_balls) {
    EXPECT_EQ(ball.first, next);
    next += ball.num;
    radii += ball.radius;
    for (std::int32_t i = ball.first; i < next; ++i) {
      const auto& point = tree.points[static_cast<std::size_t>(i)];
      const Eigen::Vector3f center = Eigen::Vector3f::Map(ball.center);
      EXPECT_LE((Eigen::Vector3f::Map(point.data()) - center).norm(), ball.radius);
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(next), tree.points.size());
  EXPECT_LT(radii / static_cast<double>(tree.point_balls.size()), 0.5);  // those nearby share one
}

}  // namespace
}  // namespace planbench
