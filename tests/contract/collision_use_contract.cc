// What may be asked and in which order; what is remembered.

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "robot_model/full_positions.h"
#include "tests/contract/collision_checker_contract.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"

namespace planbench {

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
  ExpectInputError([&] { checker->Screen(q, 1, verdicts); }, {"2"});
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

TEST_P(CollisionCheckerContract, WhatIsClosestDoesNotDependOnWhatWasAskedBefore) {
  const Robot arm = MakeTestArm();
  const auto base = ArmBase(arm);
  const auto walking = Make(arm);
  const auto fresh = Make(arm);
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    walking->SetScene(world.scene, base);
    const int n = walking->space().size();
    const auto qs = Configurations(walking->space(), 4, 12);
    for (int i = 1; i < 4; ++i) {
      const auto from = Row(qs, n, i - 1);
      const auto to = Row(qs, n, i);
      for (int step = 0; step < 20; ++step) {
        std::vector<double> q(from.begin(), from.end());
        for (std::size_t j = 0; j < q.size(); ++j) q[j] += step * 0.01 * (to[j] - from[j]);
        fresh->SetScene(world.scene, base);
        const ClosestPair expected = fresh->FindClosest(q);
        const ClosestPair actual = walking->FindClosest(q);
        EXPECT_NEAR(actual.distance_m, expected.distance_m, 1e-9);
        EXPECT_EQ(actual.body_a, expected.body_a);
        EXPECT_EQ(actual.body_b, expected.body_b);
      }
    }
  }
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

}  // namespace planbench
