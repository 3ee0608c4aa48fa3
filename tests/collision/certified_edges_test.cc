// Certified edges of every engine and model: what is accepted is free by an oracle that samples
// finely, what is free is accepted, and at what count of configurations.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "collision/edge_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/simd/simd_checker.h"
#include "collision/voxels/distance_field.h"
#include "robot_model/full_positions.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// The verdict of the FCL engine; with voxels on all but links against the world, which is that of
/// the field's value at the centres of spheres, looked up in double precision.
class Oracle {
 public:
  Oracle(const Robot& robot, CollisionModel model)
      : robot_(robot), group_(robot.groups.front()), fcl_(robot, group_, model) {
    if (model == CollisionModel::kVoxels) field_.emplace(*robot.voxels);
  }

  void SetScene(const Scene& scene, const std::vector<double>& base) {
    fcl_.SetScene(scene, base);
    base_ = base;
    if (field_) field_->Rebuild(scene);
  }

  bool IsFree(std::span<const double> q) { return fcl_.IsFree(q) && (!field_ || FieldIsFree(q)); }

 private:
  bool FieldIsFree(std::span<const double> q) const {
    const DistanceField& field = field_->field();
    const auto poses = ComputeLinkPoses(robot_.model, WithGroupAt(robot_, group_, base_, q));
    for (const LinkSphere& sphere : robot_.spheres) {
      if (!Moves(sphere.link)) continue;
      const Eigen::Vector3d p = poses[static_cast<std::size_t>(sphere.link)] * sphere.p_LS;
      std::size_t index = 0;
      bool inside = true;
      for (std::size_t axis = 3; axis-- > 0;) {
        const double cell = std::floor((p[static_cast<Eigen::Index>(axis)] -
                                        robot_.voxels->lower[static_cast<Eigen::Index>(axis)]) /
                                       robot_.voxels->resolution_m);
        inside = inside && cell >= 0 && cell < field.size[axis];
        index = index * static_cast<std::size_t>(field.size[axis]) +
                static_cast<std::size_t>(inside ? cell : 0);
      }
      if ((inside ? field.values[index] : field.outside) < sphere.radius) return false;
    }
    return true;
  }

  bool Moves(int link) const {
    for (; robot_.model.links()[static_cast<std::size_t>(link)].parent_joint >= 0;) {
      const int joint = robot_.model.links()[static_cast<std::size_t>(link)].parent_joint;
      if (std::find(group_.joints.begin(), group_.joints.end(), joint) != group_.joints.end()) {
        return true;
      }
      link = robot_.model.joints()[static_cast<std::size_t>(joint)].parent_link;
    }
    return false;
  }

  const Robot& robot_;
  const PlanningGroup& group_;
  FclChecker fcl_;
  std::optional<DistanceFieldBuilder> field_;
  std::vector<double> base_;
};

enum class Engine { kFcl, kSimd };
using Combination = std::pair<Engine, CollisionModel>;

class CertifiedEdges : public testing::TestWithParam<Combination> {
 protected:
  CertifiedEdges()
      : robot_(model() == CollisionModel::kMeshes ? MakeSolidTestArm(folder_.path())
                                                  : MakeTestArm()) {
    // A grid that the arm leaves.
    robot_.voxels = VoxelSettings{0.02, Eigen::Vector3d(-0.9, -0.8, -0.3),
                                  Eigen::Vector3d(0.9, 0.8, 1.3), false};
    if (model() == CollisionModel::kEnclosing) robot_.spheres.swap(robot_.enclosing_spheres);
    base_ = FullPositions(robot_.model, {"finger_joint"}, {0.1}, "test");
    checker_ = Make(robot_);
  }

  static CollisionModel model() { return GetParam().second; }
  static std::unique_ptr<CollisionChecker> Make(const Robot& robot) {
    if (GetParam().first == Engine::kFcl) {
      return std::make_unique<FclChecker>(robot, robot.groups.front(), model());
    }
    return std::make_unique<SimdChecker>(robot, robot.groups.front(), model());
  }

