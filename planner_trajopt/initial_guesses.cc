#include "planner_trajopt/initial_guesses.h"

#include <cstddef>
#include <limits>
#include <utility>

#include "common/random.h"

namespace planbench {
namespace {

/// Guesses drawn for one.
constexpr int kCandidates = 64;
/// Points by the way: of the first guesses, and so on in turn.
constexpr int kMostPoints = 2;

}  // namespace

Trajectory InitialGuesses::DrawByWayOf(int num_points) {
  std::vector<Configuration> points = {start_};
  const auto n = static_cast<std::size_t>(space_.size());
  for (int k = 1; k <= num_points; ++k) {
    Configuration anywhere(n), on_line(n), point(n);
    for (std::size_t j = 0; j < n; ++j) {
      const JointSpace::Joint& joint = space_.joint(static_cast<int>(j));
      anywhere[j] = joint.lower + UniformFraction(&random_) * (joint.upper - joint.lower);
    }
    space_.Interpolate(start_, goal_, static_cast<double>(k) / (num_points + 1), on_line);
    space_.Interpolate(on_line, anywhere, UniformFraction(&random_), point);
    points.push_back(std::move(point));
  }
  points.push_back(goal_);
  return Through(space_, points, num_inner_);
}

Trajectory InitialGuesses::Next() {
  const int num_before = count_++;
  if (num_before == 0) return Through(space_, {start_, goal_}, num_inner_);
  const int num_points = 1 + (num_before + 1) % kMostPoints;
  const Eigen::Index num_rows = num_inner_ + 2;
  Trajectory candidates(kCandidates * num_rows, space_.size());
  for (int k = 0; k < kCandidates; ++k) {
    candidates.middleRows(k * num_rows, num_rows) = DrawByWayOf(num_points);
  }
  std::vector<double> distances;
  if (!cost_->FindDistances(candidates, &distances)) return candidates.topRows(num_rows);
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kCandidates; ++k) {
    const auto first = distances.begin() + static_cast<std::ptrdiff_t>(k) * num_rows;
    const double cost = cost_->OfTrajectory(candidates.middleRows(k * num_rows, num_rows),
                                            {first, first + num_rows});
    if (cost < least) {
      least = cost;
      best = k;
    }
  }
  return candidates.middleRows(best * num_rows, num_rows);
}

}  // namespace planbench
