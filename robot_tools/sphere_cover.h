#pragma once

#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// Spheres that enclose a shape: every point of it is in one of them.
struct SphereCover {
  struct Ball {
    Eigen::Vector3d center;  ///< In the shape's frame, m.
    double radius = 0;       ///< m
  };
  std::vector<Ball> balls;
  double overshoot_m = 0;  ///< No point of a ball is further than this from the shape.
};

/// Covers a sphere (by itself), a box or a cylinder. Takes as few spheres as reach no further than
/// `overshoot_m` beyond the shape, but no more than `most`. Throws InputError for other shapes.
SphereCover CoverWithSpheres(const Shape& shape, double overshoot_m, int most);

}  // namespace planbench
