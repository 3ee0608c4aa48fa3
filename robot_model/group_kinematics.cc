#include "robot_model/group_kinematics.h"

namespace planbench {

GroupKinematics::GroupKinematics(const RobotModel& model, const PlanningGroup& group,
                                 std::span<const double> base_positions)
    : model_(&model), group_(&group), X_BL_(ComputeLinkPoses(model, base_positions)) {
  const auto num_links = static_cast<std::size_t>(model.num_links());
  moved_by_group_.assign(num_links, 0);
  nearest_group_joint_.assign(num_links, -1);

  std::vector<int> group_index(model.joints().size(), -1);
  std::vector<unsigned char> follows(model.joints().size(), 0);
  for (std::size_t i = 0; i < group.joints.size(); ++i) {
    group_index[static_cast<std::size_t>(group.joints[i])] = static_cast<int>(i);
  }
  for (const PlanningGroup::Follower& follower : group.followers) {
    group_index[static_cast<std::size_t>(follower.joint)] = follower.group_index;
    follows[static_cast<std::size_t>(follower.joint)] = 1;
  }
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const Joint& joint = model.joints()[j];
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    const auto child = static_cast<std::size_t>(joint.child_link);
    const bool in_group = group_index[j] >= 0;
    nearest_group_joint_[child] = in_group ? static_cast<int>(j) : nearest_group_joint_[parent];
    if (!in_group && moved_by_group_[parent] == 0) continue;
    moved_by_group_[child] = 1;
    steps_.push_back({.joint = static_cast<int>(j),
                      .group_index = group_index[j],
                      .multiplier = follows[j] != 0 ? joint.multiplier : 1,
                      .offset = follows[j] != 0 ? joint.offset : 0,
                      .X_PC = joint.X_PJ * JointMotion(joint, base_positions)});
  }
}

void GroupKinematics::Update(std::span<const double> q) {
  for (Step& step : steps_) {
    const Joint& joint = model_->joints()[static_cast<std::size_t>(step.joint)];
    if (step.group_index >= 0) {
      const double position = q[static_cast<std::size_t>(step.group_index)];
      step.X_PC = joint.X_PJ * JointMotion(joint, step.multiplier * position + step.offset);
    }
    X_BL_[static_cast<std::size_t>(joint.child_link)] =
        X_BL_[static_cast<std::size_t>(joint.parent_link)] * step.X_PC;
  }
}

bool GroupKinematics::MoveRelatively(int link_a, int link_b) const {
  return nearest_group_joint_[static_cast<std::size_t>(link_a)] !=
         nearest_group_joint_[static_cast<std::size_t>(link_b)];
}

}  // namespace planbench
