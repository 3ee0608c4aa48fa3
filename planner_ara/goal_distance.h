#pragma once

#include <span>
#include <vector>

#include "planning/goal_box.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// Weighted joint distance to a goal box: the square root of the sum over joints of (w_j d_j)^2,
/// d_j the distance (rad or m, continuous joints the short way round) from q_j to the box's side
/// within the joint limits. It is a norm of differences, so for any two configurations it differs
/// by at most their own weighted distance: a consistent heuristic wherever an edge costs at least
/// the weighted length of its motion.
class GoalDistance {
 public:
  /// `weights`: one for each joint, > 0, per rad or m.
  GoalDistance(const JointSpace& space, const GoalBox& goal, std::vector<double> weights);

  /// (w_j d_j)^2 of joint j at position `value`.
  double SquaredTerm(int j, double value) const;
  /// The same at many positions.
  std::vector<double> SquaredTerms(int j, std::span<const double> values) const;
  /// The same of a continuous joint by ways that do not pass `wall`, a position outside the box.
  std::vector<double> SquaredTermsRound(int j, std::span<const double> values, double wall) const;
  /// The distance from q.
  double operator()(std::span<const double> q) const;
  /// The nearest point of the box within the joint limits; the nominal point itself where the box
  /// is a point.
  void Nearest(std::span<const double> q, std::span<double> nearest) const;
  /// True if the box is more than its nominal point.
  bool has_extent() const { return has_extent_; }

 private:
  // Offsets from nominal, <= 0 and >= 0.
  struct Side {
    double nominal;
    double below;
    double above;
  };
  // Signed motion from `value` to the nearest point of side j, and that point's offset from
  // nominal.
  struct Approach {
    double motion;
    double offset;
  };
  Approach ApproachOf(int j, double value) const;

  const JointSpace* space_;
  std::vector<Side> sides_;
  std::vector<double> weights_;
  bool has_extent_ = false;
};

/// Weighted length of the straight motion between two configurations.
double WeightedDistance(const JointSpace& space, std::span<const double> weights,
                        std::span<const double> from, std::span<const double> to);

}  // namespace planbench
