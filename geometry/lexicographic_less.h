#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace planbench {

/// Orders points by x, then y, then z.
inline bool LexicographicLess(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace planbench
