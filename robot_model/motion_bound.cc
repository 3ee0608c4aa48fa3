#include "robot_model/motion_bound.h"

#include <algorithm>
#include <cmath>

#include "robot_model/swept_region.h"

namespace planbench {

MotionBound::MotionBound(const RobotModel& model, const PlanningGroup& group,
                         std::span<const double> base_positions, std::span<const LinkSphere> balls)
    : reach_(group.joints.size(), 0.0) {
  std::vector<int> group_index(model.joints().size(), -1);
  for (std::size_t i = 0; i < group.joints.size(); ++i) {
    group_index[static_cast<std::size_t>(group.joints[i])] = static_cast<int>(i);
  }
  for (const LinkSphere& ball : balls) {
    SweptRegion region(ball.p_LS);
    int link = ball.link;
    while (model.links()[static_cast<std::size_t>(link)].parent_joint >= 0) {
      const auto index =
          static_cast<std::size_t>(model.links()[static_cast<std::size_t>(link)].parent_joint);
      const Joint& joint = model.joints()[index];
      if (group_index[index] < 0) {
        const double held = joint.position_index < 0
                                ? 0.0
                                : base_positions[static_cast<std::size_t>(joint.position_index)];
        region.Transform(joint.X_PJ * JointMotion(joint, held));
      } else {
        double& reach = reach_[static_cast<std::size_t>(group_index[index])];
        if (joint.type == JointType::kPrismatic) {
          reach = 1;
          region.Slide(joint.axis_J, joint.lower - JointSpace::kLimitTolerance,
                       joint.upper + JointSpace::kLimitTolerance);
        } else {
          // The axis is the same line in the child link's frame and the joint's.
          const double distance = region.Revolve(Eigen::Vector3d::Zero(), joint.axis_J);
          reach = std::max(reach, distance + ball.radius);
        }
        region.Transform(joint.X_PJ);
      }
      link = joint.parent_link;
    }
  }
}

double MotionBound::Between(const JointSpace& space, std::span<const double> from,
                            std::span<const double> to) const {
  double bound = 0;
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    bound += std::abs(space.Difference(j, from[i], to[i])) * reach_[i];
  }
  return bound;
}

}  // namespace planbench
