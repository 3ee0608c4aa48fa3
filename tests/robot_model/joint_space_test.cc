#include "robot_model/joint_space.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "common/numbers.h"

namespace planbench {
namespace {

// A prismatic, a revolute and a continuous joint.
JointSpace Space() {
  return JointSpace({{.name = "slide", .prismatic = true, .lower = 0, .upper = 0.4},
                     {.name = "bend", .lower = -2, .upper = 2},
                     {.name = "roll", .continuous = true, .lower = -kPi, .upper = kPi}});
}

TEST(WrapAngle, BringsAnglesIntoTheHalfOpenInterval) {
  EXPECT_EQ(WrapAngle(0), 0);
  EXPECT_EQ(WrapAngle(-kPi), -kPi);
  EXPECT_EQ(WrapAngle(kPi), -kPi);
  EXPECT_EQ(WrapAngle(3 * kPi), -kPi);
  EXPECT_NEAR(WrapAngle(kPi + 0.1), -kPi + 0.1, 1e-15);
  EXPECT_NEAR(WrapAngle(-kPi - 0.1), kPi - 0.1, 1e-15);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1000, 1000);
  for (int i = 0; i < 10000; ++i) {
    const double angle = uniform(random);
    const double wrapped = WrapAngle(angle);
    EXPECT_GE(wrapped, -kPi);
    EXPECT_LT(wrapped, kPi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_EQ(WrapAngle(wrapped), wrapped);
  }
}

TEST(JointSpace, FindsJointsByName) {
  const JointSpace space = Space();
  EXPECT_EQ(space.size(), 3);
  EXPECT_EQ(space.Find("bend"), 1);
  EXPECT_EQ(space.Find("nod"), -1);
}

TEST(JointSpace, FindsTheTurnThatIsNearestWithinLimits) {
  const JointSpace space({{.name = "slide", .prismatic = true, .lower = -9, .upper = 9},
                          {.name = "twice", .lower = -2 * kPi, .upper = 2 * kPi},
                          {.name = "once", .lower = -2, .upper = 2},
                          {.name = "roll", .continuous = true, .lower = -kPi, .upper = kPi}});
  std::vector<double> q = {8, 6, 1, 3};
  space.ToNearestTurn(std::vector<double>{0, -0.5, 0, -3}, q);
  EXPECT_EQ(q[0], 8);
  EXPECT_NEAR(q[1], 6 - 2 * kPi, 1e-12);
  EXPECT_EQ(q[2], 1);
  EXPECT_EQ(q[3], 3);
  q[1] = -1;
  space.ToNearestTurn(std::vector<double>{0, 6.2, 0, 0}, q);
  EXPECT_NEAR(q[1], 2 * kPi - 1, 1e-12);
  q[1] = 1;
  space.ToNearestTurn(std::vector<double>{0, 6.2, 0, 0}, q);
  EXPECT_EQ(q[1], 1) << "a turn more is beyond the limit";
}

TEST(JointSpace, AJointThatIsElsewhereATurnLaterKeepsItsTurns) {
  const JointSpace space(
      {{.name = "crank", .lower = -3 * kPi, .upper = 3 * kPi, .same_after_turn = false},
       {.name = "twice", .lower = -2 * kPi, .upper = 2 * kPi}});
  for (const JointSpace& one : {space, space.Held({}, std::vector<double>{0, 0})}) {
    std::vector<double> q = {6, 6};
    one.ToNearestTurn(std::vector<double>{-0.5, -0.5}, q);
    EXPECT_EQ(q[0], 6);
    EXPECT_NEAR(q[1], 6 - 2 * kPi, 1e-12);
  }
}

TEST(JointSpace, HasNothingButOnePositionOfJointsThatAreHeld) {
  const JointSpace held = Space().Held({0, 2}, std::vector<double>{0.3, 1, 3});
  EXPECT_TRUE(held.WithinLimits(std::vector<double>{0.3, -2, 3}));
  EXPECT_FALSE(held.WithinLimits(std::vector<double>{0.2, -2, 3}));
  EXPECT_FALSE(held.WithinLimits(std::vector<double>{0.3, -2, 3 - 2 * kPi}));
}

TEST(JointSpace, OnlyContinuousJointsGoTheShortWay) {
  const JointSpace space = Space();
  EXPECT_NEAR(space.Difference(2, 3, -3), 2 * kPi - 6, 1e-15);
  EXPECT_NEAR(space.Difference(2, -3, 3), 6 - 2 * kPi, 1e-15);
  EXPECT_EQ(space.Difference(1, 1.9, -1.9), -3.8);
  EXPECT_EQ(space.Difference(0, 0.4, 0), -0.4);
  // The two names of one angle.
  EXPECT_EQ(space.Difference(2, kPi, -kPi), 0);
}

TEST(JointSpace, DifferenceIsWithinHalfATurnAndLeadsToTheTarget) {
  const JointSpace space = Space();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-20, 20);
  for (int i = 0; i < 10000; ++i) {
    const double from = uniform(random);
    const double to = uniform(random);
    const double difference = space.Difference(2, from, to);
    EXPECT_LE(std::abs(difference), kPi);
    EXPECT_NEAR(std::remainder(from + difference - to, 2 * kPi), 0, 1e-12);
    EXPECT_NEAR(std::abs(space.Difference(2, to, from)), std::abs(difference), 1e-12);
  }
}

TEST(JointSpace, DistanceIsTheNormOfTheDifferences) {
  const JointSpace space = Space();
  const std::vector<double> a = {0.1, -1, 3};
  const std::vector<double> b = {0.4, 1, -3};
  EXPECT_NEAR(space.Distance(a, b), std::hypot(0.3, 2.0, 2 * kPi - 6), 1e-15);
  EXPECT_EQ(space.Distance(a, b), space.Distance(b, a));
  EXPECT_EQ(space.Distance(a, a), 0);
}

TEST(JointSpace, InterpolateKeepsTheEndsExactly) {
  const JointSpace space = Space();
  // Ends that wrapping would change.
  const std::vector<double> a = {0.1, -1, kPi};
  const std::vector<double> b = {0.3, 1, 7.5};
  std::vector<double> out(3);
  space.Interpolate(a, b, 0, out);
  EXPECT_EQ(out, a);
  space.Interpolate(a, b, 1, out);
  EXPECT_EQ(out, b);
}

TEST(JointSpace, InterpolateDividesTheStraightMotion) {
  const JointSpace space = Space();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> slide(0, 0.4), bend(-2, 2), roll(-kPi, kPi), part(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> a = {slide(random), bend(random), roll(random)};
    const std::vector<double> b = {slide(random), bend(random), roll(random)};
    const double t = part(random);
    std::vector<double> out(3);
    space.Interpolate(a, b, t, out);
    EXPECT_NEAR(space.Distance(a, out), t * space.Distance(a, b), 1e-12);
    EXPECT_NEAR(space.Distance(out, b), (1 - t) * space.Distance(a, b), 1e-12);
    EXPECT_TRUE(space.WithinLimits(out));
    EXPECT_GE(out[2], -kPi);
    EXPECT_LT(out[2], kPi);
  }
}

TEST(JointSpace, WrapTouchesOnlyContinuousJoints) {
  std::vector<double> q = {7, 7, 7};
  Space().Wrap(q);
  EXPECT_EQ(q[0], 7);
  EXPECT_EQ(q[1], 7);
  EXPECT_NEAR(q[2], 7 - 2 * kPi, 1e-15);
}

TEST(JointSpace, WholeTurnsOfContinuousJointsAreTakenOut) {
  const JointSpace space = Space();
  for (const double within : {0.0, 3.0, -kPi, kPi})
    EXPECT_EQ(space.WithoutTurns(2, within), within);
  EXPECT_NEAR(space.WithoutTurns(2, 3.5), 3.5 - 2 * kPi, 1e-15);
  EXPECT_NEAR(space.WithoutTurns(2, 180), 180 - 58 * kPi, 1e-12);
  EXPECT_EQ(space.WithoutTurns(2, 1e9), 1e9) << "turns cannot be told, and limits are exceeded";
  EXPECT_EQ(space.WithoutTurns(1, 7), 7);
}

TEST(JointSpace, AContinuousJointTurnedMoreThanOnceIsInDoubt) {
  EXPECT_FALSE(Space().FindTurnsDoubt(2, -6.28));
  EXPECT_EQ(Space().FindTurnsDoubt(2, 90), "is at 90 rad, 14.3 turns; degrees?");
  EXPECT_EQ(Space().FindTurnsDoubt(2, 1e300), "is at 1e+300 rad, 1.59e+299 turns; degrees?");
  EXPECT_FALSE(Space().FindTurnsDoubt(1, 90));
}

TEST(JointSpace, TurnsAreTakenOutOfAWholeConfiguration) {
  std::vector<double> q = {0.1, 1, 3.5};
  EXPECT_TRUE(Space().TakeTurnsOut(q).empty());
  EXPECT_NEAR(q[2], 3.5 - 2 * kPi, 1e-15);
  q = {7, 1, -90};
  const std::vector<std::string> doubts = Space().TakeTurnsOut(q);
  ASSERT_EQ(doubts.size(), 2u);
  EXPECT_EQ(doubts[0], "joint 'roll' is at -90 rad, -14.3 turns; degrees?");
  EXPECT_EQ(doubts[1], Space().FindLimitFault(q));
  EXPECT_NEAR(q[2], -90 + 28 * kPi, 1e-12);
}

TEST(JointSpace, TellsTheLimitsThatHold) {
  const JointSpace space = Space();
  EXPECT_EQ(space.DescribeLimits(0), "[0, 0.4]");
  EXPECT_EQ(space.DescribeLimits(2), "[-1000000, 1000000]");
  const std::vector<double> outside = {0.5, 0, 0};
  EXPECT_EQ(space.FindLimitFault(outside),
            fmt::format("joint '{}' at 0.5 is outside its limits [0, 0.4]", space.joint(0).name));
  EXPECT_TRUE(space.WithinLimits(std::vector<double>{0, 0, 999999.0}));
  EXPECT_FALSE(space.WithinLimits(std::vector<double>{0, 0, 1000001.0}));
}

TEST(JointSpace, LimitsAreInclusiveWithATolerance) {
  const JointSpace space = Space();
  const auto first_outside = [&space](std::vector<double> q) {
    const int j = space.FirstOutsideLimits(q);
    EXPECT_EQ(space.FindLimitFault(q).has_value(), j >= 0);
    return j;
  };
  EXPECT_EQ(first_outside({0, -2, 0}), -1);
  EXPECT_EQ(first_outside({0.4, 2, kPi}), -1);
  EXPECT_EQ(first_outside({0.4, 2, 100}), -1);  // Continuous joints have no limits.
  EXPECT_EQ(first_outside({-0.9e-6, 2 + 0.9e-6, 0}), -1);
  EXPECT_EQ(first_outside({-1.1e-6, 0, 0}), 0);
  EXPECT_EQ(first_outside({0.4, 2 + 1.1e-6, 0}), 1);
  EXPECT_EQ(first_outside({0, -3, NAN}), 1);
  EXPECT_EQ(first_outside({0, 0, NAN}), 2);
  EXPECT_EQ(first_outside({0, 0, std::numeric_limits<double>::infinity()}), 2);
  EXPECT_EQ(first_outside({NAN, 0, 0}), 0);
}

}  // namespace
}  // namespace planbench
