#pragma once

#include <Eigen/Core>
#include <vector>

#include "sphere_fitting/link_body.h"

namespace planbench {

/// Points that stand for a body while spheres are fitted to it; what is proven does not rest on
/// them. In the link's frame, m.
struct BodySamples {
  std::vector<Eigen::Vector3d> surface;  ///< Spread evenly over all triangles of the hulls.
  std::vector<Eigen::Vector3d> inside;   ///< On a grid, within meshes, boxes and cylinders.
  double spacing_m = 0;                  ///< Of those on the surface, about.
};

/// About that many of each kind.
BodySamples SampleBody(const LinkBody& body, int on_surface, int inside);

}  // namespace planbench
