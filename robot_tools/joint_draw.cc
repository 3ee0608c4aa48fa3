#include "robot_tools/joint_draw.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "common/random.h"

namespace planbench {

std::vector<int> JointsToDraw(const RobotModel& model) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const Joint& joint = model.joints()[j];
    if (NumPositions(joint.type) == 1 && joint.leader < 0) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

std::pair<double, double> DrawRange(const Joint& joint) {
  if (std::isfinite(joint.lower)) return {joint.lower, joint.upper};
  return {-std::numbers::pi, std::numbers::pi};
}

void DrawPositions(const RobotModel& model, const std::vector<int>& joints, std::mt19937_64* random,
                   std::vector<double>* full_positions) {
  for (const int index : joints) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    const std::pair<double, double> range = DrawRange(joint);
    (*full_positions)[static_cast<std::size_t>(joint.position_index)] =
        range.first + UniformFraction(random) * (range.second - range.first);
  }
}

}  // namespace planbench
