#pragma once

#include <optional>
#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// How close balls are to a link, or those of several links together.
struct Tightness {
  int balls = 0;
  double greatest_m = 0;  ///< No point of a ball is further from the link.
  double area_m2 = 0;     ///< Of the surface of all balls together, without what is in another.
  double area_distance_m3 = 0;  ///< Integral over it of the distance from the link.
  double balls_volume_m3 = 0;   ///< Of all balls together.
  double body_volume_m3 = 0;    ///< Of what the link encloses; 0 if that is nothing.

  /// Mean over the surface of all balls together of the distance from the link, m.
  double mean_m() const { return area_m2 > 0 ? area_distance_m3 / area_m2 : 0; }
  /// Volume of the balls by that of the link, of links that enclose something.
  std::optional<double> volume_ratio() const {
    if (body_volume_m3 == 0) return std::nullopt;
    return balls_volume_m3 / body_volume_m3;
  }
  void Add(const Tightness& other);
};

/// Means and volumes by points spread evenly, the same at every call.
Tightness MeasureTightness(const LinkBody& link, const std::vector<Ball>& balls);

}  // namespace planbench
