// The vectorised engine against the exact one: wherever the exact distance is more than 0.1 mm from
// zero the verdicts agree; nearer, the vectorised engine errs towards collision only.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/simd/simd_checker.h"
#include "common/random.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_yaml.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/shared_data.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

class Comparison {
 public:
  Comparison(const Robot& robot, const Scene& scene, std::span<const double> base_positions)
      : exact_(robot, robot.groups.front(), CollisionModel::kSpheres),
        fast_(robot, robot.groups.front()) {
    exact_.SetScene(scene, base_positions);
    fast_.SetScene(scene, base_positions);
  }
  SimdChecker& fast() { return fast_; }
  FclChecker& exact() { return exact_; }
  int num_free() const { return num_free_; }
  int num_disputed() const { return num_disputed_; }

  void Judge(std::span<const double> q, bool fast_free) {
    const bool exact_free = exact_.IsFree(q);
    num_free_ += exact_free ? 1 : 0;
    if (fast_free == exact_free) return;
    ++num_disputed_;
    EXPECT_FALSE(fast_free) << "errs towards free";
    EXPECT_LE(exact_.FindClosest(q).distance_m, kBand_m);
  }

  void JudgeRandom(int num, std::uint64_t seed) {
    const JointSpace& space = fast_.space();
    std::mt19937_64 generator(seed);
    std::vector<double> qs;
    for (int i = 0; i < num; ++i) {
      auto q = RandomConfiguration(space, &generator);
      // At their limits joints come nearest to what is said never to meet.
      for (int j = 0; i % 3 == 0 && j < space.size(); ++j) {
        const std::uint64_t dice = generator() % 4;
        if (dice == 0) q[static_cast<std::size_t>(j)] = space.joint(j).lower;
        if (dice == 1) q[static_cast<std::size_t>(j)] = space.joint(j).upper;
      }
      qs.insert(qs.end(), q.begin(), q.end());
    }
    std::vector<unsigned char> free(static_cast<std::size_t>(num));
    fast_.CheckAll(qs, num, free);
    const auto n = static_cast<std::size_t>(space.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      Judge(std::span(qs).subspan(i * n, n), free[i] != 0);
    }
  }

 private:
  FclChecker exact_;
  SimdChecker fast_;
  int num_free_ = 0;
  int num_disputed_ = 0;
};

struct World {
  std::string what;
  Robot robot;
  Scene scene;
  std::vector<double> base_positions;
};

/// The Fetch in scenes of its own and in published ones, where these are at hand.
std::vector<World> FetchWorlds() {
  std::vector<World> worlds;
  std::vector<std::filesystem::path> folders = {PLANBENCH_SOURCE_DIR "/problems/shelf_demo"};
  for (const char* set : {"bookshelf_small_fetch", "box_fetch", "table_pick_fetch"}) {
    const auto folder = SharedData("problems") / set;
    if (std::filesystem::exists(folder)) folders.push_back(folder);
  }
  const Robot robot = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch");
  for (const auto& folder : folders) {
    for (const int index : {1, 4}) {
      const ProblemFiles* files = nullptr;
      const ProblemSet set = ListProblemSet(folder);
      files = set.Find(index);
      const Problem problem = ReadProblem(files->scene, files->request, robot);
      worlds.push_back({files->scene.string(), robot, problem.scene,
                        FullPositions(robot.model, problem.start.names, problem.start.positions,
                                      files->request.string())});
    }
  }
  return worlds;
}

TEST(SimdTruthTest, RandomConfigurationsInShelvesBoxesAndTables) {
  for (const World& world : FetchWorlds()) {
    SCOPED_TRACE(world.what);
    Comparison comparison(world.robot, world.scene, world.base_positions);
    constexpr int kNum = Trials(100'000);
    comparison.JudgeRandom(kNum, 1);
    EXPECT_GT(comparison.num_free(), kNum / 10);
    EXPECT_LT(comparison.num_free(), kNum);
    EXPECT_LT(comparison.num_disputed(), kNum / 500);
  }
}

TEST(SimdTruthTest, RandomConfigurationsAmongShapesOfAllKinds) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    Comparison comparison(arm, world.scene, base);
    constexpr int kNum = Trials(20'000);
    comparison.JudgeRandom(kNum, 2);
    EXPECT_LT(comparison.num_disputed(), kNum / 50);
  }
}

