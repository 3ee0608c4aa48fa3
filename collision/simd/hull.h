#pragma once

#include <Eigen/Core>
#include <vector>

namespace planbench {

/// A convex hull of few points that stands for that of many.
struct Hull {
  std::vector<Eigen::Vector3d> points;  ///< Some of the many, m.
  double slack = 0;  ///< None of the many is further outside of the hull of the few, m.
};

/// Of at least one point; at most `most` (at least one) are kept, those that reach furthest.
Hull MakeHull(std::vector<Eigen::Vector3d> points, std::size_t most);

/// The longest distance between two points, m; 0 of none.
double Diameter(const std::vector<Eigen::Vector3d>& points);

}  // namespace planbench