  const JointSpace& space() const { return robot_.groups.front().space; }

  /// A random edge of which nothing moves further than half_length rad or m about its middle.
  std::array<std::vector<double>, 2> RandomEdge(double half_length) {
    std::uniform_real_distribution<double> unit(-half_length, half_length);
    std::array<std::vector<double>, 2> ends;
    do {
      ends[0] = ends[1] = RandomConfiguration(space(), &generator_);
      for (std::size_t j = 0; j < ends[0].size(); ++j) {
        const double half = unit(generator_);
        ends[0][j] -= half;
        ends[1][j] += half;
      }
    } while (!space().WithinLimits(ends[0]) || !space().WithinLimits(ends[1]));
    return ends;
  }

  TemporaryFolder folder_;
  Robot robot_;
  std::vector<double> base_;
  std::unique_ptr<CollisionChecker> checker_;
  std::mt19937_64 generator_{31};
};

TEST_P(CertifiedEdges, AreAcceptedIfAndAlmostOnlyIfFree) {
  Oracle oracle(robot_, model());
  int num_free = 0;
  int num_refused_though_free = 0;
  int num_blocked = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker_->SetScene(world.scene, base_);
    oracle.SetScene(world.scene, base_);
    EdgeChecker edges(checker_.get(), 0.02, EdgeCheck::kCertified);
    for (int i = 0; i < 40; ++i) {
      const auto [from, to] = RandomEdge(i % 2 == 0 ? 0.15 : 0.02);
      const bool accepted = edges.IsValidEdge(from, to);
      bool free = true;
      constexpr int kSamples = 60;
      std::vector<double> q(from.size());
      for (int k = 0; k <= kSamples && free; ++k) {
        space().Interpolate(from, to, static_cast<double>(k) / kSamples, q);
        free = oracle.IsFree(q);
      }
      EXPECT_TRUE(free || !accepted);
      num_free += free ? 1 : 0;
      num_blocked += free ? 0 : 1;
      num_refused_though_free += free && !accepted ? 1 : 0;
    }
  }
  EXPECT_GT(num_free, 100);
  EXPECT_GT(num_blocked, 60);
  EXPECT_LE(num_refused_though_free, num_free / 25);
}

TEST_P(CertifiedEdges, VerdictsOnConfigurationsAreTheOracles) {
  Oracle oracle(robot_, model());
  int num_differ = 0;
  int num_free = 0;
  int num_screened = 0;
  int num = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    checker_->SetScene(world.scene, base_);
    oracle.SetScene(world.scene, base_);
    for (int i = 0; i < 60; ++i, ++num) {
      const auto q = RandomConfiguration(space(), &generator_);
      const bool free = checker_->IsFree(q);
      unsigned char passes = 0;
      checker_->Screen(q, 1, {&passes, 1});
      EXPECT_TRUE(passes != 0 || !free) << world.what;
      num_screened += passes == 0 ? 1 : 0;
      num_free += free ? 1 : 0;
      num_differ += free == oracle.IsFree(q) ? 0 : 1;
      EXPECT_EQ(checker_->FindContact(q).has_value(), !free) << world.what;
    }
  }
  EXPECT_LE(num_differ, 1);  // single precision may tell one that all but touches otherwise
  EXPECT_GT(num_free, num / 10);
  EXPECT_LT(num_free, num * 9 / 10);
  EXPECT_GE(num_screened, (num - num_free) * 8 / 10);
}

