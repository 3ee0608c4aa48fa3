// Answers against an oracle, in many configurations.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "robot_model/full_positions.h"
#include "tests/contract/collision_checker_contract.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/support/random_robot.h"

namespace planbench {

TEST_P(CollisionCheckerContract, VerdictsAndDistancesAgreeWithTheOracle) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const auto base = ArmBase(arm);
  const int n = checker->space().size();
  constexpr int kNum = 400;
  int num_free = 0;
  int num_judged = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, base);
    const auto qs = Configurations(checker->space(), kNum, 7);
    std::vector<unsigned char> verdicts(kNum);
    checker->CheckAll(qs, kNum, verdicts);
    std::vector<unsigned char> passed(kNum);
    checker->Screen(qs, kNum, passed);
    for (int i = 0; i < kNum; ++i) {
      SCOPED_TRACE(i);
      const auto q = Row(qs, n, i);
      const auto pairs = OraclePairs(arm, checker->group(), world.scene, base, q);
      const double clearance = OracleClearance(pairs);
      const ClosestPair closest = checker->FindClosest(q);
      if (clearance > tolerance()) {
        EXPECT_NEAR(closest.distance_m, clearance, tolerance());
      } else {
        EXPECT_LE(closest.distance_m, tolerance());
      }
      if (std::abs(clearance) <= tolerance()) continue;
      ++num_judged;
      const bool free = checker->IsFree(q);
      num_free += free ? 1 : 0;
      EXPECT_EQ(free, clearance > 0) << clearance;
      EXPECT_EQ(verdicts[static_cast<std::size_t>(i)] != 0, free);
      EXPECT_TRUE(passed[static_cast<std::size_t>(i)] != 0 || !free);

      const auto contact = checker->FindContact(q);
      ASSERT_EQ(contact.has_value(), !free);
      if (!contact) continue;
      EXPECT_GE(contact->depth_m, 0);
      double distance = std::numeric_limits<double>::infinity();
      for (const OraclePair& pair : pairs) {
        if ((pair.body_a == contact->body_a && pair.body_b == contact->body_b) ||
            (pair.body_a == contact->body_b && pair.body_b == contact->body_a)) {
          distance = pair.distance_m;
        }
      }
      EXPECT_LE(distance, tolerance()) << contact->body_a << " against " << contact->body_b;
    }
  }
  // The test is worth something only if both verdicts occur often.
  EXPECT_GT(num_free, num_judged / 10);
  EXPECT_LT(num_free, num_judged * 9 / 10);
}

TEST_P(CollisionCheckerContract, RandomRobotsAgreeWithTheOracle) {
  constexpr int kNum = 30;
  int num_free = 0;
  int num_judged = 0;
  for (int joints = 2; joints <= 14; ++joints) {
    SCOPED_TRACE(joints);
    const Robot robot = MakeRandomRobot(joints, 1, /*with_follower=*/false);
    const auto checker = Make(robot);
    std::mt19937 held(static_cast<unsigned>(joints));
    const auto base = RandomPositions(robot.model, &held);
    const int n = checker->space().size();
    for (const NamedScene& world : MakeTestScenes()) {
      if (!world.scene.attached.empty()) continue;  // to links of another robot
      SCOPED_TRACE(world.what);
      checker->SetScene(world.scene, base);
      const auto qs = Configurations(checker->space(), kNum, 3);
      for (int i = 0; i < kNum; ++i) {
        const auto q = Row(qs, n, i);
        const double clearance =
            OracleClearance(OraclePairs(robot, checker->group(), world.scene, base, q));
        if (std::abs(clearance) <= tolerance()) continue;
        ++num_judged;
        num_free += clearance > 0 ? 1 : 0;
        EXPECT_EQ(checker->IsFree(q), clearance > 0) << clearance;
        if (clearance <= 0) continue;
        const ClosestPair closest = checker->FindClosest(q);
        EXPECT_NEAR(closest.distance_m, clearance, tolerance())
            << closest.body_a << " and " << closest.body_b;
      }
    }
  }
  EXPECT_GT(num_free, num_judged / 10);
  EXPECT_LT(num_free, num_judged * 9 / 10);
}

