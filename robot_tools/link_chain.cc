#include "robot_tools/link_chain.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace planbench {

LinkChain ChainBetween(const RobotModel& model, int link_a, int link_b) {
  LinkChain chain;
  std::array<int, 2> links = {link_a, link_b};
  while (links[0] != links[1]) {
    // Parents come before their children: the later one does not carry the other.
    const std::size_t side = links[0] > links[1] ? 0 : 1;
    const int joint = model.links()[static_cast<std::size_t>(links[side])].parent_joint;
    chain[side].push_back(joint);
    links[side] = model.joints()[static_cast<std::size_t>(joint)].parent_link;
  }
  return chain;
}

std::vector<int> JointsThatPlace(const RobotModel& model, int link_a, int link_b) {
  std::set<int> joints;
  const LinkChain chain = ChainBetween(model, link_a, link_b);
  for (const std::vector<int>& side : chain) {
    for (const int index : side) {
      const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
      if (joint.position_index >= 0) joints.insert(joint.leader >= 0 ? joint.leader : index);
    }
  }
  return {joints.begin(), joints.end()};
}

bool JointsMove(const RobotModel& model, const std::vector<int>& joints, int link_a, int link_b) {
  const std::vector<int> placing = JointsThatPlace(model, link_a, link_b);
  return std::ranges::any_of(joints,
                             [&](int joint) { return std::ranges::binary_search(placing, joint); });
}

bool AnywhereByPose(const RobotModel& model, int link_a, int link_b) {
  const std::vector<int> placing = JointsThatPlace(model, link_a, link_b);
  return std::ranges::any_of(placing, [&](int joint) {
    return NumPositions(model.joints()[static_cast<std::size_t>(joint)].type) > 1;
  });
}

}  // namespace planbench