TEST_P(CertifiedEdges, CostIsBounded) {
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker_->SetScene(world.scene, base_);
    EdgeChecker edges(checker_.get(), 0.02, EdgeCheck::kCertified);
    for (int i = 0; i < 20; ++i) {
      const auto [from, to] = RandomEdge(0.1);
      const double motion_m = checker_->motion_bound().Between(space(), from, to);
      const std::int64_t before = edges.counters().configurations;
      edges.IsValidEdge(from, to);
      // Every level has four times as many stretches as the one before, down to one more than those
      // that are as short as the last may be.
      const double most = 16 + 4.0 / 3 * 4 * (16 + motion_m / EdgeChecker::kCertifiedDepth);
      EXPECT_LE(static_cast<double>(edges.counters().configurations - before), most);
    }
  }
}

Mesh MeshOf(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.triangles = BoxMesh(size);
  return mesh;
}

/// Configurations that edges cost, and how many of them are accepted.
std::pair<std::int64_t, int> CostOf(CollisionChecker* checker,
                                    const std::vector<std::array<std::vector<double>, 2>>& paths) {
  EdgeChecker edges(checker, 0.02, EdgeCheck::kCertified);
  int num_valid = 0;
  for (const auto& [from, to] : paths) num_valid += edges.IsValidEdge(from, to) ? 1 : 0;
  return {edges.counters().configurations, num_valid};
}

TEST_P(CertifiedEdges, WhatStandsNextToTheRobotCostsNothing) {
  std::vector<std::array<std::vector<double>, 2>> paths;
  for (int i = 0; i < 60; ++i) paths.push_back(RandomEdge(0.1));
  checker_->SetScene({}, base_);
  const auto open = CostOf(checker_.get(), paths);
  EXPECT_GT(open.second, 20);
  // 0.2 mm beside what does not move (of both arms it ends at y = 0.33 m and 0.3 m).
  const double end = model() == CollisionModel::kMeshes ? 0.3 : 0.33;
  const Eigen::Vector3d size(0.02, 0.02, 0.02);
  const Eigen::Isometry3d beside(Eigen::Translation3d(-0.2, end + size.y() / 2 + 2e-4, 0.1));
  for (const Shape& shape : {Shape(Box{size}), Shape(MeshOf(size))}) {
    checker_->SetScene(SceneWith("neighbour", shape, beside), base_);
    const auto [cost, num_valid] = CostOf(checker_.get(), paths);
    EXPECT_GE(num_valid, open.second - 3);
    EXPECT_LE(cost, open.first * 3 / 2);
  }
}

TEST_P(CertifiedEdges, AMeshCostsWhatABoxDoes) {
  if (model() == CollisionModel::kVoxels) GTEST_SKIP() << "a field does not tell them apart";
  std::vector<std::array<std::vector<double>, 2>> paths;
  for (int i = 0; i < 60; ++i) paths.push_back(RandomEdge(0.1));
  const auto cost_with = [&](const Shape& shape) {
    Scene scene =
        SceneWith("obstacle", shape, Eigen::Isometry3d(Eigen::Translation3d(0.8, 0, 0.7)));
    for (int i = 0; i < 30; ++i) {
      const int row = i / 6;
      AddObject(&scene, "box" + std::to_string(i), Box{{0.1, 0.1, 0.1}},
                Eigen::Isometry3d(Eigen::Translation3d(0.9, 0.2 * (i % 6) - 0.5, 0.3 * row)));
    }
    checker_->SetScene(scene, base_);
    return CostOf(checker_.get(), paths);
  };
  const Eigen::Vector3d size(0.4, 0.6, 0.3);
  const auto box = cost_with(Box{size});
  const auto mesh = cost_with(MeshOf(size));
  EXPECT_GT(box.second, 10);
  EXPECT_NEAR(mesh.second, box.second, 1);
  EXPECT_LE(mesh.first, box.first * 5 / 4);
}

