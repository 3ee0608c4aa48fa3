#pragma once

#include <Eigen/Core>

namespace planbench {

struct Ball {
  Eigen::Vector3d center;  ///< m
  double radius;           ///< m
};

}  // namespace planbench