/// Things to hold in a hand: shapes of all kinds, thin and long ones, what the kernels judge
/// themselves and what they leave to the exact engine, and one that others fit into.
std::vector<SceneObject> ThingsToHold() {
  const auto at = [](double x, double y, double z, double angle) {
    Eigen::Isometry3d X(Eigen::Translation3d(x, y, z));
    X.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, 1, 0.2).normalized()));
    return X;
  };
  const auto of = [&](const std::string& id, const Shape& shape) {
    return SceneObject{id, at(0.3, 0.05, 0, 0.4), {{shape, at(0, 0, 0.02, 1.1)}}};
  };
  SceneObject several{"several", at(0.25, 0, 0.1, -0.7), {}};
  several.shapes = {{Box{{0.02, 0.3, 0.1}}, at(0.1, 0, 0, 0.2)},
                    {Cylinder{0.03, 0.2}, at(0, 0.1, 0, 2)},
                    {Sphere{0.06}, at(0, -0.15, 0, 0)}};
  SceneObject with_cone = several;
  with_cone.id = "with_cone";
  with_cone.shapes.push_back({Cone{0.05, 0.1}, at(0.1, 0.2, 0, 0)});
  return {{"centred", at(0.3, 0, 0, 0), {{Box{{0.1, 0.1, 0.1}}, at(0, 0, 0, 0)}}},
          of("tray", Box{{0.25, 0.2, 0.02}}),
          of("chest", Box{{0.7, 0.6, 0.5}}),
          of("rod", Cylinder{0.01, 0.8}),
          of("ball", Sphere{0.07}),
          several,
          with_cone,
          of("mesh", Mesh{"", Eigen::Vector3d::Ones(), SphereMesh(0.12, 12, 8)}),
          of("fine_mesh", Mesh{"", Eigen::Vector3d::Ones(), SphereMesh(0.12, 40, 30)})};
}

TEST(SimdTruthTest, AttachedObjectsOfEveryKindAmongShapesOfAllKinds) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  int num_valid = 0;
  int num_judged = 0;
  int num_disputed = 0;
  for (NamedScene& world : MakeTestScenes()) {
    for (const SceneObject& thing : ThingsToHold()) {
      SCOPED_TRACE(world.what + ", " + thing.id);
      world.scene.attached = {{"hand", thing, {"finger", "pad"}},
                              {"upper", {"strap", Eigen::Isometry3d::Identity(), {}}, {}}};
      world.scene.attached.back().object.shapes = {
          {Box{{0.3, 0.05, 0.05}}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.15))}};
      Comparison comparison(arm, world.scene, base);
      constexpr int kNum = Trials(400);
      comparison.JudgeRandom(kNum, 6);
      num_judged += kNum;
      num_disputed += comparison.num_disputed();

      EdgeChecker certified(&comparison.fast(), arm.edge_resolution_m, EdgeCheck::kCertified);
      EdgeChecker fine(&comparison.exact(), arm.edge_resolution_m / 16, EdgeCheck::kFixed);
      const JointSpace& space = comparison.fast().space();
      std::mt19937_64 generator(7);
      for (int i = 0; i < Trials(12); ++i) {
        const auto from = RandomConfiguration(space, &generator);
        auto to = RandomConfiguration(space, &generator);
        space.Interpolate(from, to, 0.2, to);
        if (!certified.IsValidEdge(from, to)) continue;
        ++num_valid;
        EXPECT_TRUE(fine.IsValidEdge(from, to));
      }
      // Distances have the sign of the verdicts, and are the exact ones.
      for (int i = 0; i < Trials(4); ++i) {
        const auto q = RandomConfiguration(space, &generator);
        double fast_m = 0;
        double exact_m = 0;
        comparison.fast().FindDistances(q, 1, 0.2, {&fast_m, 1});
        comparison.exact().FindDistances(q, 1, 0.2, {&exact_m, 1});
        if (exact_m > 0) {
          EXPECT_NEAR(fast_m, exact_m, kBand_m);
        } else if (exact_m < -kBand_m) {
          EXPECT_LE(fast_m, 0);
        }
      }
    }
  }
  EXPECT_LT(num_disputed, num_judged / 50);
  EXPECT_GT(num_valid, Trials(100));
}