INSTANTIATE_TEST_SUITE_P(Models, CertifiedEdges,
                         testing::Values(Combination{Engine::kFcl, CollisionModel::kSpheres},
                                         Combination{Engine::kFcl, CollisionModel::kMeshes},
                                         Combination{Engine::kSimd, CollisionModel::kSpheres},
                                         Combination{Engine::kSimd, CollisionModel::kMeshes},
                                         Combination{Engine::kSimd, CollisionModel::kVoxels},
                                         Combination{Engine::kSimd, CollisionModel::kEnclosing}),
                         [](const auto& instance) {
                           return std::string(instance.param.first == Engine::kFcl ? "fcl"
                                                                                   : "simd") +
                                  "_" + std::string(EnumName(instance.param.second));
                         });

/// Two links that turn about vertical axes, any number of times: "a" through W's origin, "b" 1 m
/// from it. Spheres of radius 1 mm, 1 m from b's axis, meet where b is a quarter turn.
Robot MakeTurningRobot() {
  Robot robot;
  robot.name = "turning_robot";
  robot.model = RobotModel::FromUrdf(R"(<robot name="turning_robot">
    <link name="base"/> <link name="upper"/> <link name="fore"/>
    <joint name="a" type="revolute">
      <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
      <limit lower="-9999" upper="9999" velocity="1" effort="1"/>
    </joint>
    <joint name="b" type="revolute">
      <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/>
      <limit lower="-9999" upper="9999" velocity="1" effort="1"/>
    </joint>
  </robot>)",
                                     "turning_robot.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"a", "b"}, "fore")};
  const int upper = robot.model.FindLink("upper");
  const int fore = robot.model.FindLink("fore");
  robot.checked_pairs = {{upper, fore}};
  robot.spheres = {{upper, Eigen::Vector3d(1, 1, 0), 0.001},
                   {fore, Eigen::Vector3d(1, 0, 0), 0.001}};
  return robot;
}

TEST(ManyTurnsTest, ThinPinsAreMetWhereTheyStand) {
  const Robot robot = MakeTurningRobot();
  SimdChecker checker(robot, robot.groups.front());
  const std::vector<double> start = {-9998.7, 9999};
  const std::vector<double> motion = {19997.3, -19997.9};
  for (int i = 0; i < 50; ++i) {
    const MotionSample sample{0.0137 + 0.0193 * i, 1e-10};
    const double a = start[0] + sample.position * motion[0];
    const double ab = a + start[1] + sample.position * motion[1];
    const Eigen::Vector3d tip(std::cos(a) + std::cos(ab), std::sin(a) + std::sin(ab), 0);
    const Eigen::Vector3d beside(std::cos(i), std::sin(i), 0);
    for (const double distance : {-2e-4, 2e-4}) {
      const Eigen::Isometry3d X_WO(Eigen::Translation3d(tip + (0.002 + distance) * beside));
      checker.SetScene(SceneWith("pin", Cylinder{0.001, 0.1}, X_WO), std::vector<double>{0, 0});
      const SampleVerdicts verdicts = checker.CheckSamples(start, motion, {&sample, 1});
      EXPECT_EQ(verdicts.blocked, distance < 0 ? 1U : 0U) << sample.position;
      EXPECT_EQ(verdicts.certain, verdicts.blocked) << sample.position;
    }
  }
}

TEST(ManyTurnsTest, HideNothingOfWhatOtherJointsMove) {
  const Robot robot = MakeTurningRobot();
  SimdChecker checker(robot, robot.groups.front());
  checker.SetScene({}, std::vector<double>{0, 0});
  // The spheres are 0.3 mm apart in the middle, and as b goes on meet or do not.
  const double middle = std::numbers::pi / 2 - 0.0023;
  const MotionSample all_of_it{0.5, 0.5};
  for (const double half_width : {0.0001, 0.0004}) {
    const std::vector<double> start = {-9999, middle - half_width};
    const std::vector<double> motion = {19998, 2 * half_width};
    EXPECT_EQ(checker.CheckSamples(start, motion, {&all_of_it, 1}).blocked,
              half_width > 0.0003 ? 1U : 0U);
  }
}

