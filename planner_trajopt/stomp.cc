#include "planner_trajopt/stomp.h"

#include <cmath>
#include <numbers>

#include "common/random.h"
#include "planner_trajopt/smoothness.h"

namespace planbench {
namespace {

/// The paper's h: the costs of a waypoint are spread over [0, h] before they are weighted.
constexpr double kSensitivity = 10;

void DrawNormal(std::mt19937_64* random, Eigen::MatrixXd* values) {
  // Box and Muller's, two at a time.
  double* out = values->data();
  const Eigen::Index size = values->size();
  for (Eigen::Index i = 0; i < size; i += 2) {
    const double radius = std::sqrt(-2 * std::log(1 - UniformFraction(random)));
    const double angle = 2 * std::numbers::pi * UniformFraction(random);
    out[i] = radius * std::cos(angle);
    if (i + 1 < size) out[i + 1] = radius * std::sin(angle);
  }
}

}  // namespace

Stomp::Stomp(const JointSpace& space, const TrajoptSettings& settings, const TrajectoryCost* cost,
             std::uint64_t seed)
    : cost_(cost),
      bounds_(space),
      num_rows_(settings.waypoints + 2),
      num_rollouts_(settings.rollouts),
      smoothing_(InverseSmoothness(settings.waypoints)),
      deviations_(space.size()),
      random_(seed),
      rollouts_(num_rows_ * num_rollouts_, space.size()) {
  const double largest_deviation = std::sqrt(smoothing_.diagonal().maxCoeff());
  for (Eigen::Index i = 0; i < smoothing_.cols(); ++i) {
    smoothing_.col(i) *= settings.gain / (smoothing_.col(i).maxCoeff() * settings.waypoints);
  }
  for (int j = 0; j < space.size(); ++j) {
    deviations_[j] =
        settings.noise * (space.joint(j).upper - space.joint(j).lower) / largest_deviation;
  }
}

bool Stomp::DrawRollouts(const Trajectory& trajectory) {
  Eigen::MatrixXd steps(num_rows_ - 2, trajectory.cols());
  Eigen::RowVectorXd noise(trajectory.cols());
  for (int k = 0; k < num_rollouts_; ++k) {
    if (cost_->ShouldStop()) return false;
    DrawNormal(&random_, &steps);
    auto rollout = Rollout(k);
    rollout = trajectory;
    // A random walk that is back at zero at the goal: the Brownian bridge, whose covariance is the
    // inverse metric.
    noise.setZero();
    for (Eigen::Index i = 1; i + 1 < num_rows_; ++i) {
      const auto num_left = static_cast<double>(num_rows_ - 1 - i);
      const double share = num_left / (num_left + 1);
      noise = share * noise + std::sqrt(share) * steps.row(i - 1);
      rollout.row(i) += noise.cwiseProduct(deviations_);
    }
    bounds_.Clamp(rollout.middleRows(1, steps.rows()));
  }
  return true;
}

bool Stomp::FindCosts() {
  if (!cost_->FindDistances(rollouts_, &distances_)) return false;
  costs_.resize(num_rows_ - 2, num_rollouts_);
  for (int k = 0; k < num_rollouts_; ++k) {
    if (cost_->ShouldStop()) return false;
    const auto rollout = Rollout(k);
    for (Eigen::Index i = 1; i + 1 < num_rows_; ++i) {
      const double distance = distances_[static_cast<std::size_t>(k * num_rows_ + i)];
      const double speed = (rollout.row(i + 1) - rollout.row(i - 1)).norm() / 2;
      const double squares = (rollout.row(i) - rollout.row(i - 1)).squaredNorm() +
                             (rollout.row(i + 1) - rollout.row(i)).squaredNorm();
      costs_(i - 1, k) = cost_->OfDistance(distance) * speed + cost_->smoothness() / 4 * squares;
    }
  }
  return true;
}

std::optional<Trajectory> Stomp::FindUpdate(const Trajectory& trajectory) const {
  const Eigen::Index num_inner = num_rows_ - 2;
  Trajectory update = Trajectory::Zero(num_inner, trajectory.cols());
  for (Eigen::Index i = 0; i < num_inner; ++i) {
    if (cost_->ShouldStop()) return std::nullopt;
    const double least = costs_.row(i).minCoeff();
    const double range = costs_.row(i).maxCoeff() - least;
    if (!(range > 0)) continue;
    double total = 0;
    for (int k = 0; k < num_rollouts_; ++k) {
      const double weight = std::exp(-kSensitivity * (costs_(i, k) - least) / range);
      total += weight;
      update.row(i) += weight * (Rollout(k).row(i + 1) - trajectory.row(i + 1));
    }
    update.row(i) /= total;
  }
  return update;
}

void Stomp::Iterate(const std::vector<double>& /*distances*/, Trajectory* trajectory) {
  if (!DrawRollouts(*trajectory) || !FindCosts()) return;
  const std::optional<Trajectory> update = FindUpdate(*trajectory);
  if (!update) return;
  const Eigen::Index num_inner = num_rows_ - 2;
  trajectory->middleRows(1, num_inner) += smoothing_ * *update;
  bounds_.Clamp(trajectory->middleRows(1, num_inner));
}

}  // namespace planbench
