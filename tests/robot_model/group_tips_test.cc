#include "robot_model/group_tips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "robot_model/srdf.h"

namespace planbench {
namespace {

// A trunk of one joint with a left and a right arm of three, a head of one, a hand on the left and
// a tool on the right.
RobotModel Human() {
  std::string urdf = "<robot name='human'><link name='base'/>";
  const auto add = [&](const std::string& joint, const std::string& parent) {
    urdf += "<link name='" + joint + "_link'/><joint name='" + joint +
            "' type='continuous'><parent link='" + parent + "'/><child link='" + joint +
            "_link'/></joint>";
  };
  add("trunk", "base");
  for (const std::string side : {"l", "r"}) {
    add(side + "1", "trunk_link");
    add(side + "2", side + "1_link");
    add(side + "3", side + "2_link");
  }
  add("nod", "trunk_link");
  add("thumb", "l3_link");
  urdf +=
      "<link name='tool'/><joint name='grasp' type='fixed'><parent link='r3_link'/>"
      "<child link='tool'/></joint>";
  return RobotModel::FromUrdf(urdf + "</robot>", "human.urdf");
}

struct TipsCase {
  std::string name;
  std::string elements;  // Those of the group "all" among them.
  std::vector<std::string> tips;
};
void PrintTo(const TipsCase& group, std::ostream* out) { *out << group.name; }

class GroupTipsTest : public testing::TestWithParam<TipsCase> {};

TEST_P(GroupTipsTest, AreThoseOfEveryBranch) {
  const RobotModel model = Human();
  const Srdf srdf = ParseSrdf(
      "<robot name='human'><group name='left'><chain base_link='trunk_link'"
      " tip_link='l3_link'/></group><group name='right'><joint name='r1'/>"
      "<joint name='r2'/><joint name='r3'/></group><group name='trunk'>"
      "<chain base_link='base' tip_link='trunk_link'/></group>" +
          GetParam().elements + "</robot>",
      "human.srdf", model);
  const auto all = std::find_if(srdf.groups.begin(), srdf.groups.end(),
                                [](const PlanningGroup& group) { return group.name == "all"; });
  ASSERT_NE(all, srdf.groups.end());
  std::vector<std::string> tips;
  for (const int tip : all->tips()) {
    tips.push_back(model.links()[static_cast<std::size_t>(tip)].name);
  }
  EXPECT_EQ(tips, GetParam().tips);
}

INSTANTIATE_TEST_SUITE_P(
    Srdf, GroupTipsTest,
    testing::Values(
        TipsCase{"chain_and_joint_groups",
                 "<group name='all'><group name='left'/><group name='right'/></group>",
                 {"l3_link", "r3_link"}},
        TipsCase{"chain_group_and_joints",
                 "<group name='all'><joint name='r1'/><joint name='r2'/><group name='left'/>"
                 "</group>",
                 {"l3_link", "r2_link"}},
        TipsCase{"arms_on_a_trunk",
                 "<group name='all'><group name='trunk'/><group name='right'/><joint name='l1'/>"
                 "<joint name='l2'/><joint name='l3'/><joint name='nod'/></group>",
                 {"l3_link", "r3_link"}},
        TipsCase{"a_finger_behind_the_tip",
                 "<group name='all'><group name='left'/><joint name='thumb'/></group>",
                 {"l3_link"}},
        TipsCase{"a_hand_of_many_joints",
                 "<end_effector name='claw' group='right' parent_link='trunk_link'/>"
                 "<group name='all'><group name='trunk'/><group name='right'/></group>",
                 {"trunk_link"}},
        TipsCase{"a_chain_twice",
                 "<group name='all'><group name='left'/><chain base_link='base'"
                 " tip_link='l3_link'/></group>",
                 {"l3_link"}},
        TipsCase{"chains_to_the_arms_end_and_to_a_tool_fixed_to_it",
                 "<group name='all'><chain base_link='trunk_link' tip_link='r3_link'/>"
                 "<chain base_link='trunk_link' tip_link='tool'/></group>",
                 {"r3_link"}},
        TipsCase{"a_chain_that_moves_nothing",
                 "<group name='all'><chain base_link='base' tip_link='base'/><joint name='nod'/>"
                 "</group>",
                 {"nod_link"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace planbench