TEST(VoxelsModelAttachedTest, HeldObjectsAreJudgedExactly) {
  // A ball that reaches `depth` into a plate, or stays short of it.
  Robot robot = MakeRailRobot();
  robot.voxels =
      VoxelSettings{0.02, Eigen::Vector3d(-0.4, -0.4, -1.9), Eigen::Vector3d(0.4, 0.4, 1.9), false};
  SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
  for (const double height : {0.5, 0.505, 0.51, 0.517, 1.9, 5.0}) {
    Scene scene = SceneWith("plate", Box{{1.6, 1.6, 0.01}},
                            Eigen::Isometry3d(Eigen::Translation3d(0, 0, height + 0.005)));
    scene.attached = {{"tool",
                       {"ball",
                        Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.3)),
                        {{Sphere{0.03}, Eigen::Isometry3d::Identity()}}},
                       {}}};
    checker.SetScene(scene, std::vector<double>{0.0});
    for (const double depth : {0.0095, 0.004, 0.0005, -0.0005, -0.004}) {
      const std::vector<double> q = {height - 0.33 + depth};
      EXPECT_EQ(checker.IsFree(q), depth < 0) << height << " " << depth;
      const auto contact = checker.FindContact(q);
      ASSERT_EQ(contact.has_value(), depth > 0);
      if (contact) {
        EXPECT_EQ(contact->body_a, "ball");
        EXPECT_NEAR(contact->depth_m, depth, 1e-9);
      }
    }
  }
}

TEST(VoxelsModelAttachedTest, LinksAreTheFieldsWhateverIsHeld) {
  Robot robot = MakeRailRobot();
  robot.voxels =
      VoxelSettings{0.02, Eigen::Vector3d(-0.4, -0.4, -1.9), Eigen::Vector3d(0.4, 0.4, 1.9), false};
  SimdChecker checker(robot, robot.groups.front(), CollisionModel::kVoxels);
  Scene scene = SceneWith("box", Box{{0.4, 0.4, 0.4}});
  std::vector<bool> without;
  std::vector<bool> with;
  for (std::vector<bool>* verdicts : {&without, &with}) {
    checker.SetScene(scene, std::vector<double>{0.0});
    for (double z = 0.4; z < 0.5; z += 0.00137) {
      verdicts->push_back(checker.IsFree(std::vector<double>{z}));
    }
    // In doubt everywhere, in contact nowhere.
    scene.attached = {{"tool",
                       {"ring",
                        Eigen::Isometry3d::Identity(),
                        {{Sphere{0.01}, Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))},
                         {Sphere{0.01}, Eigen::Isometry3d(Eigen::Translation3d(-1, 0, 0))}}},
                       {}}};
  }
  EXPECT_EQ(with, without);
}

TEST(ContactTest, IsDescribedWithItsDepthIfThatIsKnown) {
  EXPECT_EQ(Describe({"arm", "table", 0.012}), "'arm' and 'table', 0.0120 m deep");
  EXPECT_EQ(Describe({"arm", "table", 0}), "'arm' and 'table' in contact");
}

TEST(ContactTest, DepthsOfSolidsArePositive) {
  const TemporaryFolder folder;
  const Robot robot = MakeSolidTestArm(folder.path());
  FclChecker checker(robot, robot.groups.front(), CollisionModel::kMeshes);
  const auto base = FullPositions(robot.model, {"finger_joint"}, {0.1}, "test");
  std::mt19937_64 generator(3);
  int num_contacts = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    checker.SetScene(world.scene, base);
    for (int i = 0; i < 12; ++i) {
      const auto contact =
          checker.FindContact(RandomConfiguration(robot.groups.front().space, &generator));
      if (!contact) continue;
      ++num_contacts;
      EXPECT_GT(contact->depth_m, 0);
    }
  }
  EXPECT_GT(num_contacts, 10);
}

}  // namespace
}  // namespace planbench
