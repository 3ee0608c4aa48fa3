#pragma once

// What every collision engine must do, as a GoogleTest suite. To put an engine under it, in one
// test source:
//
//   #include "tests/contract/collision_checker_contract.h"
//   INSTANTIATE_TEST_SUITE_P(MyEngine, CollisionCheckerContract, testing::Values(CollisionEngine{
//       "my_engine", [](const Robot& robot, const PlanningGroup& group) { return ...; }}));
//
// and compile it with collision_oracle.cc and collision_test_worlds.cc. The suite is for engines
// that check the robot's spheres; the oracle checks all of them against everything, in double
// precision.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "collision/collision_checker.h"
#include "robot_model/full_positions.h"
#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"

namespace planbench {

struct CollisionEngine {
  std::string name;
  std::function<std::unique_ptr<CollisionChecker>(const Robot&, const PlanningGroup&)> make;
  /// Largest error of the engine's distances, m. Configurations nearer to contact than this are not
  /// judged.
  double tolerance_m = 1e-9;

  friend std::ostream& operator<<(std::ostream& stream, const CollisionEngine& engine) {
    return stream << engine.name;
  }
};

class CollisionCheckerContract : public testing::TestWithParam<CollisionEngine> {
 protected:
  std::unique_ptr<CollisionChecker> Make(const Robot& robot) const {
    return GetParam().make(robot, robot.groups.front());
  }
  double tolerance() const { return GetParam().tolerance_m; }
  /// Positions of the test arm's held joint: the finger opened.
  static std::vector<double> ArmBase(const Robot& arm, double finger = 0.1) {
    return FullPositions(arm.model, {"finger_joint"}, {finger}, "test");
  }
  static std::vector<double> Configurations(const JointSpace& space, int num, unsigned seed) {
    std::mt19937_64 generator(seed);
    std::vector<double> qs;
    for (int i = 0; i < num; ++i) {
      const auto q = RandomConfiguration(space, &generator);
      qs.insert(qs.end(), q.begin(), q.end());
    }
    return qs;
  }
  static std::span<const double> Row(const std::vector<double>& qs, int n, int i) {
    return std::span(qs).subspan(static_cast<std::size_t>(i * n), static_cast<std::size_t>(n));
  }
  /// A configuration of the rail robot.
  static std::vector<double> Slide(double z) { return {z}; }
};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CollisionCheckerContract);

inline Eigen::Isometry3d Shifted(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST_P(CollisionCheckerContract, RefusesBadUse) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  const std::vector<double> q = {0.0};
  ExpectInputError([&] { checker->IsFree(q); }, {"no scene"});
  const std::vector<double> too_many = {0.0, 0.0};
  ExpectInputError([&] { checker->SetScene({}, too_many); }, {"2", "rail_robot", "1"});
  const std::vector<double> nan = {std::nan("")};
  ExpectInputError([&] { checker->SetScene({}, nan); }, {"not finite"});
  checker->SetScene({}, q);
  EXPECT_TRUE(checker->IsFree(q));
  ExpectInputError([&] { checker->IsFree(nan); }, {"not finite"});
  ExpectInputError([&] { checker->IsFree(too_many); }, {"2", "rail"});
  ExpectInputError([&] { checker->FindContact(nan); }, {"not finite"});
  ExpectInputError([&] { checker->FindClosest(too_many); }, {"2"});
  std::vector<unsigned char> verdicts(2);
  ExpectInputError([&] { checker->CheckAll(q, 2, verdicts); }, {"1", "2"});
  ExpectInputError([&] { checker->CheckAll(q, 1, verdicts); }, {"2"});
  const std::vector<double> infinite = {std::numeric_limits<double>::infinity()};
  ExpectInputError([&] { checker->CheckSamples(q, infinite, {}); }, {"not finite"});
  ExpectInputError([&] { checker->CheckSamples(q, too_many, {}); }, {"2 values"});
  const std::vector<MotionSample> many(65, MotionSample{0.5});
  ExpectInputError([&] { checker->CheckSamples(q, q, many); }, {"65", "64"});
  double distance = 0;
  ExpectInputError([&] { checker->FindDistances(q, 1, 0, {&distance, 1}); }, {"at most 0"});
}

