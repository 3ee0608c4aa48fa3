#include "planner_trajopt/trajectory_cost.h"

#include <cstddef>

namespace planbench {

void TrajectoryCost::FindDistances(const Trajectory& rows, std::vector<double>* distances) const {
  distances->resize(static_cast<std::size_t>(rows.rows()));
  edges_->FindClearances({rows.data(), static_cast<std::size_t>(rows.size())},
                         static_cast<int>(rows.rows()), clearance_, *distances);
}

double TrajectoryCost::OfDistance(double distance) const {
  if (distance >= clearance_) return 0;
  if (distance < 0) return clearance_ / 2 - distance;
  return (clearance_ - distance) * (clearance_ - distance) / (2 * clearance_);
}

double TrajectoryCost::OfTrajectory(const Trajectory& trajectory,
                                    const std::vector<double>& distances) const {
  const Eigen::VectorXd speeds = Speeds(trajectory);
  double obstacles = 0;
  for (Eigen::Index i = 1; i + 1 < trajectory.rows(); ++i) {
    obstacles += OfDistance(distances[static_cast<std::size_t>(i)]) * speeds[i];
  }
  const Eigen::Index moves = trajectory.rows() - 1;
  const double squares = (trajectory.bottomRows(moves) - trajectory.topRows(moves)).squaredNorm();
  return obstacles + smoothness_ / 2 * squares;
}

}  // namespace planbench
