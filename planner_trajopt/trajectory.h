#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "planning/plan_result.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// A row a configuration: start, inner waypoints, goal (rad or m). Continuous joints are not
/// wrapped: neighbouring rows differ by the motion between them. Where few waypoints are more than
/// half a turn apart, the path goes the short way round all the same.
using Trajectory = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline int NumInner(const Trajectory& trajectory) {
  return static_cast<int>(trajectory.rows()) - 2;
}

inline std::span<const double> Row(const Trajectory& trajectory, int row) {
  return {trajectory.row(row).data(), static_cast<std::size_t>(trajectory.cols())};
}

/// Limits of the joints, infinite for continuous ones.
class JointBounds {
 public:
  explicit JointBounds(const JointSpace& space);

  const Eigen::RowVectorXd& lower() const { return lower_; }
  const Eigen::RowVectorXd& upper() const { return upper_; }
  /// Brings every row within.
  void Clamp(Eigen::Ref<Trajectory> rows) const;

 private:
  Eigen::RowVectorXd lower_;
  Eigen::RowVectorXd upper_;
};

/// Straight motions from point to point, continuous joints the short way round, SpacedEvenly. At
/// least two points.
Trajectory Through(const JointSpace& space, const std::vector<Configuration>& points,
                   int num_inner);

/// `num_inner` waypoints on the motions along `corners` (two rows at least), evenly by joint
/// distance.
Trajectory SpacedEvenly(const Trajectory& corners, int num_inner);

/// Speed of every row, by central differences, with a unit of time between rows; 0 at the ends.
Eigen::VectorXd Speeds(const Trajectory& trajectory);

/// Its waypoints, continuous joints wrapped.
Path PathOf(const JointSpace& space, const Trajectory& trajectory);

}  // namespace planbench
