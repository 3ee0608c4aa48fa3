#include "planner_trajopt/trajectory.h"

#include <algorithm>

#include "common/numbers.h"

namespace planbench {
namespace {

/// The points themselves, a row each.
Trajectory Corners(const JointSpace& space, const std::vector<Configuration>& points) {
  Trajectory corners(static_cast<Eigen::Index>(points.size()), space.size());
  for (int j = 0; j < space.size(); ++j) {
    const auto joint = static_cast<std::size_t>(j);
    corners(0, j) = points[0][joint];
    for (std::size_t k = 1; k < points.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      corners(row, j) =
          corners(row - 1, j) + space.Difference(j, points[k - 1][joint], points[k][joint]);
    }
  }
  return corners;
}

}  // namespace

JointBounds::JointBounds(const JointSpace& space) : lower_(space.size()), upper_(space.size()) {
  for (int j = 0; j < space.size(); ++j) {
    const JointSpace::Joint& joint = space.joint(j);
    lower_[j] = joint.continuous ? -kInfinity : joint.lower;
    upper_[j] = joint.continuous ? kInfinity : joint.upper;
  }
}

void JointBounds::Clamp(Eigen::Ref<Trajectory> rows) const {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    rows.row(i) = rows.row(i).cwiseMax(lower_).cwiseMin(upper_);
  }
}

Trajectory Through(const JointSpace& space, const std::vector<Configuration>& points,
                   int num_inner) {
  return SpacedEvenly(Corners(space, points), num_inner);
}

Trajectory SpacedEvenly(const Trajectory& corners, int num_inner) {
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(corners.rows());  // from the start
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    lengths[k] = lengths[k - 1] + (corners.row(k) - corners.row(k - 1)).norm();
  }
  const Eigen::Index last = corners.rows() - 1;
  Trajectory trajectory(num_inner + 2, corners.cols());
  trajectory.row(0) = corners.row(0);
  trajectory.row(num_inner + 1) = corners.row(last);
  Eigen::Index to = 1;
  for (int i = 1; i <= num_inner; ++i) {
    const double at = lengths[last] * i / (num_inner + 1);
    while (to < last && lengths[to] < at) ++to;
    const double motion = lengths[to] - lengths[to - 1];
    const double t = motion > 0 ? std::min(1.0, (at - lengths[to - 1]) / motion) : 0;
    trajectory.row(i) = corners.row(to - 1) + t * (corners.row(to) - corners.row(to - 1));
  }
  return trajectory;
}

Eigen::VectorXd Speeds(const Trajectory& trajectory) {
  Eigen::VectorXd speeds = Eigen::VectorXd::Zero(trajectory.rows());
  for (Eigen::Index i = 1; i + 1 < trajectory.rows(); ++i) {
    speeds[i] = (trajectory.row(i + 1) - trajectory.row(i - 1)).norm() / 2;
  }
  return speeds;
}

Path PathOf(const JointSpace& space, const Trajectory& trajectory) {
  Path path;
  for (int i = 0; i < trajectory.rows(); ++i) {
    const std::span<const double> row = Row(trajectory, i);
    Configuration q(row.begin(), row.end());
    space.Wrap(q);
    path.push_back(std::move(q));
  }
  return path;
}

}  // namespace planbench
