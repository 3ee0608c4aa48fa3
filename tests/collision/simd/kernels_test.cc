#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "collision/edge_checker.h"
#include "collision/simd/ball_tree.h"
#include "collision/simd/kernels/scratch.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "collision/simd/simd_checker.h"
#include "robot_model/full_positions.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"

namespace planbench {
namespace {

using kernels::kBlock;

/// Runs `test` with every instruction set that was compiled and that this machine has.
template <typename Test>
void OnEveryInstructionSet(Test test) {
  for (std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS; targets != 0;
       targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(kernels::InstructionSet());
    test();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

TEST(KernelsTest, SinesAndCosines) {
  OnEveryInstructionSet([] {
    double worst = 0;
    for (int i = 0; i < 100'000; ++i) {
      float angles[kBlock], sines[kBlock], cosines[kBlock];
      for (int lane = 0; lane < kBlock; ++lane) {
        angles[lane] = static_cast<float>(2 * std::numbers::pi *
                                          (2.0 * (i * kBlock + lane) / (100'000.0 * kBlock) - 1));
      }
      kernels::BlockSinCos(angles, sines, cosines);
      for (int lane = 0; lane < kBlock; ++lane) {
        worst =
            std::max(worst, std::abs(sines[lane] - std::sin(static_cast<double>(angles[lane]))));
        worst =
            std::max(worst, std::abs(cosines[lane] - std::cos(static_cast<double>(angles[lane]))));
      }
    }
    EXPECT_LT(worst, 2e-7);
  });
}

TEST(KernelsTest, RowsOfAnyLengthArePlaced) {
  OnEveryInstructionSet([] {
    for (int n = 1; n <= 9; ++n) {
      const auto num_joints = static_cast<std::size_t>(n);
      const kernels::Joints joints{std::vector<std::uint8_t>(num_joints, 1),
                                   std::vector<double>(num_joints, -1),
                                   std::vector<double>(num_joints, 1)};
      // A row after another, so that with an odd number every other one is not aligned.
      std::vector<double> rows;
      for (int i = 0; i < kBlock * n; ++i) rows.push_back(i / 256.0 - 0.25);
      rows.back() = 1.5;
      std::vector<float> q(num_joints * kBlock);
      EXPECT_EQ(kernels::PlaceRows(joints, rows.data(), kBlock, q.data()), 1u << (kBlock - 1));
      for (int row = 0; row < kBlock; ++row) {
        for (int j = 0; j < n; ++j) {
          EXPECT_EQ(q[static_cast<std::size_t>(j * kBlock + row)],
                    rows[static_cast<std::size_t>(row * n + j)]);
        }
      }
    }
  });
}

TEST(KernelsTest, InstructionSetsAgree) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  const JointSpace& space = arm.groups.front().space;
  constexpr int kNum = 2'000;
  std::mt19937_64 generator(1);
  std::vector<double> qs;
  for (int i = 0; i < kNum; ++i) {
    const auto q = RandomConfiguration(space, &generator);
    qs.insert(qs.end(), q.begin(), q.end());
  }
  const auto n = static_cast<std::size_t>(space.size());
  const std::vector<double> motion(n, 0.02);
  const MotionSample all_of_it{0.5, 0.5};
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    std::vector<unsigned char> expected;
    std::vector<unsigned char> expected_stretch;
    OnEveryInstructionSet([&] {
      SimdChecker checker(arm, arm.groups.front());
      checker.SetScene(world.scene, base);
      std::vector<unsigned char> free(kNum);
      std::vector<unsigned char> stretch_free(kNum);
      checker.CheckAll(qs, kNum, free);
      for (std::size_t i = 0; i < free.size(); ++i) {
        const auto start = std::span(qs).subspan(i * n, n);
        stretch_free[i] = checker.CheckSamples(start, motion, {&all_of_it, 1}).blocked == 0;
        EXPECT_LE(stretch_free[i], free[i]);
      }
      if (expected.empty()) {
        expected = free;
        expected_stretch = stretch_free;
      }
      int num_differ = 0;
      for (std::size_t i = 0; i < free.size(); ++i) {
        // Rounding differs with fused operations, so verdicts may where something just touches.
        num_differ += free[i] != expected[i] || stretch_free[i] != expected_stretch[i] ? 1 : 0;
      }
      EXPECT_LE(num_differ, 2);
    });
  }
}

TEST(KernelsTest, InstructionSetsAgreeHowFarEdgesAreFree) {
  const Robot arm = MakeTestArm();
  const auto base = FullPositions(arm.model, {"finger_joint"}, {0.1}, "test");
  std::mt19937_64 generator(3);
  std::vector<std::vector<double>> ends;
  for (int i = 0; i < 50; ++i) {
    ends.push_back(RandomConfiguration(arm.groups.front().space, &generator));
  }
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    SCOPED_TRACE(EnumName(method));
    for (const NamedScene& world : MakeTestScenes()) {
      SCOPED_TRACE(world.what);
      std::vector<double> expected;
      OnEveryInstructionSet([&] {
        SimdChecker checker(arm, arm.groups.front());
        checker.SetScene(world.scene, base);
        EdgeChecker edges(&checker, 0.02, method);
        std::vector<double> parts;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
          if (!edges.IsValidState(ends[i])) continue;
          parts.push_back(edges.FindFreePart(ends[i], ends[i + 1]));
        }
        if (expected.empty()) expected = parts;
        ASSERT_EQ(parts.size(), expected.size());
        int num_differ = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
          num_differ += parts[i] != expected[i] ? 1 : 0;
        }
        EXPECT_LE(num_differ, 2) << "of " << parts.size() << ", by rounding";
      });
    }
  }
}

TEST(BallTreeTest, EveryNodeEnclosesWhatIsBelow) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const int num : {1, 2, 3, 4, 5, 17, 113}) {
    std::vector<Ball> balls;
    for (int i = 0; i < num; ++i) {
      balls.push_back({Eigen::Vector3d(unit(generator), unit(generator), unit(generator)),
                       0.05 * (1 + unit(generator))});
    }
    const BallTree tree(balls);
    const auto check = [](const auto& self, const BallTree& node) -> void {
      for (const Ball& leaf : node.Leaves()) {
        EXPECT_LE((leaf.center - node.ball().center).norm() + leaf.radius,
                  node.ball().radius + 1e-9);
      }
      for (const BallTree& child : node.children()) self(self, child);
    };
    check(check, tree);
    // Every given ball is a leaf or inside one.
    for (const Ball& ball : balls) {
      bool covered = false;
      for (const Ball& leaf : tree.Leaves()) {
        covered |= (leaf.center - ball.center).norm() + ball.radius <= leaf.radius + 1e-12;
      }
      EXPECT_TRUE(covered);
    }
  }
}

TEST(SphereScratchTest, HasAListForEveryLevelOfTheDeepestTree) {
  kernels::SphereRobot robot;
  robot.nodes.resize(40);  // one ball in another
  for (std::size_t i = 0; i < robot.nodes.size(); ++i) {
    robot.nodes[i].first_child = static_cast<std::int32_t>(i + 1);
    robot.nodes[i].num_children = i + 1 < robot.nodes.size() ? 1 : 0;
  }
  kernels::SphereWorld world;
  world.solids.resize(3);
  kernels::SphereScratch scratch;
  scratch.Reset(robot, world);
  EXPECT_GE(scratch.buffers().lists.size(), 3u * 40);
}

}  // namespace
}  // namespace planbench
