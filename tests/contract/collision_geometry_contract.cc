// Answers where geometry is simple enough to know them.

#include <cmath>
#include <limits>
#include <vector>

#include "tests/contract/collision_checker_contract.h"
#include "tests/contract/collision_test_worlds.h"

namespace planbench {

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

TEST_P(CollisionCheckerContract, NothingToCheckIsInfinitelyFarApart) {
  const Robot robot = MakeRailRobot();
  const auto checker = Make(robot);
  checker->SetScene({}, Slide(0));
  const ClosestPair closest = checker->FindClosest(Slide(1));
  EXPECT_EQ(closest.distance_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(closest.body_a, "");
  EXPECT_EQ(closest.body_b, "");
}

}  // namespace planbench
