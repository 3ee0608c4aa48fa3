#include "robot_model/group_tips.h"

#include <algorithm>
#include <cstddef>

namespace planbench {
namespace {

constexpr int kLeastJointsOfAnArm = 3;

class Branches {
 public:
  Branches(const RobotModel& model, const std::set<int>& joints, const std::set<int>& hand_joints)
      : model_(model), joints_(joints), hand_joints_(hand_joints) {}

  bool Move(int link) const {
    const std::vector<int> path = JointsToRoot(model_, link);
    return std::any_of(path.begin(), path.end(), [&](int joint) {
      return joints_.contains(joint) || joints_.contains(At(joint).leader);
    });
  }

  // Whether `link` is `inner`, or carried by it.
  bool IsBeyond(int link, int inner) const {
    const std::vector<int> path = JointsToRoot(model_, link);
    return link == inner || std::any_of(path.begin(), path.end(),
                                        [&](int joint) { return At(joint).parent_link == inner; });
  }

  // Whether the joints between two links, of which one carries the other, are an arm's and not
  // those of a hand.
  bool ArmLeadsOn(int from, int to) const {
    if (!IsBeyond(to, from)) return false;
    int count = 0;
    for (const int joint : JointsToRoot(model_, to)) {
      if (At(joint).child_link == from) break;
      if (!joints_.contains(joint)) continue;
      if (hand_joints_.contains(joint)) return false;
      ++count;
    }
    return count >= kLeastJointsOfAnArm;
  }

  // Child links of joints below which there is no other joint of the group.
  std::vector<int> OutermostLinks() const {
    std::set<int> has_more_below;
    for (const int joint : joints_) {
      for (const int inner : JointsToRoot(model_, At(joint).parent_link)) {
        has_more_below.insert(inner);
      }
    }
    std::vector<int> links;
    for (const int joint : joints_) {
      if (!has_more_below.contains(joint)) links.push_back(At(joint).child_link);
    }
    return links;
  }

 private:
  const Joint& At(int joint) const { return model_.joints()[static_cast<std::size_t>(joint)]; }

  const RobotModel& model_;
  const std::set<int>& joints_;
  const std::set<int>& hand_joints_;
};

}  // namespace

std::vector<int> JointsToRoot(const RobotModel& model, int link) {
  std::vector<int> joints;
  while (true) {
    const int joint = model.links()[static_cast<std::size_t>(link)].parent_joint;
    if (joint < 0) return joints;
    joints.push_back(joint);
    link = model.joints()[static_cast<std::size_t>(joint)].parent_link;
  }
}

std::vector<int> GroupTips(const RobotModel& model, const std::set<int>& joints,
                           const std::vector<int>& chain_tips, const std::set<int>& hand_joints) {
  const Branches branches(model, joints, hand_joints);
  std::vector<int> tips;
  for (const int tip : chain_tips) {
    if (branches.Move(tip)) tips.push_back(tip);
  }
  for (const int link : branches.OutermostLinks()) {
    const bool has_tip = std::any_of(tips.begin(), tips.end(), [&](int tip) {
      return branches.IsBeyond(tip, link) ||
             (branches.IsBeyond(link, tip) && !branches.ArmLeadsOn(tip, link));
    });
    if (!has_tip) tips.push_back(link);
  }
  const std::vector<int> all = tips;
  std::erase_if(tips, [&](int tip) {
    return std::any_of(all.begin(), all.end(),
                       [&](int other) { return branches.ArmLeadsOn(tip, other); });
  });
  return tips;
}

}  // namespace planbench
