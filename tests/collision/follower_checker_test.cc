#include "collision/follower_checker.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "collision/edge_checker.h"
#include "tests/contract/collision_test_worlds.h"

namespace planbench {
namespace {

// Two arms of two links each, planar, that close on each other like a gripper: the right one
// follows the left, its elbow by half.
constexpr char kArm[] =
    "<joint name='{side}_shoulder' type='revolute'><parent link='base'/><child "
    "link='{side}_upper'/>"
    "<origin xyz='{x} 0 0'/><axis xyz='0 0 1'/>"
    "<limit lower='-3' upper='3' velocity='1' effort='1'/>{shoulder}</joint>"
    "<joint name='{side}_elbow' type='revolute'><parent link='{side}_upper'/><child "
    "link='{side}_fore'/>"
    "<origin xyz='0.5 0 0'/><axis xyz='0 0 1'/>"
    "<limit lower='-3' upper='3' velocity='1' effort='1'/>{elbow}</joint>";

std::string Arm(const std::string& side, double x, const std::string& shoulder,
                const std::string& elbow) {
  return fmt::format(kArm, fmt::arg("side", side), fmt::arg("x", x), fmt::arg("shoulder", shoulder),
                     fmt::arg("elbow", elbow));
}

Robot MakeArms(bool mimic) {
  const std::string shoulder =
      mimic ? "<mimic joint='left_shoulder' multiplier='-1' offset='0.3'/>" : "";
  const std::string elbow = mimic ? "<mimic joint='left_elbow' multiplier='-0.5'/>" : "";
  const std::string urdf =
      "<robot name='arms'><link name='base'/><link name='left_upper'/>"
      "<link name='left_fore'/><link name='right_upper'/>"
      "<link name='right_fore'/>" +
      Arm("left", -0.4, "", "") + Arm("right", 0.4, shoulder, elbow) + "</robot>";
  Robot robot;
  robot.name = "arms";
  robot.model = RobotModel::FromUrdf(urdf, "arms.urdf");
  std::vector<std::string> joints = {"left_elbow", "left_shoulder"};
  if (!mimic) joints.insert(joints.end(), {"right_shoulder", "right_elbow"});
  robot.groups = {robot.model.MakeGroup("arms", joints, "left_fore")};
  for (int link = 1; link < robot.model.num_links(); ++link) {
    for (double x = 0.1; x < 0.5; x += 0.1) {
      robot.spheres.push_back({link, Eigen::Vector3d(x, 0, 0), 0.06});
    }
  }
  return robot;
}

std::vector<double> Plain(const std::vector<double>& q) {
  return {q[0], q[1], -q[1] + 0.3, -0.5 * q[0]};
}

Scene Posts() {
  Scene scene;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(0.5, 0.8, 0);
  AddObject(&scene, "post", Cylinder{0.1, 1}, X);
  X.translation() = Eigen::Vector3d(-0.9, -0.5, 0);
  AddObject(&scene, "block", Box{{0.2, 0.2, 0.2}}, X);
  return scene;
}

class FollowerCheckerTest : public testing::TestWithParam<bool> {
 protected:
  FollowerCheckerTest() {
    mimic_->SetScene(Posts(), robot_.model.DefaultPositions());
    plain_->SetScene(Posts(), plain_robot_.model.DefaultPositions());
  }

  static std::unique_ptr<CollisionChecker> Make(const Robot& robot) {
    const PlanningGroup& group = robot.groups[0];
    return GetParam() ? MakeReferenceChecker(robot, group, CollisionModel::kSpheres)
                      : MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
  }
  std::vector<double> Draw() {
    std::uniform_real_distribution<double> position(-2.5, 2.5);
    return {position(random_), position(random_)};
  }

  std::mt19937 random_{1};
  const Robot robot_ = MakeArms(true);
  const Robot plain_robot_ = MakeArms(false);
  std::unique_ptr<CollisionChecker> mimic_ = Make(robot_);
  std::unique_ptr<CollisionChecker> plain_ = Make(plain_robot_);
};

TEST_P(FollowerCheckerTest, JudgesAsIfTheFollowersWereMovedThere) {
  int free = 0;
  std::vector<double> rows;
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> q = Draw();
    rows.insert(rows.end(), q.begin(), q.end());
    EXPECT_EQ(mimic_->IsFree(q), plain_->IsFree(Plain(q)));
    const ClosestPair closest = mimic_->FindClosest(q);
    const ClosestPair expected = plain_->FindClosest(Plain(q));
    EXPECT_NEAR(closest.distance_m, expected.distance_m, 1e-12);
    EXPECT_EQ(closest.body_b, expected.body_b);
    const auto contact = mimic_->FindContact(q);
    EXPECT_EQ(contact.has_value(), !mimic_->IsFree(q));
    free += contact ? 0 : 1;
  }
  EXPECT_GT(free, 30);
  EXPECT_LT(free, 270);
  std::vector<unsigned char> verdicts(300);
  std::vector<double> distances(300);
  mimic_->CheckAll(rows, 300, verdicts);
  std::vector<unsigned char> passed(300);
  mimic_->Screen(rows, 300, passed);
  EXPECT_EQ(passed, verdicts);  // of spheres
  mimic_->FindDistances(rows, 300, 0.5, distances);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::span<const double> q = std::span(rows).subspan(2 * i, 2);
    EXPECT_EQ(verdicts[i] != 0, mimic_->IsFree(q));
    // In collision engines may say no more than that.
    const double expected = std::clamp(mimic_->FindClosest(q).distance_m, 0.0, 0.5);
    EXPECT_NEAR(std::max(0.0, distances[i]), expected, 2e-4);
  }
}

TEST_P(FollowerCheckerTest, CertifiedEdgesAreFreeAllAlong) {
  EdgeChecker edges(mimic_.get(), 0.02, EdgeCheck::kCertified);
  const JointSpace& space = mimic_->space();
  int accepted = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> from = Draw();
    std::vector<double> to = Draw();
    space.Interpolate(from, to, 0.3, to);
    if (!edges.IsValidEdge(from, to)) continue;
    ++accepted;
    std::vector<double> q(2);
    for (int s = 0; s <= 200; ++s) {
      space.Interpolate(from, to, s / 200.0, q);
      EXPECT_TRUE(plain_->IsFree(Plain(q)));
    }
  }
  EXPECT_GT(accepted, 20);
}

INSTANTIATE_TEST_SUITE_P(Engines, FollowerCheckerTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "fcl" : "simd"; });

}  // namespace
}  // namespace planbench
