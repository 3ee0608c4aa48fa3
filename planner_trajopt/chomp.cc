#include "planner_trajopt/chomp.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "planner_trajopt/smoothness.h"

namespace planbench {
namespace {

/// Change of the step's limit after an iteration that raised the cost, and after any other.
constexpr double kShrink = 0.5;
constexpr double kGrow = 1.1;
constexpr int kLimitCorrections = 10;  // of a joint, an iteration

}  // namespace

Chomp::Chomp(const JointSpace& space, const TrajoptSettings& settings, const TrajectoryCost* cost)
    : cost_(cost),
      bounds_(space),
      inverse_metric_(InverseSmoothness(settings.waypoints)),
      gradient_step_(settings.gradient_step),
      max_step_(settings.step) {
  Chomp::Restart();
}

void Chomp::Restart() {
  step_ = max_step_;
  last_cost_ = std::numeric_limits<double>::infinity();
}

std::optional<Trajectory> Chomp::FunctionalGradient(const std::vector<double>& distances,
                                                    const Trajectory& trajectory) {
  const Eigen::Index n = trajectory.cols();
  std::vector<Eigen::Index> near;  // rows whose cost is not zero
  for (Eigen::Index i = 1; i + 1 < trajectory.rows(); ++i) {
    if (distances[static_cast<std::size_t>(i)] < cost_->clearance()) near.push_back(i);
  }
  probes_.resize(static_cast<Eigen::Index>(near.size()) * 2 * n, n);
  Eigen::Index row = 0;
  for (const Eigen::Index i : near) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (const double side : {1.0, -1.0}) {
        probes_.row(row) = trajectory.row(i);
        probes_(row++, j) += side * gradient_step_;
      }
    }
  }
  if (!cost_->FindDistances(probes_, &probe_distances_)) return std::nullopt;

  Trajectory gradient = Trajectory::Zero(trajectory.rows() - 2, n);
  std::size_t probe = 0;
  Eigen::RowVectorXd slope(n);
  for (const Eigen::Index i : near) {
    for (Eigen::Index j = 0; j < n; ++j, probe += 2) {
      slope[j] = (cost_->OfDistance(probe_distances_[probe]) -
                  cost_->OfDistance(probe_distances_[probe + 1])) /
                 (2 * gradient_step_);
    }
    const Eigen::RowVectorXd velocity = (trajectory.row(i + 1) - trajectory.row(i - 1)) / 2;
    const double speed = velocity.norm();
    if (!(speed > 0)) continue;
    const Eigen::RowVectorXd direction = velocity / speed;
    const auto across = [&direction](const Eigen::RowVectorXd& v) -> Eigen::RowVectorXd {
      return v - v.dot(direction) * direction;
    };
    const Eigen::RowVectorXd acceleration =
        trajectory.row(i + 1) - 2 * trajectory.row(i) + trajectory.row(i - 1);
    const Eigen::RowVectorXd curvature = across(acceleration) / (speed * speed);
    gradient.row(i - 1) =
        speed *
        (across(slope) - cost_->OfDistance(distances[static_cast<std::size_t>(i)]) * curvature);
  }
  return gradient;
}

void Chomp::KeepWithinLimits(Trajectory* trajectory) const {
  auto inner = trajectory->middleRows(1, NumInner(*trajectory));
  for (Eigen::Index j = 0; j < inner.cols(); ++j) {
    auto joint = inner.col(j);
    for (int k = 0; k < kLimitCorrections; ++k) {
      const Eigen::VectorXd violation =
          joint.cwiseMax(bounds_.lower()[j]).cwiseMin(bounds_.upper()[j]) - joint;
      Eigen::Index row = 0;
      if (!(violation.cwiseAbs().maxCoeff(&row) > 0)) break;
      // The inverse metric's column is smooth and largest at its own row: no waypoint moves further
      // than the worst one has to. All violations at once, smoothed, add up to many times that.
      joint += violation[row] / inverse_metric_(row, row) * inverse_metric_.col(row);
    }
  }
  bounds_.Clamp(inner);
}

void Chomp::Iterate(const std::vector<double>& distances, Trajectory* trajectory) {
  const double cost = cost_->OfTrajectory(*trajectory, distances);
  step_ = cost > last_cost_ ? step_ * kShrink : std::min(max_step_, step_ * kGrow);
  last_cost_ = cost;

  const Eigen::Index num_inner = NumInner(*trajectory);
  const std::optional<Trajectory> gradient = FunctionalGradient(distances, *trajectory);
  if (!gradient) return;
  Trajectory descent = -inverse_metric_ * *gradient;
  // The metric's own gradient, in the metric: towards the straight line.
  for (Eigen::Index i = 0; i < num_inner; ++i) {
    const double t = static_cast<double>(i + 1) / static_cast<double>(num_inner + 1);
    const Eigen::RowVectorXd line =
        (1 - t) * trajectory->row(0) + t * trajectory->row(num_inner + 1);
    descent.row(i) -= cost_->smoothness() * (trajectory->row(i + 1) - line);
  }
  const double largest = descent.cwiseAbs().maxCoeff();
  if (largest > step_) descent *= step_ / largest;
  Trajectory next = *trajectory;
  next.middleRows(1, num_inner) += descent;
  KeepWithinLimits(&next);
  *trajectory = std::move(next);
}

}  // namespace planbench