TEST_P(CollisionCheckerContract, RefusesScenesItCannotRepresent) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  const std::vector<double> q = {0.0};
  Scene attached;
  attached.attached = {{"no_such_link", {"mug", Eigen::Isometry3d::Identity(), {}}, {}}};
  ExpectInputError([&] { checker->SetScene(attached, q); }, {"mug", "no_such_link"});
  Scene held_floor;
  held_floor.attached = {{"tool", SceneWith("floor", HalfSpace{}).objects[0], {}}};
  ExpectInputError([&] { checker->SetScene(held_floor, q); }, {"floor", "tool", "half-space"});
  ExpectInputError([&] { checker->SetScene(SceneWith("vase", Mesh{}), q); },
                   {"vase", "no triangles"});
  ExpectInputError([&] { checker->SetScene(SceneWith("pipe", Cylinder{-1, 1}), q); }, {"pipe"});
  // The scene before is gone, too: nothing would be worse than answers about a world that is no
  // more.
  checker->SetScene({}, q);
  ExpectInputError([&] { checker->SetScene(attached, q); }, {"mug"});
  ExpectInputError([&] { checker->IsFree(q); }, {"no scene"});
}

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

TEST_P(CollisionCheckerContract, SelfCollisionsOfTheFetchAgreeWithTheOracle) {
  const Robot fetch = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch");
  const auto checker = Make(fetch);
  const auto base = fetch.model.DefaultPositions();
  // Neighbours further than a joint apart overlap always; what overlaps with the arm straight ahead
  // is allowed here.
  Scene scene;
  const std::vector<double> zero(fetch.groups.front().joints.size(), 0.0);
  for (const OraclePair& pair : OraclePairs(fetch, checker->group(), scene, base, zero)) {
    if (pair.distance_m <= 0) scene.allowed_collisions.SetEntry(pair.body_a, pair.body_b, true);
  }
  checker->SetScene(scene, base);
  constexpr int kNum = 200;
  const auto qs = Configurations(checker->space(), kNum, 13);
  int num_free = 0;
  for (int i = 0; i < kNum; ++i) {
    const auto q = Row(qs, checker->space().size(), i);
    const double clearance = OracleClearance(OraclePairs(fetch, checker->group(), scene, base, q));
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
        for (int k = -10; k <= 10; ++k) {
          const double position = stretch.position + k / 10.0 * stretch.half_length;
          std::vector<double> q(start);
          for (std::size_t j = 0; j < q.size(); ++j) q[j] += position * motion[j];
          if (!space.WithinLimits(q)) continue;
          EXPECT_GT(
              OracleClearance(OraclePairs(arm, checker->group(), world.scene, ArmBase(arm), q)), 0);
        }
      }
    }
  }
  EXPECT_GT(num_proven, 50);
  EXPECT_GT(num_free_but_unproven, 0);
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

TEST_P(CollisionCheckerContract, TouchingIsCollision) {
  if (tolerance() > 1e-6) GTEST_SKIP() << "the engine's distances are not exact enough";
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  Mesh cube;
  cube.triangles = BoxMesh(Eigen::Vector3d(1, 1, 1));
  const std::vector<Shape> shapes = {Box{Eigen::Vector3d(1, 1, 1)},
                                     Cylinder{2, 1},
                                     Sphere{0.5},
                                     Cone{0.5, 1},
                                     Capsule{0.25, 0.5},
                                     cube};
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(ShapeTypeName(shape));
    checker->SetScene(SceneWith("thing", shape), Slide(0));
    for (double touching : {0.75, -0.75}) {
      const double apart = touching + std::copysign(4 * tolerance(), touching);
      const double inside = touching - std::copysign(4 * tolerance(), touching);
      EXPECT_FALSE(checker->IsFree(Slide(touching))) << touching;
      EXPECT_FALSE(checker->IsFree(Slide(inside))) << touching;
      EXPECT_TRUE(checker->IsFree(Slide(apart))) << touching;
      EXPECT_NEAR(checker->FindClosest(Slide(touching)).distance_m, 0, tolerance());
      EXPECT_NEAR(checker->FindClosest(Slide(touching * 2)).distance_m, 0.75, tolerance());
    }
  }
}

TEST_P(CollisionCheckerContract, DepthIsThatOfTheDeepestPair) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  SceneObject pair{"pair", Eigen::Isometry3d::Identity(), {}};
  pair.shapes.push_back({Box{Eigen::Vector3d(1, 1, 1)}, Shifted(0, 0, -0.5)});
  pair.shapes.push_back({Sphere{0.5}, Shifted(0, 0, -0.375)});
  Scene scene;
  scene.objects = {pair};
  checker->SetScene(scene, Slide(0));
  const auto contact = checker->FindContact(Slide(0.25));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->body_a, "tool");
  EXPECT_EQ(contact->body_b, "pair");
  EXPECT_NEAR(contact->depth_m, 0.125, tolerance());
  EXPECT_NEAR(checker->FindClosest(Slide(0.25)).distance_m, -0.125, tolerance());
}

