#pragma once

#include <algorithm>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// A configuration of the group, uniform within its limits.
inline std::vector<double> RandomConfiguration(const JointSpace& space, std::mt19937* random) {
  std::vector<double> q;
  for (const JointSpace::Joint& joint : space.joints()) {
    q.push_back(std::uniform_real_distribution<double>(joint.lower, joint.upper)(*random));
  }
  return q;
}

/// Full positions, uniform within the limits; continuous joints in [-pi, pi], poses of planar and
/// floating ones at most 1 m away.
inline std::vector<double> RandomPositions(const RobotModel& model, std::mt19937* random) {
  std::vector<double> positions(static_cast<std::size_t>(model.num_positions()));
  for (const Joint& joint : model.joints()) {
    if (joint.position_index < 0 || joint.leader >= 0) continue;
    const auto index = static_cast<std::size_t>(joint.position_index);
    if (NumPositions(joint.type) > 1) {
      for (std::size_t k = 0; k < 7; ++k) {
        positions[index + k] = std::uniform_real_distribution<double>(-1, 1)(*random);
      }
      continue;
    }
    positions[index] = std::uniform_real_distribution<double>(
        std::max(joint.lower, -std::numbers::pi), std::min(joint.upper, std::numbers::pi))(*random);
  }
  return positions;
}

/// `positions` with the group's joints at q.
inline std::vector<double> WithGroupAt(const RobotModel& model, const PlanningGroup& group,
                                       std::vector<double> positions, std::span<const double> q) {
  for (std::size_t i = 0; i < group.joints.size(); ++i) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(group.joints[i])];
    positions[static_cast<std::size_t>(joint.position_index)] = q[i];
  }
  return positions;
}

}  // namespace planbench
