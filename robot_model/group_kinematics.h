#pragma once

#include <span>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Forward kinematics of a planning group (and the joints that follow its own) with every other
/// joint held: recomputes only the links the group moves. One instance a thread; refers to the
/// model and group, which must outlive it.
class GroupKinematics {
 public:
  /// `base_positions`: full positions; those of the group's joints are placeholders.
  GroupKinematics(const RobotModel& model, const PlanningGroup& group,
                  std::span<const double> base_positions);

  const RobotModel& model() const { return *model_; }
  const PlanningGroup& group() const { return *group_; }

  /// Moves the group to q (n joints, group order, rad or m).
  void Update(std::span<const double> q);
  /// Pose of a link in the base frame at the last q.
  const Eigen::Isometry3d& X_BL(int link) const { return X_BL_[static_cast<std::size_t>(link)]; }
  /// True if the group's joints move the link relative to the base.
  bool Moves(int link) const { return moved_by_group_[static_cast<std::size_t>(link)] != 0; }
  /// True if some group joint lies between the two links, so that their relative pose varies.
  bool MoveRelatively(int link_a, int link_b) const;

 private:
  struct Step {
    int joint;
    int group_index;    // Its own or its leader's; -1: held joint
    double multiplier;  // It is at multiplier * q + offset.
    double offset;
    Eigen::Isometry3d X_PC;  // Child link in parent link; of group joints set by Update.
  };
  const RobotModel* model_;
  const PlanningGroup* group_;
  std::vector<Eigen::Isometry3d> X_BL_;
  std::vector<unsigned char> moved_by_group_;
  // Per link: the last joint on its path from the root that moves, -1 if there is none.
  std::vector<int> nearest_group_joint_;
  std::vector<Step> steps_;  // Joints whose child links move, parents first.
};

}  // namespace planbench