TEST_P(CollisionCheckerContract, WhatIsInsideAClosedMeshCollides) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  Mesh room;
  room.triangles = BoxMesh(Eigen::Vector3d(4, 4, 4));
  checker->SetScene(SceneWith("room", room), Slide(0));
  EXPECT_FALSE(checker->IsFree(Slide(0)));
  EXPECT_NEAR(checker->FindClosest(Slide(1)).distance_m, -1.25, tolerance());
  EXPECT_TRUE(checker->IsFree(Slide(5)));
}

TEST_P(CollisionCheckerContract, AdjacencyAndAllowedPairsOfTheRobot) {
  Robot arm = MakeTestArm();
  const auto base = ArmBase(arm);
  const std::vector<double> q = {0, 0, 0, 0};
  {
    const auto checker = Make(arm);
    checker->SetScene({}, base);
    EXPECT_TRUE(checker->IsFree(q)) << "adjacent links may overlap";
  }
  // Two links that are welded together over a third, made to overlap: always in collision ...
  const int camera = arm.model.FindLink("camera");
  const int torso = arm.model.FindLink("torso");
  for (LinkSphere& sphere : arm.spheres) {
    if (sphere.link == camera) sphere.radius = 0.8;
  }
  {
    const auto checker = Make(arm);
    Scene scene;
    for (const Link& link : arm.model.links()) {
      if (link.name != "torso" && link.name != "camera") {
        scene.allowed_collisions.SetEntry("camera", link.name, true);
      }
    }
    checker->SetScene(scene, base);
    EXPECT_FALSE(checker->IsFree(q));
    const auto contact = checker->FindContact(q);
    ASSERT_TRUE(contact);
    EXPECT_EQ(std::set<std::string>({contact->body_a, contact->body_b}),
              std::set<std::string>({"torso", "camera"}));
    EXPECT_LT(checker->FindClosest(q).distance_m, 0);
    scene.allowed_collisions.SetEntry("camera", "torso", true);
    checker->SetScene(scene, base);
    EXPECT_TRUE(checker->IsFree(q));
  }
  // ... unless the robot's description allows it.
  for (int link = 0; link < arm.model.num_links(); ++link) {
    if (link != camera && link != torso) arm.allowed_pairs.emplace_back(link, camera);
  }
  EXPECT_FALSE([&] {
    const auto checker = Make(arm);
    checker->SetScene({}, base);
    return checker->IsFree(q);
  }());
  arm.allowed_pairs.emplace_back(camera, torso);
  const auto checker = Make(arm);
  checker->SetScene({}, base);
  EXPECT_TRUE(checker->IsFree(q));
}

TEST_P(CollisionCheckerContract, AttachedObjectsMoveWithTheirLink) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  Scene scene = SceneWith("shelf", Box{Eigen::Vector3d(1, 1, 1)}, Shifted(5, 0, 0));
  scene.attached = {
      {"tool", {"pole", Shifted(3.25, 0, 0), {{Cylinder{0.5, 1}, Shifted(1, 0, 0)}}}, {}}};
  checker->SetScene(scene, Slide(0));
  EXPECT_FALSE(checker->IsFree(Slide(0.5)));
  EXPECT_TRUE(checker->IsFree(Slide(1.5)));
  const auto contact = checker->FindContact(Slide(0.5));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->body_a, "pole");
  EXPECT_EQ(contact->body_b, "shelf");
  scene.allowed_collisions.SetEntry("pole", "shelf", true);
  checker->SetScene(scene, Slide(0));
  EXPECT_TRUE(checker->IsFree(Slide(0.5)));
}

TEST_P(CollisionCheckerContract, AttachedObjectsTouchTheirLinkAndTouchLinks) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const auto base = ArmBase(arm);
  const std::vector<double> q = {0, 0, 0, 0};
  const auto free_with = [&](std::vector<std::string> touch_links) {
    Scene scene;
    scene.attached = {{"hand",
                       {"ball", Shifted(0.1, 0, 0), {{Sphere{0.2}, Eigen::Isometry3d::Identity()}}},
                       std::move(touch_links)}};
    checker->SetScene(scene, base);
    return checker->IsFree(q);
  };
  EXPECT_FALSE(free_with({}));
  EXPECT_FALSE(free_with({"fore", "finger"}));
  EXPECT_TRUE(free_with({"fore", "finger", "pad"}));
}