TEST_P(CollisionCheckerContract, SelfCollisionsOfTheRobotsThatShipAgreeWithTheOracle) {
  for (const std::string name : {"fetch", "panda", "ur5e"}) {
    SCOPED_TRACE(name);
    const Robot robot = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/" + name);
    const auto checker = Make(robot);
    const auto base = robot.model.DefaultPositions();
    // The Fetch's folder has no allowed pairs, and neighbours further than a joint apart overlap
    // always; what overlaps with the arm straight ahead is allowed here.
    Scene scene;
    if (robot.allowed_pairs.empty()) {
      const std::vector<double> zero(robot.groups.front().joints.size(), 0.0);
      for (const OraclePair& pair : OraclePairs(robot, checker->group(), scene, base, zero)) {
        if (pair.distance_m <= 0) scene.allowed_collisions.SetEntry(pair.body_a, pair.body_b, true);
      }
    }
    checker->SetScene(scene, base);
    constexpr int kNum = 200;
    const auto qs = Configurations(checker->space(), kNum, 13);
    int num_free = 0;
    for (int i = 0; i < kNum; ++i) {
      const auto q = Row(qs, checker->space().size(), i);
      const double clearance =
          OracleClearance(OraclePairs(robot, checker->group(), scene, base, q));
      if (std::abs(clearance) <= tolerance()) continue;
      const bool free = checker->IsFree(q);
      num_free += free ? 1 : 0;
      EXPECT_EQ(free, clearance > 0);
      EXPECT_NEAR(std::max(checker->FindClosest(q).distance_m, 0.0), std::max(clearance, 0.0),
                  tolerance());
    }
    EXPECT_GT(num_free, kNum / 10);
    EXPECT_LT(num_free, kNum * 19 / 20);
  }
}

TEST_P(CollisionCheckerContract, NamesTheClosestPair) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const auto base = ArmBase(arm);
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, base);
    const auto qs = Configurations(checker->space(), 100, 8);
    for (int i = 0; i < 100; ++i) {
      const auto q = Row(qs, checker->space().size(), i);
      const auto pairs = OraclePairs(arm, checker->group(), world.scene, base, q);
      if (OracleClearance(pairs) <= tolerance()) continue;
      const ClosestPair closest = checker->FindClosest(q);
      bool found = false;
      for (const OraclePair& pair : pairs) {
        if (pair.distance_m > closest.distance_m + tolerance()) continue;
        found |= pair.body_a == closest.body_a && pair.body_b == closest.body_b;
        found |= pair.body_a == closest.body_b && pair.body_b == closest.body_a;
      }
      EXPECT_TRUE(found) << closest.body_a << " and " << closest.body_b;
    }
  }
}

TEST_P(CollisionCheckerContract, SamplesAreJudgedAsTheirConfigurations) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const JointSpace& space = checker->space();
  std::mt19937_64 generator(21);
  std::uniform_real_distribution<double> unit(0, 1);
  int num_free = 0;
  int num_blocked = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, ArmBase(arm));
    for (int round = 0; round < 60; ++round) {
      const auto start = RandomConfiguration(space, &generator);
      const auto to = RandomConfiguration(space, &generator);
      std::vector<double> motion;
      for (int j = 0; j < space.size(); ++j) {
        const auto i = static_cast<std::size_t>(j);
        motion.push_back(space.Difference(j, start[i], to[i]) / (1 + round % 4));
      }
      std::vector<MotionSample> samples;
      for (int k = 0; k < 40; ++k) samples.push_back({unit(generator)});
      const SampleVerdicts verdicts = checker->CheckSamples(start, motion, samples);
      EXPECT_EQ(verdicts.blocked, verdicts.certain);
      (verdicts.blocked == 0 ? num_free : num_blocked) += 1;
      for (std::size_t k = 0; k < samples.size(); ++k) {
        // After a collision the others may not have been looked at.
        const bool blocked = (verdicts.blocked >> k & 1) != 0;
        if (verdicts.blocked != 0 && !blocked) continue;
        std::vector<double> q(start);
        for (std::size_t j = 0; j < q.size(); ++j) q[j] += samples[k].position * motion[j];
        if (checker->IsFree(q) != blocked) continue;
        EXPECT_LE(std::abs(checker->FindClosest(q).distance_m), tolerance());
      }
    }
  }
  EXPECT_GT(num_free, 50);
  EXPECT_GT(num_blocked, 50);
}