/// What turns about the middle of its only ball: the ball stays where it is, its corners do not.
TEST(SimdTruthTest, AnObjectThatTurnsAboutItsMiddleHitsWithItsEdges) {
  Robot robot;
  robot.name = "spindle";
  robot.model = RobotModel::FromUrdf(R"(<robot name="spindle">
    <link name="base"/><link name="tool"/>
    <joint name="roll" type="continuous"><parent link="base"/><child link="tool"/>
      <origin xyz="0 0 1"/><axis xyz="1 0 0"/></joint></robot>)",
                                     "spindle.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"roll"}, "tool")};
  // An edge of the cube comes 0.4 mm into it, at 45 degrees.
  robot.spheres = {{robot.model.FindLink("base"), Eigen::Vector3d(0.2, 0.1137, 1), 0.001}};
  Scene scene;
  scene.attached = {{"tool",
                     {"cube",
                      Eigen::Isometry3d(Eigen::Translation3d(0.2, 0, 0)),
                      {{Box{{0.16, 0.16, 0.16}}, Eigen::Isometry3d::Identity()}}},
                     {}}};
  Comparison comparison(robot, scene, std::vector<double>{0.0});
  EdgeChecker certified(&comparison.fast(), 0.02, EdgeCheck::kCertified);
  const std::vector<double> corner = {std::numbers::pi / 4};
  EXPECT_FALSE(comparison.exact().IsFree(corner));
  EXPECT_FALSE(comparison.fast().IsFree(corner));
  for (int i = 0; i < 50; ++i) {
    const std::vector<double> from = {0.005 * i};
    const std::vector<double> to = {1.3 + 0.003 * i};
    EXPECT_TRUE(comparison.fast().IsFree(from));
    EXPECT_TRUE(comparison.fast().IsFree(to));
    EXPECT_FALSE(certified.IsValidEdge(from, to)) << i;
  }
  EXPECT_TRUE(certified.IsValidEdge(std::vector<double>{0.0}, std::vector<double>{0.6}));
}

/// Positions far out are rounded: the engine errs towards collision there too.
TEST(SimdTruthTest, ContactsFarFromTheLinkAreNotMissed) {
  Robot robot;
  robot.name = "beacon";
  robot.model = RobotModel::FromUrdf(R"(<robot name="beacon">
    <link name="base"/><link name="tool"/>
    <joint name="yaw" type="continuous"><parent link="base"/><child link="tool"/>
      <origin xyz="0.1 0.2 1"/><axis xyz="0.1 0.2 1"/></joint></robot>)",
                                     "beacon.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"yaw"}, "tool")};
  const int tool = robot.model.FindLink("tool");
  const Box box{{0.1, 0.1, 0.1}};
  std::mt19937_64 generator(8);
  for (const double far_m : {30.0, 900.0, 1e4, 1e6, 9e8}) {
    for (int i = 0; i < Trials(50); ++i) {
      const std::vector<double> q = {6 * UniformFraction(&generator) - 3};
      const Eigen::Vector3d p_T(far_m, far_m * UniformFraction(&generator), 0.3);
      const Eigen::Vector3d p_W = ComputeLinkPoses(robot.model, q)[tool] * p_T;
      Scene scene;
      scene.objects = {{"wall", Eigen::Isometry3d(Eigen::Translation3d(p_W)), {}}};
      scene.objects[0].shapes = {{box, Eigen::Isometry3d(Eigen::Translation3d(0.03, -0.02, 0.04))}};
      robot.spheres = {{tool, Eigen::Vector3d::Zero(), 0.05}};
      scene.attached = {{"tool", {"cube", Eigen::Isometry3d::Identity(), {}}, {}}};
      scene.attached[0].object.shapes = {{box, Eigen::Isometry3d(Eigen::Translation3d(p_T))}};
      Comparison held(robot, scene, std::vector<double>{0.0});
      EXPECT_FALSE(held.exact().IsFree(q));
      EXPECT_FALSE(held.fast().IsFree(q)) << far_m;
      // A sphere of the robot itself that is 1 um in a ball.
      scene.attached.clear();
      robot.spheres = {{tool, p_T, 0.05}};
      scene.objects[0].shapes = {
          {Sphere{0.05}, Eigen::Isometry3d(Eigen::Translation3d(0.1 - 1e-6, 0, 0))}};
      Comparison own(robot, scene, std::vector<double>{0.0});
      EXPECT_TRUE(own.exact().IsFree(q) || !own.fast().IsFree(q)) << far_m;
    }
  }
}

