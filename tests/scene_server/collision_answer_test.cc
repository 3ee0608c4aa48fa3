#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/numbers.h"
#include "tests/scene_server/tiny_world.h"

namespace planbench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class CollisionAnswer : public ::testing::Test {
 protected:
  CollisionRequestMessage Request() {
    CollisionRequestMessage request;
    request.request_id = "id";
    request.scene_id = world_.SceneIdOfFirst();
    return request;
  }
  /// The message of a refusal.
  std::string Refusal(const CollisionRequestMessage& request) {
    const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
    EXPECT_FALSE(reply.ok);
    EXPECT_EQ(reply.request_id, "id");
    EXPECT_TRUE(reply.states.empty());
    EXPECT_TRUE(reply.edges.empty());
    return reply.message;
  }

  TinyWorld world_;
};

TEST_F(CollisionAnswer, JudgesStates) {
  CollisionRequestMessage request = Request();
  request.states = {{1, 0}, {0, 0}, {0, 0.4}, {1, 0.6}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_EQ(reply.request_id, "id");
  EXPECT_FALSE(reply.engine.empty());
  ASSERT_EQ(reply.states.size(), 4u);
  EXPECT_TRUE(reply.edges.empty());

  EXPECT_TRUE(reply.states[0].free);
  EXPECT_TRUE(reply.states[0].within_limits);
  EXPECT_EQ(reply.states[0].body_a, "");

  EXPECT_FALSE(reply.states[1].free);
  EXPECT_TRUE(reply.states[1].within_limits);
  EXPECT_EQ(reply.states[1].body_b, "can");
  EXPECT_GT(reply.states[1].depth_m, 0);
  EXPECT_EQ(reply.states[1].distance_m, 0);  // not asked for
  EXPECT_EQ(reply.states[1].nearest_a, "");

  EXPECT_TRUE(reply.states[2].free);

  EXPECT_TRUE(reply.states[3].free);
  EXPECT_FALSE(reply.states[3].within_limits);
}

TEST_F(CollisionAnswer, GivesTheDistanceWhenAsked) {
  CollisionRequestMessage request = Request();
  request.with_distance = true;
  // Arm's end at (0, 0.5), the can at (0.5, 0): 0.5 sqrt(2) between the axes at the same height.
  // The sphere at 0.3 m is nearer.
  request.states = {{kPi / 2, 0}, {0, 0}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_NEAR(reply.states[0].distance_m, std::hypot(0.5, 0.2) - 0.1, 1e-6);
  EXPECT_EQ(reply.states[0].nearest_a, "arm");
  EXPECT_EQ(reply.states[0].nearest_b, "can");
  EXPECT_LE(reply.states[1].distance_m, 0);
}

TEST_F(CollisionAnswer, EdgeTellsWhereItFirstTouches) {
  CollisionRequestMessage request = Request();
  request.edge_resolution_m = 0.001;
  request.edge_check = EdgeCheck::kFixed;
  request.edges = {
      {{-1, 0}, {1, 0}}, {{-1, 0}, {-1, 0.5}}, {{-1, 0.5}, {1, 0.5}}, {{-1, 0.5}, {-1, 0.7}}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  ASSERT_EQ(reply.edges.size(), 4u);
  // The arm's end (radius 0.05 at 0.5 m) meets the can (radius 0.05 at 0.5 m) when their centres
  // are 0.1 m apart: at an angle of 2 asin(0.1) before the middle.
  EXPECT_FALSE(reply.edges[0].free);
  EXPECT_EQ(reply.edges[0].body_b, "can");
  EXPECT_NEAR(reply.edges[0].fraction, (1 - 2 * std::asin(0.1)) / 2, 0.001);
  EXPECT_LT(reply.edges[0].depth_m, 0.002);
  EXPECT_TRUE(reply.edges[1].free);
  EXPECT_TRUE(reply.edges[2].free);
  EXPECT_TRUE(reply.edges[2].within_limits);
  EXPECT_FALSE(reply.edges[3].within_limits);
}

TEST_F(CollisionAnswer, EdgesAreCheckedAsAsked) {
  // Past the can, which the arm touches within 0.2 rad of the middle: not at samples this far
  // apart.
  CollisionRequestMessage request = Request();
  request.edge_resolution_m = 0.4;
  request.edges = {{{-0.3, 0}, {0.35, 0}}, {{1, 0}, {2, 0}}};
  request.edge_check = EdgeCheck::kFixed;
  const CollisionReplyMessage fixed = world_.service().AnswerCollision(request);
  ASSERT_TRUE(fixed.ok) << fixed.message;
  EXPECT_TRUE(fixed.edges[0].free);
  EXPECT_TRUE(fixed.edges[1].free);
  for (const std::optional<EdgeCheck> method :
       {std::optional<EdgeCheck>(), std::optional(EdgeCheck::kCertified)}) {
    request.edge_check = method;  // none: the robot's, which is certified
    const CollisionReplyMessage proven = world_.service().AnswerCollision(request);
    ASSERT_TRUE(proven.ok) << proven.message;
    EXPECT_FALSE(proven.edges[0].free);
    EXPECT_EQ(proven.edges[0].body_b, "can");
    EXPECT_NEAR(-0.3 + 0.65 * proven.edges[0].fraction, 0, 0.21);
    EXPECT_TRUE(proven.edges[1].free);
  }
}

TEST_F(CollisionAnswer, EdgeInCollisionAtItsBeginningIsAtFractionZero) {
  CollisionRequestMessage request = Request();
  request.edges = {{{0, 0}, {1, 0}}, {{1, 0}, {0, 0}}, {{0, 0}, {0, 0}}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_FALSE(reply.edges[0].free);
  EXPECT_EQ(reply.edges[0].fraction, 0);
  EXPECT_FALSE(reply.edges[1].free);
  EXPECT_GT(reply.edges[1].fraction, 0.5);
  EXPECT_FALSE(reply.edges[2].free);
  EXPECT_EQ(reply.edges[2].fraction, 0);
}

TEST_F(CollisionAnswer, ContinuousJointTakesTheShortWay) {
  CollisionRequestMessage request = Request();
  request.edges = {{{-3, 0}, {3, 0}}, {{-1.5, 0}, {1.5, 0}}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_TRUE(reply.edges[0].free);   // through pi
  EXPECT_FALSE(reply.edges[1].free);  // through 0
}

TEST_F(CollisionAnswer, HoldsJointsOutsideTheGroup) {
  CollisionRequestMessage request = Request();
  request.states = {{kPi, 0}};
  EXPECT_TRUE(world_.service().AnswerCollision(request).states.at(0).free);
  request.state = {{"finger_joint"}, {0.3}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_FALSE(reply.states.at(0).free);
  EXPECT_EQ(reply.states.at(0).body_a, "finger");
  EXPECT_EQ(reply.states.at(0).body_b, "post");
}

TEST_F(CollisionAnswer, AnswersForTheGroupAsked) {
  CollisionRequestMessage request = Request();
  request.group = "lift_only";
  request.state = {{"swing"}, {0}};
  request.states = {{0}, {0.4}};
  const CollisionReplyMessage reply = world_.service().AnswerCollision(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_FALSE(reply.states.at(0).free);
  EXPECT_TRUE(reply.states.at(1).free);
}

TEST_F(CollisionAnswer, RefusesWhatItDoesNotKnow) {
  CollisionRequestMessage request = Request();
  request.scene_id = "0123";
  EXPECT_THAT(Refusal(request), AllOf(HasSubstr("scene_id"), HasSubstr("0123")));
  request = Request();
  request.group = "legs";
  EXPECT_THAT(Refusal(request), HasSubstr("'legs'"));
  request = Request();
  request.state = {{"torso"}, {0}};
  EXPECT_THAT(Refusal(request), AllOf(HasSubstr("state"), HasSubstr("'torso'")));
}

TEST_F(CollisionAnswer, RefusesWrongSizes) {
  CollisionRequestMessage request = Request();
  request.states = {{0, 0}, {0}};
  EXPECT_THAT(Refusal(request), HasSubstr("position[1] has 1 positions"));
  request = Request();
  request.edges = {{{0, 0}, {0, 0, 0}}};
  EXPECT_THAT(Refusal(request), HasSubstr("edge_to[0] has 3 positions"));
}

TEST_F(CollisionAnswer, RefusesBadNumbers) {
  CollisionRequestMessage request = Request();
  request.edge_resolution_m = -0.01;
  EXPECT_THAT(Refusal(request), HasSubstr("resolution"));
  request = Request();
  request.edge_resolution_m = 1e-7;
  request.edges = {{{-1, 0}, {1, 0}}};
  EXPECT_THAT(Refusal(request), AllOf(HasSubstr("edge_resolution_m"), HasSubstr("samples")));
  request = Request();
  request.states = {{std::numeric_limits<double>::quiet_NaN(), 0}};
  EXPECT_THAT(Refusal(request), HasSubstr("finite"));
}

}  // namespace
}  // namespace planbench