/// Expects the oracle to find configurations of a stretch free, those within limits.
void ExpectFreeAlong(const MotionSample& stretch, const std::vector<double>& start,
                     const std::vector<double>& motion, const CollisionChecker& checker,
                     const Scene& scene, const std::vector<double>& base) {
  for (int k = -10; k <= 10; ++k) {
    const double position = stretch.position + k / 10.0 * stretch.half_length;
    std::vector<double> q(start);
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += position * motion[j];
    if (!checker.space().WithinLimits(q)) continue;
    const auto pairs = OraclePairs(checker.robot(), checker.group(), scene, base, q);
    EXPECT_GT(OracleClearance(pairs), 0);
  }
}

TEST_P(CollisionCheckerContract, StretchesProvenFreeAreFree) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const JointSpace& space = checker->space();
  std::mt19937_64 generator(22);
  std::uniform_real_distribution<double> unit(-1, 1);
  int num_proven = 0;
  int num_free_but_unproven = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, ArmBase(arm));
    for (int i = 0; i < 60; ++i) {
      const auto start = RandomConfiguration(space, &generator);
      std::vector<double> motion;
      for (int j = 0; j < space.size(); ++j) motion.push_back(0.1 * unit(generator));
      const std::vector<MotionSample> stretches = {{0.25, 0.1}, {0.8, 0.2}, {0.5, 0}};
      const SampleVerdicts verdicts = checker->CheckSamples(start, motion, stretches);
      EXPECT_EQ(verdicts.certain & ~verdicts.blocked, 0u);
      if (verdicts.certain == 0 && verdicts.blocked != 0) ++num_free_but_unproven;
      if (verdicts.blocked != 0) continue;
      ++num_proven;
      for (const MotionSample& stretch : stretches) {
        ExpectFreeAlong(stretch, start, motion, *checker, world.scene, ArmBase(arm));
      }
    }
  }
  EXPECT_GT(num_proven, 50);
  EXPECT_GT(num_free_but_unproven, 0);
}

TEST_P(CollisionCheckerContract, CutsProvenFreeAreFree) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const JointSpace& space = checker->space();
  std::mt19937_64 generator(23);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr int kStretches = 16;
  constexpr int kCuts = 4;
  int num_proven = 0;
  int num_blocked = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, ArmBase(arm));
    for (int i = 0; i < 60; ++i) {
      const auto start = RandomConfiguration(space, &generator);
      std::vector<double> motion;
      for (int j = 0; j < space.size(); ++j) motion.push_back(0.3 * unit(generator));
      std::vector<MotionSample> stretches;
      for (int k = 0; k < kStretches; ++k) {
        stretches.push_back({(k + 0.5) / kStretches, 0.5 / kStretches});
      }
      const SampleVerdicts whole = checker->CheckSamples(start, motion, stretches);
      if (whole.certain != 0) continue;
      std::vector<MotionSample> cuts;
      for (std::size_t k = 0; k < stretches.size(); ++k) {
        if ((whole.blocked >> k & 1) == 0) continue;
        const double half_length = stretches[k].half_length / kCuts;
        for (int cut = 0; cut < kCuts; ++cut) {
          cuts.push_back(
              {stretches[k].position + (2 * cut + 1 - kCuts) * half_length, half_length});
        }
      }
      const SampleVerdicts verdicts = checker->CheckSamples(start, motion, cuts, SampleRole::kCuts);
      for (std::size_t k = 0; k < cuts.size(); ++k) {
        if (verdicts.certain != 0 || (verdicts.blocked >> k & 1) != 0) {
          ++num_blocked;
          continue;
        }
        ++num_proven;
        ExpectFreeAlong(cuts[k], start, motion, *checker, world.scene, ArmBase(arm));
      }
    }
  }
  EXPECT_GT(num_proven, 50);
  EXPECT_GT(num_blocked, 10);
}

