#pragma once

#include "planning/goal_box.h"

namespace planbench {

inline GoalBox PointGoal(const Configuration& q) { return {q, q, q}; }

}  // namespace planbench
