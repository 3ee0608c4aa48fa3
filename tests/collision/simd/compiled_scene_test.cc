#include "collision/simd/compiled_scene.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/contract/collision_test_worlds.h"

namespace planbench {
namespace {

// Its set-up grows with the number of objects, which do not matter there.
TEST(CompiledSceneTest, TheExactEngineIsAskedOfWhatIsAttachedOnlyWhenThatChanges) {
  const Robot arm = MakeTestArm();
  const std::vector<double> base = arm.model.DefaultPositions();
  CompiledScene compiled(arm, arm.groups.front(), CollisionModel::kSpheres);
  int num_asked = 0;
  bool collide = false;
  const auto expect_asked = [&](const Scene& scene, int times) {
    compiled.Set(scene, base, [&](const Scene& without_objects) {
      ++num_asked;
      EXPECT_TRUE(without_objects.objects.empty());
      EXPECT_EQ(without_objects.attached, scene.attached);
      EXPECT_EQ(without_objects.allowed_collisions, scene.allowed_collisions);
      return collide;
    });
    EXPECT_EQ(num_asked, times);
    EXPECT_EQ(compiled.standing().collide, collide);
    EXPECT_FALSE(compiled.standing().doubtful);
  };
  Scene scene;
  expect_asked(scene, 0);
  // The finger and its pad are fixed to the hand.
  scene.attached = {{"hand", SceneWith("ball", Sphere{0.05}).objects.front(), {}}};
  expect_asked(scene, 1);
  AddObject(&scene, "box", Box{{1, 1, 1}}, Eigen::Isometry3d(Eigen::Translation3d(5, 0, 0)));
  expect_asked(scene, 1);
  collide = true;
  scene.allowed_collisions.SetEntry("ball", "box", true);
  expect_asked(scene, 2);
  scene.objects.clear();
  expect_asked(scene, 2);
  collide = false;
  scene.attached.front().touch_links = {"finger"};
  expect_asked(scene, 3);
}

}  // namespace
}  // namespace planbench
