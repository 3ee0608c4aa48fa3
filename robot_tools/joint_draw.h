#pragma once

#include <random>
#include <utility>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// The joints that can be drawn: neither fixed, planar nor floating, and following none.
std::vector<int> JointsToDraw(const RobotModel& model);

/// Where a joint of one position is drawn, rad or m: within its limits, a continuous one within
/// [-pi, pi].
std::pair<double, double> DrawRange(const Joint& joint);

/// Draws the positions of joints (indices) uniformly into full positions.
void DrawPositions(const RobotModel& model, const std::vector<int>& joints, std::mt19937_64* random,
                   std::vector<double>* full_positions);

}  // namespace planbench
