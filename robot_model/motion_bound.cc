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
  std::vector<double> speeds(model.joints().size(), 1.0);  // Of a joint per its group index's.
  for (const PlanningGroup::Follower& follower : group.followers) {
    const auto index = static_cast<std::size_t>(follower.joint);
    group_index[index] = follower.group_index;
    speeds[index] = std::abs(model.joints()[index].multiplier);
  }
  std::vector<double> ball_reach(reach_.size());
  for (const LinkSphere& ball : balls) {
    SweptRegion region(ball.p_LS);
    std::fill(ball_reach.begin(), ball_reach.end(), 0.0);
    int link = ball.link;
    while (model.links()[static_cast<std::size_t>(link)].parent_joint >= 0) {
      const auto index =
          static_cast<std::size_t>(model.links()[static_cast<std::size_t>(link)].parent_joint);
      const Joint& joint = model.joints()[index];
      if (group_index[index] < 0) {
        region.Transform(joint.X_PJ * JointMotion(joint, base_positions));
      } else {
        // A joint and its followers move the ball together.
        const double speed = speeds[index];
        double& reach = ball_reach[static_cast<std::size_t>(group_index[index])];
        if (joint.type == JointType::kPrismatic) {
          reach += speed;
          const double tolerance = speed * JointSpace::kLimitTolerance;
          region.Slide(joint.axis_J, joint.lower - tolerance, joint.upper + tolerance);
        } else {
          // The axis is the same line in the child link's frame and the joint's.
          const double distance = region.Revolve(Eigen::Vector3d::Zero(), joint.axis_J);
          reach += speed * (distance + ball.radius);
        }
        region.Transform(joint.X_PJ);
      }
      link = joint.parent_link;
    }
    for (std::size_t i = 0; i < reach_.size(); ++i) reach_[i] = std::max(reach_[i], ball_reach[i]);
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
