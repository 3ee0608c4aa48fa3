#include "planner_trajopt/trajectory_cost.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace planbench {
namespace {

/// Whole batches of the engine, so that distances are those of all rows at once; of meshes some
/// milliseconds' work.
constexpr std::size_t kMostAtOnce = 64;

}  // namespace

bool TrajectoryCost::FindDistances(const Trajectory& rows, std::vector<double>* distances) const {
  const auto num_rows = static_cast<std::size_t>(rows.rows());
  const auto n = static_cast<std::size_t>(rows.cols());
  distances->resize(num_rows);
  const std::span<const double> qs(rows.data(), num_rows * n);
  for (std::size_t first = 0; first < num_rows; first += kMostAtOnce) {
    if (first > 0 && ShouldStop()) return false;
    const std::size_t num = std::min(kMostAtOnce, num_rows - first);
    edges_->FindClearances(qs.subspan(first * n, num * n), static_cast<int>(num), clearance_,
                           std::span(*distances).subspan(first, num));
  }
  return true;
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
