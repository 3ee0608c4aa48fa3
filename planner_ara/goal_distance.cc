#include "planner_ara/goal_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace planbench {

GoalDistance::GoalDistance(const JointSpace& space, const GoalBox& goal,
                           std::vector<double> weights)
    : space_(&space), weights_(std::move(weights)) {
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const JointSpace::Joint& joint = space.joint(j);
    double lower = goal.lower[i];
    double upper = goal.upper[i];
    if (!joint.continuous) {
      lower = std::max(lower, joint.lower);
      upper = std::min(upper, joint.upper);
    }
    // The nominal point belongs to the goal even where the tolerance of the limits lets it stand
    // outside them.
    Side side{goal.nominal[i], std::min(0.0, lower - goal.nominal[i]),
              std::max(0.0, upper - goal.nominal[i])};
    if (joint.continuous) {
      side.below = std::max(side.below, -std::numbers::pi);
      side.above = std::min(side.above, std::numbers::pi);
    }
    has_extent_ = has_extent_ || side.above - side.below > 0;
    sides_.push_back(side);
  }
}

GoalDistance::Approach GoalDistance::ApproachOf(int j, double value) const {
  const Side& side = sides_[static_cast<std::size_t>(j)];
  const double offset = space_->Difference(j, side.nominal, value);
  if (offset >= side.below && offset <= side.above) return {0, offset};
  double to_below = side.below - offset;
  double to_above = side.above - offset;
  if (space_->joint(j).continuous) {
    to_below = WrapAngle(to_below);
    to_above = WrapAngle(to_above);
  }
  if (std::abs(to_below) < std::abs(to_above)) return {to_below, side.below};
  return {to_above, side.above};
}

double GoalDistance::SquaredTerm(int j, double value) const {
  const double weighted = weights_[static_cast<std::size_t>(j)] * ApproachOf(j, value).motion;
  return weighted * weighted;
}

std::vector<double> GoalDistance::SquaredTerms(int j, std::span<const double> values) const {
  std::vector<double> terms(values.size());
  if (space_->joint(j).continuous) {
    std::transform(values.begin(), values.end(), terms.begin(),
                   [&](double value) { return SquaredTerm(j, value); });
    return terms;
  }
  // As ApproachOf has it, without branches: lattices ask for thousands.
  const Side& side = sides_[static_cast<std::size_t>(j)];
  const double weight = weights_[static_cast<std::size_t>(j)];
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double offset = values[i] - side.nominal;
    const double beyond = std::max(side.below - offset, offset - side.above);
    const double weighted = weight * std::max(0.0, beyond);
    terms[i] = weighted * weighted;
  }
  return terms;
}

std::vector<double> GoalDistance::SquaredTermsRound(int j, std::span<const double> values,
                                                    double wall) const {
  const Side& side = sides_[static_cast<std::size_t>(j)];
  // How far round from the wall, in [0, 2 pi).
  const auto beyond_wall = [&](double value) {
    return WrapAngle(value - wall - std::numbers::pi) + std::numbers::pi;
  };
  const double nominal = beyond_wall(side.nominal);
  std::vector<double> terms;
  for (const double value : values) {
    const double offset = beyond_wall(value) - nominal;
    const double motion = std::max({0.0, side.below - offset, offset - side.above});
    const double weighted = weights_[static_cast<std::size_t>(j)] * motion;
    terms.push_back(weighted * weighted);
  }
  return terms;
}

double GoalDistance::operator()(std::span<const double> q) const {
  double sum = 0;
  for (int j = 0; j < space_->size(); ++j) sum += SquaredTerm(j, q[static_cast<std::size_t>(j)]);
  return std::sqrt(sum);
}

void GoalDistance::Nearest(std::span<const double> q, std::span<double> nearest) const {
  for (int j = 0; j < space_->size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const Side& side = sides_[i];
    if (side.above == side.below) {
      nearest[i] = side.nominal;
      continue;
    }
    const Approach approach = ApproachOf(j, q[i]);
    nearest[i] = approach.motion == 0 ? q[i] : side.nominal + approach.offset;
  }
}

double WeightedDistance(const JointSpace& space, std::span<const double> weights,
                        std::span<const double> from, std::span<const double> to) {
  double sum = 0;
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double weighted = weights[i] * space.Difference(j, from[i], to[i]);
    sum += weighted * weighted;
  }
  return std::sqrt(sum);
}

}  // namespace planbench
