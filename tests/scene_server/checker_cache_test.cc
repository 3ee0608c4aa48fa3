#include "scene_server/checker_cache.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "robot_model/full_positions.h"
#include "tests/scene_server/tiny_world.h"

namespace planbench {
namespace {

class CheckerCacheTest : public ::testing::Test {
 protected:
  CollisionChecker& Get(CheckerCache* cache, const std::string& scene_id,
                        const std::shared_ptr<const Scene>& scene, double finger, double swing) {
    return cache->Get(
        robot_.Group("arm"), CollisionModel::kSpheres, scene_id, scene,
        FullPositions(robot_.model, {"finger_joint", "swing"}, {finger, swing}, "test"));
  }

  TemporaryFolder folder_;
  Robot robot_ = LoadRobot(WriteTinyRobot(folder_));
  std::shared_ptr<const Scene> cans_ = std::make_shared<const Scene>(TinyProblem().scene);
  std::shared_ptr<const Scene> nothing_ = std::make_shared<const Scene>();
  std::vector<double> at_can_ = {0, 0};
  std::vector<double> at_post_ = {3.14, 0};
};

TEST_F(CheckerCacheTest, KeepsOneCheckerForAllScenes) {
  CheckerCache cache(robot_);
  CollisionChecker& checker = Get(&cache, "cans", cans_, 0, 0);
  EXPECT_FALSE(checker.IsFree(at_can_));
  EXPECT_EQ(&Get(&cache, "nothing", nothing_, 0, 0), &checker);
  EXPECT_TRUE(checker.IsFree(at_can_));
  Get(&cache, "cans", cans_, 0, 0);
  EXPECT_FALSE(checker.IsFree(at_can_));
}

TEST_F(CheckerCacheTest, SceneIsSetAgainWhenHeldJointsMove) {
  CheckerCache cache(robot_);
  EXPECT_TRUE(Get(&cache, "cans", cans_, 0, 0).IsFree(at_post_));
  EXPECT_FALSE(Get(&cache, "cans", cans_, 0.3, 0).IsFree(at_post_));
}

TEST_F(CheckerCacheTest, SceneIsNotSetAgainForTheGroupsOwnJoints) {
  CheckerCache cache(robot_);
  EXPECT_FALSE(Get(&cache, "cans", cans_, 0, 0).IsFree(at_can_));
  // Another scene by the same id would only be noticed if it were set.
  EXPECT_FALSE(Get(&cache, "cans", nothing_, 0, 1).IsFree(at_can_));
}

TEST_F(CheckerCacheTest, ARefusedSceneIsNotTakenForSet) {
  CheckerCache cache(robot_);
  Scene bad = *cans_;
  bad.attached.push_back({"no such link", bad.objects[0], {}});
  const auto refused = std::make_shared<const Scene>(bad);
  EXPECT_THROW(Get(&cache, "bad", refused, 0, 0), InputError);
  EXPECT_THROW(Get(&cache, "bad", refused, 0, 0), InputError);
  EXPECT_FALSE(Get(&cache, "cans", cans_, 0, 0).IsFree(at_can_));
}

}  // namespace
}  // namespace planbench
