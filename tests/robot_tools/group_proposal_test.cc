#include "robot_tools/group_proposal.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "robot_model/robot_folder.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;

// A URDF from joints; links are named as the joints' ends are.
class Tree {
 public:
  Tree& Joint(const std::string& type, const std::string& parent, const std::string& child,
              const std::string& more = "<limit lower='-1' upper='1' velocity='1' effort='1'/>") {
    links_ += fmt::format("<link name='{}'/>", child);
    joints_ += fmt::format(
        "<joint name='{0}_joint' type='{1}'><parent link='{2}'/><child link='{0}'/>{3}</joint>",
        child, type, parent, more);
    return *this;
  }
  Tree& Chain(const std::string& parent, const std::string& prefix, int count) {
    std::string from = parent;
    for (int i = 1; i <= count; ++i) {
      Joint("revolute", from, fmt::format("{}{}", prefix, i));
      from = fmt::format("{}{}", prefix, i);
    }
    return *this;
  }
  RobotModel Model() const {
    return RobotModel::FromUrdf(
        "<robot name='tree'><link name='base'/>" + links_ + joints_ + "</robot>", "tree.urdf");
  }

 private:
  std::string links_;
  std::string joints_;
};

struct Proposal {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> joints;
  std::vector<std::vector<std::string>> tips;
};

Proposal Propose(const RobotModel& model) {
  Proposal proposal;
  for (const PlanningGroup& group : ProposeGroups(model)) {
    proposal.names.push_back(group.name);
    auto& joints = proposal.joints.emplace_back();
    for (const JointSpace::Joint& joint : group.space.joints()) joints.push_back(joint.name);
    auto& tips = proposal.tips.emplace_back();
    tips.push_back(model.links()[static_cast<std::size_t>(group.tip_link)].name);
    for (const int tip : group.more_tips) {
      tips.push_back(model.links()[static_cast<std::size_t>(tip)].name);
    }
  }
  return proposal;
}

TEST(ProposeGroups, AnArmEndsBeforeItsFingers) {
  Tree tree;
  tree.Joint("fixed", "base", "plate").Chain("plate", "a", 4).Joint("fixed", "a4", "flange");
  tree.Joint("fixed", "flange", "palm")
      .Joint("revolute", "palm", "finger")
      .Joint("revolute", "palm", "thumb");
  const Proposal proposal = Propose(tree.Model());
  EXPECT_THAT(proposal.names, ElementsAre("arm"));
  EXPECT_THAT(proposal.joints[0], ElementsAre("a1_joint", "a2_joint", "a3_joint", "a4_joint"));
  EXPECT_THAT(proposal.tips[0], ElementsAre("palm"));
}

TEST(ProposeGroups, WhatOthersFollowAndShortSlidesAreAHand) {
  constexpr char kShort[] = "<limit lower='0' upper='0.04' velocity='1' effort='1'/>";
  Tree leader;
  leader.Chain("base", "a", 3).Joint("revolute", "a3", "knuckle");
  leader.Joint("revolute", "knuckle", "tip",
               "<limit lower='-1' upper='1' velocity='1' effort='1'/><mimic "
               "joint='knuckle_joint'/>");
  EXPECT_THAT(Propose(leader.Model()).joints[0], ElementsAre("a1_joint", "a2_joint", "a3_joint"));
  EXPECT_THAT(Propose(leader.Model()).tips[0], ElementsAre("a3"));
  Tree slide;
  slide.Chain("base", "a", 3).Joint("prismatic", "a3", "jaw", kShort);
  EXPECT_THAT(Propose(slide.Model()).joints[0], ElementsAre("a1_joint", "a2_joint", "a3_joint"));
  Tree gantry;  // Long slides are an arm's.
  gantry.Chain("base", "a", 3).Joint("prismatic", "a3", "quill");
  EXPECT_EQ(Propose(gantry.Model()).joints[0].size(), 4u);
}

TEST(ProposeGroups, ArmsOfATorsoAreGroupsAndOneOfAll) {
  Tree tree;
  tree.Joint("prismatic", "base", "torso").Chain("torso", "l", 3).Chain("torso", "head", 2);
  tree.Chain("torso", "r", 4).Joint("continuous", "base", "wheel");
  const Proposal proposal = Propose(tree.Model());
  EXPECT_THAT(proposal.names, ElementsAre("arm_l3", "arm_r4", "all_arms"));
  EXPECT_THAT(proposal.joints[0], ElementsAre("l1_joint", "l2_joint", "l3_joint"));
  EXPECT_THAT(proposal.joints[2], ElementsAre("torso_joint", "l1_joint", "l2_joint", "l3_joint",
                                              "r1_joint", "r2_joint", "r3_joint", "r4_joint"));
  EXPECT_THAT(proposal.tips[2], ElementsAre("l3", "r4"));
}

TEST(ProposeGroups, ShortRobotsHaveArmsToo) {
  EXPECT_THAT(Propose(Tree().Chain("base", "a", 1).Model()).joints[0], ElementsAre("a1_joint"));
  EXPECT_THAT(Propose(Tree().Chain("base", "a", 2).Model()).joints[0],
              ElementsAre("a1_joint", "a2_joint"));
  Tree two;
  two.Joint("fixed", "base", "table").Chain("table", "l", 1).Chain("table", "r", 1);
  EXPECT_THAT(Propose(two.Model()).names, ElementsAre("arm_l1", "arm_r1", "all_arms"));
}

TEST(ProposeGroups, TheFetchGetsTheGroupThatItsFolderHas) {
  const Robot fetch = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch");
  const std::vector<PlanningGroup> groups = ProposeGroups(fetch.model);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].joints, fetch.groups[0].joints);
  EXPECT_EQ(groups[0].tip_link, fetch.groups[0].tip_link);
}

TEST(ProposeGroups, ARobotThatCannotMoveIsRefused) {
  ExpectInputError([] { Propose(Tree().Joint("fixed", "base", "post").Model()); },
                   {"'tree'", "no joint"});
  ExpectInputError([] { Propose(Tree().Joint("floating", "base", "ball").Model()); },
                   {"'tree'", "no joint"});
}

}  // namespace
}  // namespace planbench
