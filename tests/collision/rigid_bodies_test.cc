#include "collision/rigid_bodies.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"

namespace planbench {
namespace {

void ExpectLinkPosesAgree(const Robot& robot) {
  const PlanningGroup& group = robot.groups.front();
  std::mt19937_64 generator(3);
  for (int i = 0; i < 50; ++i) {
    auto base = robot.model.DefaultPositions();
    for (double& position : base) {
      position += std::uniform_real_distribution<double>(0, 0.3)(generator);
    }
    const RigidBodies bodies(robot.model, group, base);
    const auto q = RandomConfiguration(group.space, &generator);
    std::vector<Pose> X_WG(static_cast<std::size_t>(bodies.size()));
    bodies.ComputePoses(q, X_WG);
    const auto expected = ComputeLinkPoses(robot.model, WithGroupAt(robot, group, base, q));
    for (int link = 0; link < robot.model.num_links(); ++link) {
      const Pose X_WL = X_WG[static_cast<std::size_t>(bodies.BodyOf(link))] * bodies.X_GL(link);
      EXPECT_TRUE(X_WL.ToIsometry().isApprox(expected[static_cast<std::size_t>(link)], 1e-12));
    }
  }
}

TEST(RigidBodiesTest, LinkPosesAreThoseOfTheModel) {
  ExpectLinkPosesAgree(MakeTestArm());
  ExpectLinkPosesAgree(LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch"));
}

TEST(RigidBodiesTest, LinksWithoutAGroupJointBetweenThemAreOneBody) {
  const Robot arm = MakeTestArm();
  const RigidBodies bodies(arm.model, arm.groups.front(), arm.model.DefaultPositions());
  const auto body = [&](const char* link) { return bodies.BodyOf(arm.model.FindLink(link)); };
  EXPECT_EQ(bodies.size(), 5);
  EXPECT_EQ(body("base"), 0);
  EXPECT_EQ(body("camera"), body("torso"));
  EXPECT_EQ(body("pad"), body("hand"));
  EXPECT_NE(body("fore"), body("hand"));
  EXPECT_TRUE(bodies.Descends(body("hand"), body("torso")));
  EXPECT_TRUE(bodies.Descends(body("hand"), 0));
  EXPECT_FALSE(bodies.Descends(body("torso"), body("hand")));
}

TEST(RigidBodiesTest, NothingLeavesItsReach) {
  const Robot arm = MakeTestArm();
  const RigidBodies bodies(arm.model, arm.groups.front(), arm.model.DefaultPositions());
  const Ball ball{Eigen::Vector3d(0.1, -0.2, 0.3), 0.05};
  std::mt19937_64 generator(4);
  std::vector<Pose> X_WG(static_cast<std::size_t>(bodies.size()));
  for (int i = 0; i < 200; ++i) {
    bodies.ComputePoses(RandomConfiguration(arm.groups.front().space, &generator), X_WG);
    for (int body = 0; body < bodies.size(); ++body) {
      for (int ancestor = 0; ancestor <= body; ++ancestor) {
        if (!bodies.Descends(body, ancestor)) continue;
        const Ball reach = bodies.Reach(ancestor, body, ball);
        const Eigen::Vector3d center = X_WG[static_cast<std::size_t>(ancestor)].InverseTimes(
            X_WG[static_cast<std::size_t>(body)] * ball.center);
        EXPECT_LE((center - reach.center).norm() + ball.radius, reach.radius + 1e-12);
      }
    }
  }
}

TEST(RigidBodiesTest, KnowsWhenAPrismaticJointIsBeyondItsTravel) {
  const Robot robot = MakeRailRobot();
  const RigidBodies bodies(robot.model, robot.groups.front(), robot.model.DefaultPositions());
  EXPECT_TRUE(bodies.WithinTravel(std::vector<double>{-10}));
  EXPECT_FALSE(bodies.WithinTravel(std::vector<double>{10.1}));
}

}  // namespace
}  // namespace planbench
