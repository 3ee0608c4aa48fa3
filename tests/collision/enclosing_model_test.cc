// The enclosing model: the robot's second set of spheres, by every engine.

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "collision/collision_checker.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Make = std::unique_ptr<CollisionChecker> (*)(const Robot&, const PlanningGroup&,
                                                   CollisionModel);

class EnclosingModel : public testing::TestWithParam<Make> {
 protected:
  static std::unique_ptr<CollisionChecker> MakeFor(const Robot& robot, CollisionModel model) {
    return GetParam()(robot, robot.groups.front(), model);
  }
};

TEST_P(EnclosingModel, ChecksTheSecondSetAndNotTheFirst) {
  Robot robot = MakeTestArm();
  Robot larger = robot;
  for (LinkSphere& sphere : larger.spheres) sphere.radius += 0.05;
  robot.enclosing_spheres = larger.spheres;
  const auto own = MakeFor(robot, CollisionModel::kSpheres);
  const auto enclosing = MakeFor(robot, CollisionModel::kEnclosing);
  const auto expected = MakeFor(larger, CollisionModel::kSpheres);
  const std::vector<double> base = robot.model.DefaultPositions();
  std::mt19937_64 random(3);
  int differ = 0;
  int num_free = 0;
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    for (const auto& checker : {own.get(), enclosing.get(), expected.get()}) {
      checker->SetScene(world.scene, base);
    }
    EXPECT_EQ(enclosing->motion_bound().reach(), expected->motion_bound().reach());
    for (int i = 0; i < 40; ++i) {
      std::vector<double> q;
      for (const JointSpace::Joint& joint : own->space().joints()) {
        const double low = joint.continuous ? -3 : joint.lower;
        const double high = joint.continuous ? 3 : joint.upper;
        q.push_back(std::uniform_real_distribution<double>(low, high)(random));
      }
      const bool is_free = enclosing->IsFree(q);
      EXPECT_EQ(is_free, expected->IsFree(q));
      EXPECT_EQ(enclosing->FindContact(q).has_value(), !is_free);
      if (is_free) {
        EXPECT_TRUE(own->IsFree(q)) << "larger spheres are free, those within them are not";
        ++num_free;
      } else if (own->IsFree(q)) {
        ++differ;
      }
    }
  }
  EXPECT_GT(num_free, 20);
  EXPECT_GT(differ, 20);
}

TEST_P(EnclosingModel, NeedsTheSecondSet) {
  const Robot robot = MakeTestArm();
  ExpectInputError([&] { MakeFor(robot, CollisionModel::kEnclosing); },
                   {robot.name, "enclosing_spheres", "enclosing model", "make_spheres"});
}

INSTANTIATE_TEST_SUITE_P(Engines, EnclosingModel,
                         testing::Values(&MakeCollisionChecker, &MakeReferenceChecker),
                         [](const auto& instance) {
                           return instance.param == &MakeCollisionChecker ? "simd" : "fcl";
                         });

}  // namespace
}  // namespace planbench