TEST_P(CollisionCheckerContract, AttachedObjectsMeetEachOther) {
  const Robot robot = MakeTestArm();
  const auto checker = Make(robot);
  const auto base = ArmBase(robot);
  Scene scene;
  scene.attached = {
      {"head",
       {"hat", Shifted(0, 0, 3), {{Box{Eigen::Vector3d(9, 9, 0.1)}, Shifted(0, 0, 0)}}},
       {}},
      {"hand", {"mast", Shifted(0, 0, 3), {{Cylinder{0.01, 2}, Shifted(0, 0, 0)}}}, {}}};
  const std::vector<double> q = {0, 0, 0, 0};
  checker->SetScene(scene, base);
  const auto contact = checker->FindContact(q);
  ASSERT_TRUE(contact);
  EXPECT_EQ(std::set<std::string>({contact->body_a, contact->body_b}),
            std::set<std::string>({"hat", "mast"}));
  scene.attached[1].link = "head";  // welded to the same link they may stand as they like
  checker->SetScene(scene, base);
  EXPECT_TRUE(checker->IsFree(q));
}

TEST_P(CollisionCheckerContract, RemembersNothingOfTheFormerScene) {
  const Robot arm = MakeTestArm();
  const auto base = ArmBase(arm);
  const auto used = Make(arm);
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    const auto fresh = Make(arm);
    fresh->SetScene(world.scene, base);
    used->SetScene(world.scene, base);
    EXPECT_EQ(used->motion_bound().reach(), fresh->motion_bound().reach());
    const auto qs = Configurations(used->space(), 100, 10);
    for (int i = 0; i < 100; ++i) {
      const auto q = Row(qs, used->space().size(), i);
      EXPECT_EQ(used->IsFree(q), fresh->IsFree(q));
      EXPECT_EQ(used->FindClosest(q).distance_m, fresh->FindClosest(q).distance_m);
    }
  }
}

TEST_P(CollisionCheckerContract, HeldJointsMatter) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const std::vector<double> q = {0, 0, 0, 0};
  const auto closed = WithGroupAt(arm, checker->group(), ArmBase(arm, 0.0), q);
  const auto poses = ComputeLinkPoses(arm.model, closed);
  const auto finger = static_cast<std::size_t>(arm.model.FindLink("finger"));
  const Scene scene = SceneWith(
      "nut", Sphere{0.01},
      Eigen::Isometry3d(Eigen::Translation3d(poses[finger] * Eigen::Vector3d(0.06, 0, 0))));
  checker->SetScene(scene, ArmBase(arm, 0.0));
  EXPECT_FALSE(checker->IsFree(q));
  checker->SetScene(scene, ArmBase(arm, 0.3));
  EXPECT_TRUE(checker->IsFree(q));
  checker->SetScene(scene, closed);
  EXPECT_FALSE(checker->IsFree(q));
}

TEST_P(CollisionCheckerContract, AnswersDoNotDependOnWhatWasAskedBefore) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  checker->SetScene(MakeTestScenes()[1].scene, ArmBase(arm));
  const int n = checker->space().size();
  constexpr int kNum = 200;
  const auto qs = Configurations(checker->space(), kNum, 11);
  std::vector<bool> free;
  std::vector<std::optional<Contact>> contacts;
  for (int i = 0; i < kNum; ++i) {
    free.push_back(checker->IsFree(Row(qs, n, i)));
    contacts.push_back(checker->FindContact(Row(qs, n, i)));
  }
  for (int i = kNum - 1; i >= 0; --i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_EQ(checker->IsFree(Row(qs, n, i)), free[index]);
    const auto again = checker->FindContact(Row(qs, n, i));
    ASSERT_EQ(again.has_value(), contacts[index].has_value());
    if (!again) continue;
    EXPECT_EQ(again->body_a, contacts[index]->body_a);
    EXPECT_EQ(again->body_b, contacts[index]->body_b);
    EXPECT_EQ(again->depth_m, contacts[index]->depth_m);
  }
}

TEST_P(CollisionCheckerContract, JudgesConfigurationsBeyondLimits) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  checker->SetScene(SceneWith("far_box", Box{Eigen::Vector3d(1, 1, 1)}, Shifted(0, 0, 30)),
                    Slide(0));
  EXPECT_TRUE(checker->IsFree(Slide(10)));
  EXPECT_FALSE(checker->IsFree(Slide(30)));
  EXPECT_EQ(checker->FindContact(Slide(30)).has_value(), true);
}

TEST_P(CollisionCheckerContract, NothingToCheckIsInfinitelyFarApart) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  checker->SetScene({}, Slide(0));
  const ClosestPair closest = checker->FindClosest(Slide(1));
  EXPECT_EQ(closest.distance_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(closest.body_a, "");
  EXPECT_EQ(closest.body_b, "");
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