TEST(SimdTruthTest, ContactsFarAlongARailAreNotMissed) {
  std::mt19937_64 generator(9);
  for (const double far_m : {10.0, 100.0, 1000.0, 10'000.0}) {
    Robot robot;
    robot.name = "train";
    robot.model = RobotModel::FromUrdf(
        R"(<robot name="train"> <link name="base"/> <link name="tool"/>
           <joint name="slide" type="prismatic"> <parent link="base"/> <child link="tool"/>
           <origin xyz="0.1 0.2 1"/> <axis xyz="0.3 0.2 1"/> <limit lower="0" upper=")" +
            std::to_string(far_m) + R"(" velocity="1" effort="1"/> </joint> </robot>)",
        "train.urdf");
    robot.groups = {robot.model.MakeGroup("rail", {"slide"}, "tool")};
    const int tool = robot.model.FindLink("tool");
    robot.spheres = {{tool, Eigen::Vector3d(0.01, 0.02, 0.03), 0.05}};
    for (int i = 0; i < Trials(60); ++i) {
      const std::vector<double> q = {far_m * (1 - UniformFraction(&generator) / 2)};
      const Eigen::Vector3d p_W =
          ComputeLinkPoses(robot.model, q)[static_cast<std::size_t>(tool)] * robot.spheres[0].p_LS;
      // 1 um inside of a box's face.
      const Eigen::Isometry3d X_WO(Eigen::Translation3d(p_W) *
                                   Eigen::Translation3d(0.01, 0.1 - 1e-6, 0.02));
      Comparison comparison(robot, SceneWith("wall", Box{{0.1, 0.1, 0.1}}, X_WO),
                            std::vector<double>{0.0});
      EXPECT_FALSE(comparison.exact().IsFree(q)) << far_m;
      EXPECT_FALSE(comparison.fast().IsFree(q)) << far_m;
    }
  }
}

