// Which bodies are checked against each other.

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/contract/collision_checker_contract.h"
#include "tests/contract/collision_test_worlds.h"

namespace planbench {

TEST_P(CollisionCheckerContract, AdjacencyAndAllowedPairsOfTheRobot) {
  Robot arm = MakeTestArm();
  const auto base = ArmBase(arm);
  const std::vector<double> q = {0, 0, 0, 0};
  {
    const auto checker = Make(arm);
    checker->SetScene({}, base);
    EXPECT_TRUE(checker->IsFree(q)) << "adjacent links may overlap";
  }
  // Two links that are welded together over a third, made to overlap, are no pair ...
  for (LinkSphere& sphere : arm.spheres) {
    if (sphere.link == arm.model.FindLink("camera")) sphere.radius = 0.4;
  }
  {
    const auto checker = Make(arm);
    Scene scene;
    for (const char* link : {"base", "upper", "fore", "hand", "finger", "pad"}) {
      scene.allowed_collisions.SetEntry("camera", link, true);
    }
    checker->SetScene(scene, base);
    EXPECT_TRUE(checker->IsFree(q)) << "links rigid to each other may overlap";
  }
  arm = MakeTestArm();
  // ... but two that only a held joint keeps together are always in collision ...
  const int pad = arm.model.FindLink("pad");
  const int hand = arm.model.FindLink("hand");
  for (LinkSphere& sphere : arm.spheres) {
    if (sphere.link == pad) sphere.radius = 0.4;
  }
  {
    const auto checker = Make(arm);
    Scene scene;
    for (const Link& link : arm.model.links()) {
      if (link.name != "hand" && link.name != "pad") {
        scene.allowed_collisions.SetEntry("pad", link.name, true);
      }
    }
    checker->SetScene(scene, base);
    EXPECT_FALSE(checker->IsFree(q));
    const auto contact = checker->FindContact(q);
    ASSERT_TRUE(contact);
    EXPECT_EQ(std::set<std::string>({contact->body_a, contact->body_b}),
              std::set<std::string>({"hand", "pad"}));
    EXPECT_LT(checker->FindClosest(q).distance_m, 0);
    scene.allowed_collisions.SetEntry("pad", "hand", true);
    checker->SetScene(scene, base);
    EXPECT_TRUE(checker->IsFree(q));
  }
  // ... unless the robot's description allows it.
  for (int link = 0; link < arm.model.num_links(); ++link) {
    if (link != pad && link != hand) arm.allowed_pairs.emplace_back(link, pad);
  }
  EXPECT_FALSE([&] {
    const auto checker = Make(arm);
    checker->SetScene({}, base);
    return checker->IsFree(q);
  }());
  arm.allowed_pairs.emplace_back(pad, hand);
  const auto checker = Make(arm);
  checker->SetScene({}, base);
  EXPECT_TRUE(checker->IsFree(q));
}

TEST_P(CollisionCheckerContract, LinksThatAJointConnectsAreCheckedWhereRobotOrSceneSaysSo) {
  const Robot arm = MakeTestArm();
  const auto base = ArmBase(arm);
  const std::vector<double> straight = {0, 0, 0, 0};
  const std::vector<double> folded = {0, 0, 2, 0};  // The hand is bent back into the fore arm.
  Scene elsewhere;  // Where nothing of the hand is checked but with the fore arm.
  for (const Link& link : arm.model.links()) {
    for (const char* bent : {"hand", "finger", "pad"}) {
      if (link.name != "fore" || bent != std::string("hand")) {
        elsewhere.allowed_collisions.SetEntry(bent, link.name, true);
      }
    }
  }
  Scene asks = elsewhere;
  asks.allowed_collisions.SetEntry("hand", "fore", false);
  Scene allows = elsewhere;
  allows.allowed_collisions.SetEntry("hand", "fore", true);
  const auto expect = [&](CollisionChecker& checker, bool is_checked) {
    EXPECT_TRUE(checker.IsFree(straight));
    EXPECT_EQ(checker.IsFree(folded), !is_checked);
    const auto contact = checker.FindContact(folded);
    ASSERT_EQ(contact.has_value(), is_checked);
    if (!is_checked) return;
    EXPECT_EQ(std::set<std::string>({contact->body_a, contact->body_b}),
              std::set<std::string>({"fore", "hand"}));
    EXPECT_LT(checker.FindClosest(folded).distance_m, 0);
  };
  {
    // One checker, so that what it keeps of a scene must follow the matrix.
    const auto checker = Make(arm);
    for (const auto& [scene, is_checked] :
         {std::pair(&elsewhere, false), std::pair(&asks, true), std::pair(&elsewhere, false),
          std::pair(&allows, false), std::pair(&asks, true)}) {
      checker->SetScene(*scene, base);
      expect(*checker, is_checked);
    }
  }
  Robot checks = arm;
  checks.checked_pairs = {{arm.model.FindLink("hand"), arm.model.FindLink("fore")}};
  for (const auto& [scene, is_checked] :
       {std::pair(&elsewhere, true), std::pair(&asks, true), std::pair(&allows, false)}) {
    const auto checker = Make(checks);
    checker->SetScene(*scene, base);
    expect(*checker, is_checked);
  }
  checks.allowed_pairs = checks.checked_pairs;
  const auto checker = Make(checks);
  checker->SetScene(asks, base);
  expect(*checker, false);
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

TEST_P(CollisionCheckerContract, WhatMayTouchIsToldApartAmongObjectsOutOfReach) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  for (const int num_pebbles : {0, 100}) {
    Scene scene;
    AddObject(&scene, "moon", Sphere{1}, Shifted(500, 0, 0));
    AddObject(&scene, "shelf", Box{Eigen::Vector3d(1, 1, 1)}, Shifted(5, 0, 0));
    for (int i = 0; i < num_pebbles; ++i) {
      AddObject(&scene, "pebble" + std::to_string(i), Sphere{0.01}, Shifted(-3, 0, 0.1 * i - 5));
    }
    AddObject(&scene, "star", Sphere{1}, Shifted(0, 900, 0));
    AddObject(&scene, "step", Box{Eigen::Vector3d(1, 1, 1)}, Shifted(0, 0, 3));
    scene.attached = {
        {"tool", {"pole", Shifted(3.25, 0, 0), {{Cylinder{0.5, 1}, Shifted(1, 0, 0)}}}, {}}};
    const auto expect = [&](const std::string& a, const std::string& b, bool shelf, bool step) {
      SCOPED_TRACE(a + " may touch " + b);
      Scene allows = scene;
      allows.allowed_collisions.SetEntry(a, b, true);
      checker->SetScene(allows, Slide(0));
      EXPECT_EQ(checker->IsFree(Slide(0.5)), !shelf);
      EXPECT_EQ(checker->FindContact(Slide(0.5)).has_value(), shelf);
      EXPECT_EQ(checker->IsFree(Slide(3)), !step);
      EXPECT_EQ(checker->FindContact(Slide(3)).has_value(), step);
    };
    expect("pole", "shelf", false, true);
    expect("pole", "moon", true, true);
    expect("tool", "step", true, false);
    expect("tool", "star", true, true);
  }
}

TEST_P(CollisionCheckerContract, AttachedObjectsReachFurtherThanTheRobot) {
  const Robot arm = MakeTestArm();
  const auto checker = Make(arm);
  const auto base = ArmBase(arm);
  const std::vector<double> q = {0, 0, 0, 0};
  const auto hand = static_cast<std::size_t>(arm.model.FindLink("hand"));
  const Eigen::Isometry3d X_WH =
      ComputeLinkPoses(arm.model, WithGroupAt(arm, checker->group(), base, q))[hand];
  Scene scene = SceneWith("buoy", Sphere{0.1}, X_WH * Shifted(12, 0, 0));
  scene.attached = {
      {"hand", {"float", Shifted(12, 0, 0.15), {{Sphere{0.1}, Shifted(0, 0, 0)}}}, {}}};
  checker->SetScene(scene, base);
  const auto contact = checker->FindContact(q);
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->body_b, "buoy");
  EXPECT_FALSE(checker->IsFree(q));
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

}  // namespace planbench
