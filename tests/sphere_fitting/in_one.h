#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "collision/balls.h"

namespace planbench {

inline bool InOne(const std::vector<Ball>& balls, const Eigen::Vector3d& p) {
  return std::any_of(balls.begin(), balls.end(),
                     [&](const Ball& ball) { return (p - ball.center).norm() <= ball.radius; });
}

}  // namespace planbench
