#include "planner_ara/arms.h"

#include <algorithm>
#include <cstddef>

namespace planbench {
namespace {

// Whether a joint is `other`, or moves it. Negative numbers are no joint.
bool Moves(const RobotModel& model, int joint, int other) {
  while (other >= 0 && other != joint) {
    const int link = model.joints()[static_cast<std::size_t>(other)].parent_link;
    other = model.links()[static_cast<std::size_t>(link)].parent_joint;
  }
  return other == joint;
}

}  // namespace

Arms OneArm(const PlanningGroup& group) {
  return {1, std::vector<int>(group.joints.size(), 0), std::vector<int>(group.tips().size(), 0)};
}

Arms ArmsOf(const RobotModel& model, const PlanningGroup& group) {
  constexpr int kShared = -1;
  const std::vector<int> tips = group.tips();
  Arms arms{0, {}, std::vector<int>(tips.size(), kShared)};
  for (const int joint : group.joints) {
    const auto moves = [&](int tip) {
      return Moves(model, joint, model.links()[static_cast<std::size_t>(tip)].parent_joint);
    };
    int& arm = arms.of_joint.emplace_back(kShared);
    if (std::count_if(tips.begin(), tips.end(), moves) != 1) continue;
    const auto tip = std::find_if(tips.begin(), tips.end(), moves) - tips.begin();
    int& of_tip = arms.of_tip[static_cast<std::size_t>(tip)];
    if (of_tip == kShared) of_tip = arms.num++;
    arm = of_tip;
  }
  if (arms.num < 2) return OneArm(group);
  std::replace(arms.of_joint.begin(), arms.of_joint.end(), kShared, arms.num);
  std::replace(arms.of_tip.begin(), arms.of_tip.end(), kShared, arms.num);
  return arms;
}

std::vector<std::vector<char>> JointsOnOneArm(const RobotModel& model, const PlanningGroup& group) {
  std::vector<std::vector<char>> on_one_arm;
  for (const int a : group.joints) {
    std::vector<char>& row = on_one_arm.emplace_back();
    for (const int b : group.joints) row.push_back(Moves(model, a, b) || Moves(model, b, a));
  }
  return on_one_arm;
}

}  // namespace planbench
