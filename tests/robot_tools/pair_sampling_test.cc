#include "robot_tools/pair_sampling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot_tools/joint_draw.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::Pair;

// base - a - b - c, joints along x about z, 1 m apart; `sign` is welded to the base. c folds back
// to where a is, and to the base in part of its configurations.
constexpr char kChainUrdf[] = R"(<robot name="chain">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="post"/>
  <link name="sign"/>
  <joint name="j1" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
  <joint name="j2" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-0.1" upper="0.1" velocity="1" effort="1"/></joint>
  <joint name="j3" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="f1" type="fixed"><parent link="base"/><child link="post"/></joint>
  <joint name="f2" type="fixed"><parent link="post"/><child link="sign"/></joint>
</robot>)";

class PairSamplingTest : public testing::Test {
 protected:
  int Link(const char* name) const { return model_.FindLink(name); }
  std::pair<int, int> Links(const char* a, const char* b) const {
    return std::minmax(Link(a), Link(b));
  }
  LinkSphere Ball(const char* link, double x, double radius) const {
    return {Link(link), {x, 0, 0}, radius};
  }

  Robot Chain(const std::vector<LinkSphere>& spheres) const {
    Robot robot;
    robot.model = model_;
    robot.spheres = spheres;
    return robot;
  }
  // Of all joints.
  PairSamples Sample(const Robot& robot, int samples, std::uint64_t seed = 1) const {
    return SamplePairs(robot, {JointsToDraw(model_), samples, seed});
  }

  const RobotModel model_ = RobotModel::FromUrdf(kChainUrdf, "chain.urdf");
  // c reaches a's sphere when it folds back; b's never meets the base; c's inner sphere is always
  // in a's far one.
  const std::vector<LinkSphere> spheres_ = {Ball("base", 0, 0.2), Ball("sign", 0, 0.2),
                                            Ball("a", 0.5, 0.2), Ball("b", 0.5, 0.2),
                                            Ball("c", 1.5, 0.2)};
  const Robot chain_ = Chain(spheres_);
};

TEST_F(PairSamplingTest, TellsPairsThatMeetFromThoseThatNeverDo) {
  const PairSamples samples = Sample(chain_, 2000);
  EXPECT_EQ(samples.samples, 2000);
  int a_and_c = 0;
  for (const auto& pair : samples.pairs) {
    EXPECT_FALSE(model_.Joined(pair.link_a, pair.link_b));
    EXPECT_FALSE(model_.Rigid(pair.link_a, pair.link_b));
    EXPECT_LT(pair.link_a, pair.link_b);
    if (std::pair(pair.link_a, pair.link_b) == Links("a", "c")) a_and_c = pair.contacts;
  }
  // c's sphere turns at 1.5 m about a point 1.5 m from a's sphere: it touches where the chord is
  // below 0.4 m, about 0.27 of 2 pi, half a percent off for the bend of j2.
  EXPECT_NEAR(a_and_c / 2000.0, 0.085, 0.02);
  EXPECT_THAT(samples.Never(), testing::Contains(Links("base", "b")));
  EXPECT_THAT(samples.Never(), testing::Not(testing::Contains(Links("a", "c"))));
  EXPECT_THAT(samples.Always(), testing::IsEmpty());
}

TEST_F(PairSamplingTest, OverlapByConstructionIsAlways) {
  std::vector<LinkSphere> spheres = spheres_;
  spheres.push_back(Ball("c", 0, 0.9));
  spheres.push_back(Ball("a", 1.2, 0.3));
  EXPECT_THAT(Sample(Chain(spheres), 500).Always(), ElementsAre(Links("a", "c")));
}

TEST_F(PairSamplingTest, TheSameSeedDrawsTheSame) {
  const auto counts = [&](std::uint64_t seed) {
    std::vector<int> contacts;
    for (const auto& pair : Sample(chain_, 500, seed).pairs) {
      contacts.push_back(pair.contacts);
    }
    return contacts;
  };
  EXPECT_EQ(counts(1), counts(1));
  EXPECT_NE(counts(1), counts(2));
}

TEST_F(PairSamplingTest, NamesWhatTouchesInAConfiguration) {
  std::vector<double> folded(static_cast<std::size_t>(model_.num_positions()), 0.0);
  EXPECT_THAT(PairsInContact(chain_, folded), testing::IsEmpty());
  folded[2] = 3.14159265;
  EXPECT_THAT(PairsInContact(chain_, folded), ElementsAre(Links("a", "c")));
  Robot robot = chain_;
  robot.allowed_pairs = {{Link("c"), Link("a")}};
  EXPECT_THAT(PairsInContact(robot, folded), testing::IsEmpty());
}