TEST_P(CollisionCheckerContract, DistancesOfManyAreThoseOfEach) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const int n = checker->space().size();
  constexpr int kNum = 100;
  for (const NamedScene& world : MakeTestScenes()) {
    // What engines only know a box around counts as that box: distances are lower bounds there.
    const bool exact = world.scene.attached.empty() &&
                       world.what.find("mesh") == std::string::npos &&
                       world.what.find("huge") == std::string::npos;
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, ArmBase(arm));
    const auto qs = Configurations(checker->space(), kNum, 23);
    std::vector<double> distances(kNum);
    for (const double at_most : {0.05, 0.3}) {
      checker->FindDistances(qs, kNum, at_most, distances);
      for (int i = 0; i < kNum; ++i) {
        const double distance = distances[static_cast<std::size_t>(i)];
        EXPECT_LE(distance, at_most);
        double to_objects = std::numeric_limits<double>::infinity();
        const auto pairs =
            OraclePairs(arm, checker->group(), world.scene, ArmBase(arm), Row(qs, n, i));
        for (const OraclePair& pair : pairs) {
          for (const SceneObject& object : world.scene.objects) {
            if (pair.body_a != object.id && pair.body_b != object.id) continue;
            to_objects = std::min(to_objects, pair.distance_m);
          }
        }
        EXPECT_LE(distance, std::max(to_objects, 0.0) + tolerance());
        const double closest = OracleClearance(pairs);
        if (exact && closest > tolerance()) {
          EXPECT_GE(distance, std::min(closest, at_most) - tolerance());
        }
      }
    }
  }
}

TEST_P(CollisionCheckerContract, MotionsShorterThanTheClearanceEndFree) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const JointSpace& space = checker->space();
  std::mt19937_64 generator(5);
  int num_clear = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    checker->SetScene(world.scene, ArmBase(arm));
    for (int i = 0; i < 50; ++i) {
      const auto q = RandomConfiguration(space, &generator);
      double clearance = 0;
      double distance = 0;
      checker->FindClearances(q, 1, 0.3, {&clearance, 1});
      checker->FindDistances(q, 1, 0.3, {&distance, 1});
      EXPECT_LE(clearance, 0.3);
      EXPECT_GE(clearance, std::min(distance, 0.0));
      if (clearance <= 0) continue;
      ++num_clear;
      for (int k = 0; k < 5; ++k) {
        auto near = RandomConfiguration(space, &generator);
        const double motion = checker->motion_bound().Between(space, q, near);
        space.Interpolate(q, near, std::min(1.0, 0.99 * clearance / motion), near);
        EXPECT_TRUE(checker->IsFree(near));
      }
    }
  }
  EXPECT_GT(num_clear, 100);
}

TEST_P(CollisionCheckerContract, MotionBoundCoversEverySphereAndAttachedShape) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const auto base = ArmBase(arm);
  Scene scene;
  const Eigen::Isometry3d X_LO = Shifted(0.5, 0.1, 0);
  scene.attached = {
      {"hand", {"rod", X_LO, {{Cylinder{0.1, 1}, Eigen::Isometry3d::Identity()}}}, {}}};
  checker->SetScene(scene, base);
  std::mt19937_64 generator(12);
  const auto hand = static_cast<std::size_t>(arm.model.FindLink("hand"));
  for (int i = 0; i < 500; ++i) {
    const auto from = RandomConfiguration(checker->space(), &generator);
    auto to = RandomConfiguration(checker->space(), &generator);
    checker->space().Interpolate(from, to, 0.01, to);
    const double bound = checker->motion_bound().Between(checker->space(), from, to);
    const auto before = ComputeLinkPoses(arm.model, WithGroupAt(arm, checker->group(), base, from));
    const auto after = ComputeLinkPoses(arm.model, WithGroupAt(arm, checker->group(), base, to));
    for (const LinkSphere& sphere : arm.spheres) {
      const auto link = static_cast<std::size_t>(sphere.link);
      EXPECT_LE((after[link] * sphere.p_LS - before[link] * sphere.p_LS).norm(), bound + 1e-12);
    }
    for (double z : {-0.5, 0.5}) {
      const Eigen::Vector3d end = X_LO * Eigen::Vector3d(0.1, 0, z);
      EXPECT_LE((after[hand] * end - before[hand] * end).norm(), bound + 1e-12);
    }
  }
}

}  // namespace planbench
