#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "geometry/ball.h"
#include "robot_model/robot_model.h"

namespace planbench {

/// The collision spheres of a link, in its frame.
struct LinkBalls {
  std::vector<Ball> balls;
  Ball around;  ///< Encloses them.
};

/// Those of one link; without any if it has none.
LinkBalls BallsOfLink(const std::vector<LinkSphere>& spheres, int link);

/// The two spheres that are nearest to each other, and how far apart: m, negative where they
/// overlap.
struct LeastGap {
  double gap_m = 0;
  std::size_t a = 0;  ///< Index of the ball.
  std::size_t b = 0;
};

/// Of links that have spheres, with link b's frame at pose X_AB in link a's.
LeastGap FindLeastGap(const LinkBalls& link_a, const LinkBalls& link_b,
                      const Eigen::Isometry3d& X_AB);

/// Whether spheres of the two touch.
bool BallsTouch(const LinkBalls& link_a, const LinkBalls& link_b, const Eigen::Isometry3d& X_AB);

}  // namespace planbench
