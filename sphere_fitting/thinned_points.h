#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace planbench {

/// Points, of those that share a cell of a grid the first.
class ThinnedPoints {
 public:
  /// Edge length of a cell, m.
  explicit ThinnedPoints(double cell_m) : cell_m_(cell_m) {}

  void Add(const Eigen::Vector3d& point) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<std::int64_t>(std::floor(point[axis] / cell_m_));
      key = key * 2'097'152 + (static_cast<std::uint64_t>(index) & 2'097'151);
    }
    if (seen_.insert(key).second) points_.push_back(point);
  }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  double cell_m_;
  std::unordered_set<std::uint64_t> seen_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace planbench
