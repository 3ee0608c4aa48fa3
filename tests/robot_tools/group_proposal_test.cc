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
  static inline const std::string kLimit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";
  static std::string Origin(double x) { return fmt::format("<origin xyz='{} 0 0'/>", x); }

  Tree& Joint(const std::string& type, const std::string& parent, const std::string& child,
              const std::string& more = kLimit) {
    links_ += fmt::format("<link name='{}'/>", child);
    joints_ += fmt::format(
        "<joint name='{0}_joint' type='{1}'><parent link='{2}'/><child link='{0}'/>{3}</joint>",
        child, type, parent, more);
    return *this;
  }
  /// `length`: of a link along x, m.
  Tree& Chain(const std::string& parent, const std::string& prefix, int count, double length = 0) {
    std::string from = parent;
    for (int i = 1; i <= count; ++i) {
      Joint("revolute", from, fmt::format("{}{}", prefix, i), kLimit + Origin(length));
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

Proposal Propose(const RobotModel& model, std::vector<std::string>* notes = nullptr) {
  Proposal proposal;
  for (const PlanningGroup& group : ProposeGroups(model, notes)) {
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

constexpr char kShortSlide[] = "<limit lower='0' upper='0.04' velocity='1' effort='1'/>";

TEST(ProposeGroups, WhatOthersFollowBesideItAndShortSlidesBesideOthersAreAHand) {
  Tree leader;
  leader.Chain("base", "a", 3).Joint("revolute", "a3", "thumb");
  leader.Joint("revolute", "a3", "finger", Tree::kLimit + "<mimic joint='thumb_joint'/>");
  EXPECT_THAT(Propose(leader.Model()).joints[0], ElementsAre("a1_joint", "a2_joint", "a3_joint"));
  EXPECT_THAT(Propose(leader.Model()).tips[0], ElementsAre("a3"));
  Tree fingers;  // All of them curl as the first does.
  fingers.Chain("base", "a", 3).Chain("a3", "f", 2);
  fingers.Joint("revolute", "a3", "g1", Tree::kLimit + "<mimic joint='f1_joint'/>");
  fingers.Joint("revolute", "g1", "g2", Tree::kLimit + "<mimic joint='f2_joint'/>");
  EXPECT_THAT(Propose(fingers.Model()).tips[0], ElementsAre("a3"));
  Tree slide;
  slide.Chain("base", "a", 3).Joint("prismatic", "a3", "jaw", kShortSlide);
  slide.Joint("fixed", "a3", "other_jaw");
  EXPECT_THAT(Propose(slide.Model()).joints[0], ElementsAre("a1_joint", "a2_joint", "a3_joint"));
}

TEST(ProposeGroups, LinkageAndSlidesOfAnArmAreItsOwn) {
  Tree wrist;  // Kept level by the elbow.
  wrist.Chain("base", "a", 4);
  wrist.Joint("revolute", "a4", "wrist", Tree::kLimit + "<mimic joint='a4_joint'/>");
  EXPECT_EQ(Propose(wrist.Model()).joints[0].size(), 4u);
  EXPECT_THAT(Propose(wrist.Model()).tips[0], ElementsAre("wrist"));
  Tree quill;
  quill.Chain("base", "a", 3).Joint("prismatic", "a3", "quill", kShortSlide);
  EXPECT_EQ(Propose(quill.Model()).joints[0].size(), 4u);
  Tree gantry;  // Long slides are, too, whatever is beside them.
  gantry.Chain("base", "a", 3).Joint("prismatic", "a3", "z").Joint("fixed", "a3", "camera");
  EXPECT_EQ(Propose(gantry.Model()).joints[0].size(), 4u);
}

TEST(ProposeGroups, AnArmKeepsThreeJoints) {
  Tree tree;
  tree.Chain("base", "a", 2).Joint("prismatic", "a2", "z", kShortSlide);
  tree.Joint("fixed", "a2", "camera");
  EXPECT_THAT(Propose(tree.Model()).joints[0], ElementsAre("a1_joint", "a2_joint", "z_joint"));
}

TEST(ProposeGroups, AHandOfManyJointsIsNoneOfTheArms) {
  Tree tree;
  tree.Chain("base", "a", 6, 0.2).Joint("fixed", "a6", "palm");
  tree.Chain("palm", "f", 3, 0.04).Chain("palm", "g", 3, 0.04).Chain("palm", "thumb", 4, 0.03);
  const Proposal proposal = Propose(tree.Model());
  EXPECT_THAT(proposal.names, ElementsAre("arm"));
  EXPECT_EQ(proposal.joints[0].size(), 6u);
  EXPECT_THAT(proposal.tips[0], ElementsAre("palm"));
  Tree one_long;  // One finger alone has as many joints as an arm.
  one_long.Chain("base", "a", 6, 0.2).Chain("a6", "thumb", 3, 0.04).Chain("a6", "f", 1, 0.04);
  EXPECT_THAT(Propose(one_long.Model()).tips[0], ElementsAre("a6"));
}

TEST(ProposeGroups, AWristBesideACamerasJointIsTheArms) {
  Tree tree;
  tree.Chain("base", "a", 4, 0.3).Chain("a4", "camera", 1, 0.02).Chain("a4", "w", 3, 0.05);
  const Proposal proposal = Propose(tree.Model());
  EXPECT_THAT(proposal.names, ElementsAre("arm"));
  EXPECT_EQ(proposal.joints[0].size(), 7u);
  EXPECT_THAT(proposal.tips[0], ElementsAre("w3"));
}

TEST(ProposeGroups, ShortArmsOfALongGantryAreGroupsBesideIt) {
  Tree tree;
  tree.Chain("base", "axis", 3, 2).Chain("axis3", "l", 3, 0.2).Chain("axis3", "r", 3, 0.2);
  EXPECT_THAT(Propose(tree.Model()).names,
              ElementsAre("arm_axis3", "arm_l3", "arm_r3", "all_arms"));
}

TEST(ProposeGroups, ATipIsMovedByTheArmAlone) {
  Tree tree;  // A pointer that a wheel elsewhere turns.
  tree.Joint("revolute", "base", "wheel").Chain("base", "a", 3);
  tree.Joint("revolute", "a3", "pointer", Tree::kLimit + "<mimic joint='wheel_joint'/>");
  EXPECT_THAT(Propose(tree.Model()).tips[0], ElementsAre("a3"));
}

TEST(ProposeGroups, ALongTrunkIsAGroupBesideTheArmsOnIt) {
  Tree torso;  // More joints on each arm than beneath.
  torso.Chain("base", "waist", 3, 0.2).Chain("waist3", "l", 7, 0.02).Chain("waist3", "r", 7, 0.02);
  torso.Chain("waist3", "head", 2);
  const Proposal proposal = Propose(torso.Model());
  EXPECT_THAT(proposal.names, ElementsAre("arm_waist3", "arm_l7", "arm_r7", "all_arms"));
  EXPECT_THAT(proposal.joints[0], ElementsAre("waist1_joint", "waist2_joint", "waist3_joint"));
  EXPECT_EQ(proposal.joints[1].size(), 7u);
  EXPECT_EQ(proposal.joints[3].size(), 17u);
  EXPECT_THAT(proposal.tips[3], ElementsAre("l7", "r7"));
  Tree spine;  // Arms as long as it.
  spine.Chain("base", "s", 5, 0.05).Chain("s5", "l", 4, 0.1).Chain("s5", "r", 4, 0.1);
  EXPECT_THAT(Propose(spine.Model()).names, ElementsAre("arm_s5", "arm_l4", "arm_r4", "all_arms"));
}

TEST(ProposeGroups, AJointThatNoGroupCanHaveIsLeftOutAndNamed) {
  Tree tree;
  tree.Joint("continuous", "base", "turret", "").Chain("turret", "a", 3);
  tree.Joint("continuous", "a3", "drill", "<mimic joint='turret_joint' multiplier='0.5'/>");
  std::vector<std::string> notes;
  EXPECT_THAT(Propose(tree.Model(), &notes).joints[0],
              ElementsAre("a1_joint", "a2_joint", "a3_joint"));
  EXPECT_THAT(notes, ElementsAre(testing::StartsWith("tree.urdf:1: joint 'turret_joint': is left "
                                                     "out: it is continuous, but joint "
                                                     "'drill_joint'")));
  Tree alone;
  alone.Joint("continuous", "base", "a", "");
  alone.Joint("continuous", "a", "b", "<mimic joint='a_joint' multiplier='0.5'/>");
  ExpectInputError([&] { Propose(alone.Model()); },
                   {"'tree'", "no joint", "tree.urdf:1: joint 'a_joint'", "'b_joint'"});
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