TEST_F(PairSamplingTest, LinksThatAJointConnectsCountIfTheyAreChecked) {
  Robot robot = Chain({Ball("b", 0.9, 0.2), Ball("c", 0.1, 0.2)});
  EXPECT_THAT(Sample(robot, 100).pairs, testing::IsEmpty());
  robot.checked_pairs = {{Link("c"), Link("b")}};
  EXPECT_THAT(Sample(robot, 100).Always(), ElementsAre(Links("b", "c")));
  robot.allowed_pairs = {{Link("b"), Link("c")}};
  EXPECT_THAT(Sample(robot, 100).pairs, testing::IsEmpty());
}

TEST_F(PairSamplingTest, FreeIsWhereNoPairThatCountsTouches) {
  const PairSamples all = Sample(chain_, 1000);
  EXPECT_GT(all.free, 800);
  EXPECT_LT(all.free, 1000);
  Robot robot = chain_;
  for (const auto& pair : all.pairs) robot.allowed_pairs.emplace_back(pair.link_b, pair.link_a);
  const PairSamples none = Sample(robot, 1000);
  EXPECT_EQ(none.free, 1000);
  EXPECT_THAT(none.pairs, testing::IsEmpty());
}

TEST_F(PairSamplingTest, MostOftenComesFirst) {
  PairSamples samples{10, 0, {{0, 1, 3}, {0, 2, 0}, {1, 2, 9}, {0, 3, 4}}};
  const std::vector<PairSamples::Pair> worst = samples.MostOften(2);
  ASSERT_EQ(worst.size(), 2u);
  EXPECT_EQ(worst[0].contacts, 9);
  EXPECT_EQ(worst[1].contacts, 4);
  EXPECT_EQ(samples.MostOften(9).size(), 3u);
}

TEST_F(PairSamplingTest, JointsThatAreNotDrawnAreHeld) {
  // c folds back by j3 alone.
  const auto draw = [&](const char* joint) {
    return SamplePairs(chain_, {{model_.FindJoint(joint)}, 300, 1});
  };
  EXPECT_EQ(draw("j1").free, 300);
  EXPECT_LT(draw("j3").free, 300);
}

TEST_F(PairSamplingTest, WhatNoDrawnJointMovesIsToldApart) {
  std::vector<LinkSphere> spheres = spheres_;
  spheres.push_back(Ball("c", 0, 0.9));
  spheres.push_back(Ball("a", 1.2, 0.3));
  const PairSamples samples = SamplePairs(Chain(spheres), {{model_.FindJoint("j1")}, 300, 1});
  EXPECT_EQ(samples.free, 0);
  EXPECT_EQ(samples.free_if_moved, 300);
  EXPECT_THAT(samples.HeldInContact(), ElementsAre(Links("a", "c")));
  EXPECT_THAT(samples.MostOften(5), testing::IsEmpty());
}

TEST(PairSampling, SamplesDoNotTellOfLinksThatAPoseJoinsInBetween) {
  Robot robot;
  robot.model = RobotModel::FromUrdf(R"(<robot name="cart">
  <link name="floor"/><link name="arm"/><link name="cart"/><link name="box"/><link name="flap"/>
  <joint name="turn" type="continuous"><parent link="floor"/><child link="arm"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="drive" type="planar"><parent link="floor"/><child link="cart"/>
    <origin xyz="3 0 0"/></joint>
  <joint name="lie" type="floating"><parent link="cart"/><child link="box"/></joint>
  <joint name="open" type="continuous"><parent link="cart"/><child link="flap"/>
    <axis xyz="0 0 1"/></joint>
</robot>)",
                                     "cart.urdf");
  const int arm = robot.model.FindLink("arm");
  const int cart = robot.model.FindLink("cart");
  const int box = robot.model.FindLink("box");
  const int flap = robot.model.FindLink("flap");
  for (const int link : {arm, cart, box, flap}) robot.spheres.push_back({link, {0, 0, 0}, 0.1});
  const PairSamples samples = SamplePairs(robot, {JointsToDraw(robot.model), 100, 1});
  // The arm never meets the others at their defaults; these are one in the other.
  EXPECT_THAT(samples.Never(), testing::IsEmpty());
  EXPECT_THAT(samples.Always(), testing::IsEmpty());
  EXPECT_THAT(samples.Anywhere(),
              testing::UnorderedElementsAre(std::minmax(arm, cart), std::minmax(arm, box),
                                            std::minmax(arm, flap), std::minmax(box, flap),
                                            std::minmax(cart, box)))
      << "all but cart and flap, which their joint keeps together";
}

}  // namespace
}  // namespace planbench