TEST(SimdTruthTest, EdgesAtFixedSamples) {
  for (const World& world : FetchWorlds()) {
    SCOPED_TRACE(world.what);
    Comparison comparison(world.robot, world.scene, world.base_positions);
    EdgeChecker exact_edges(&comparison.exact(), world.robot.edge_resolution_m, EdgeCheck::kFixed);
    EdgeChecker fast_edges(&comparison.fast(), world.robot.edge_resolution_m, EdgeCheck::kFixed);
    const JointSpace& space = comparison.fast().space();
    std::mt19937_64 generator(3);
    int num_valid = 0;
    int num_disputed = 0;
    constexpr int kNum = Trials(12'500);
    for (int i = 0; i < kNum; ++i) {
      const auto from = RandomConfiguration(space, &generator);
      auto to = RandomConfiguration(space, &generator);
      space.Interpolate(from, to, 0.1, to);
      const bool valid = exact_edges.IsValidEdge(from, to);
      num_valid += valid ? 1 : 0;
      if (fast_edges.IsValidEdge(from, to) == valid) continue;
      ++num_disputed;
      EXPECT_TRUE(valid) << "errs towards free";
      double clearance = std::numeric_limits<double>::infinity();
      exact_edges.VisitSamples(from, to, [&](double, std::span<const double> q) {
        clearance = std::min(clearance, comparison.exact().FindClosest(q).distance_m);
        return true;
      });
      EXPECT_LE(clearance, kBand_m);
    }
    EXPECT_GT(num_valid, kNum / 10);
    EXPECT_LT(num_disputed, kNum / 50);
  }
}

TEST(SimdTruthTest, CertifiedEdgesAreFreeAllAlong) {
  for (const World& world : FetchWorlds()) {
    SCOPED_TRACE(world.what);
    Comparison comparison(world.robot, world.scene, world.base_positions);
    const double resolution = world.robot.edge_resolution_m;
    EdgeChecker certified(&comparison.fast(), resolution, EdgeCheck::kCertified);
    EdgeChecker fixed(&comparison.fast(), resolution, EdgeCheck::kFixed);
    EdgeChecker fine(&comparison.exact(), resolution / 16, EdgeCheck::kFixed);
    const JointSpace& space = comparison.fast().space();
    std::mt19937_64 generator(4);
    int num_valid = 0;
    int num_refused_without_need = 0;
    constexpr int kNum = Trials(600);
    for (int i = 0; i < kNum; ++i) {
      const auto from = RandomConfiguration(space, &generator);
      auto to = RandomConfiguration(space, &generator);
      space.Interpolate(from, to, 0.2, to);
      const bool valid = certified.IsValidEdge(from, to);
      if (valid) {
        ++num_valid;
        EXPECT_TRUE(fixed.IsValidEdge(from, to));
        EXPECT_TRUE(fine.IsValidEdge(from, to));
      } else if (fine.IsValidEdge(from, to)) {
        ++num_refused_without_need;
      }
    }
    EXPECT_GT(num_valid, kNum / 6);
    EXPECT_LE(num_refused_without_need, num_valid / 20);
  }
}

/// What is not found among random scenes: shapes of sizes and places that strain single precision,
/// approached to within the band from both sides.
TEST(SimdTruthTest, TinyHugeFarAndRotatedShapesTouchedFromAllSides) {
  const Robot robot = MakeRailRobot();  // a sphere of radius 0.25 m on a rail along z
  const std::vector<double> base = {0.0};
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double kSizes[] = {1e-5, 1e-3, 0.1, 1, 30, 1e3, 1e5};
  int num_judged = 0;
  int num_blocked = 0;
  for (int i = 0; i < 700; ++i) {
    const double size = kSizes[i % 7];
    const double other = size * std::exp2(3 * unit(generator));
    Shape shape = Box{Eigen::Vector3d(size, other, size)};
    if (i / 7 % 4 == 1) shape = Cylinder{size / 2, other};
    if (i / 7 % 4 == 2) shape = Sphere{size / 2};
    if (i / 7 % 4 == 3) shape = Cone{size / 2, other};
    Eigen::Isometry3d X_WO = RandomPose(&generator, 0.5);
    if (i % 3 == 0) X_WO.linear().setIdentity();
    // Its surface near the rail, wherever its middle is.
    const double depth = OracleDistance(shape, Eigen::Vector3d::Zero());
    X_WO.translation() +=
        Eigen::Vector3d(unit(generator), unit(generator), unit(generator)).normalized() *
        (0.25 - std::min(depth, 0.0));
    Comparison comparison(robot, SceneWith("thing", shape, X_WO), base);
    // Bisects for where the verdict changes along the rail, and looks closely there.
    for (int k = 0; k < 20; ++k) {
      double low = 5 * unit(generator);
      double high = 5 * unit(generator);
      const auto distance = [&](double z) {
        return OracleDistance(shape, X_WO.inverse() * Eigen::Vector3d(0, 0, z)) - 0.25;
      };
      if ((distance(low) > 0) != (distance(high) > 0)) {
        for (int step = 0; step < 40; ++step) {
          const double middle = (low + high) / 2;
          ((distance(middle) > 0) == (distance(low) > 0) ? low : high) = middle;
        }
      }
      for (const double offset : {0.0, 3e-4, -3e-4, 1.1e-4, -1.1e-4, 1e-5, -1e-5}) {
        const std::vector<double> q = {low + offset};
        const double d = distance(q[0]);
        if (std::abs(d) <= kBand_m) continue;
        ++num_judged;
        num_blocked += d > 0 ? 0 : 1;
        EXPECT_EQ(comparison.fast().IsFree(q), d > 0)
            << ShapeTypeName(shape) << " of " << size << " m, distance " << d;
      }
    }
  }
  EXPECT_GT(num_judged, 50'000);
  EXPECT_GT(num_blocked, num_judged / 20);
}

}  // namespace
}  // namespace planbench
