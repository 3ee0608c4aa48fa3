#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "collision/collision_checker.h"
#include "robot_model/edge_check.h"

namespace planbench {

/// A spacing of the samples of edges other than by the motion bound, for planners that reproduce
/// what another system does: neighbours are at most `step` apart in a norm of the weighted joint
/// motions.
struct EdgeSampling {
  std::vector<double> weights;  ///< n joints, >= 0, per rad or m.
  double step = 0;              ///< > 0
  bool euclidean = false;       ///< The root of the sum of squares; else the sum.
};

/// Validity of states and edges, the same for every planner. A state is valid if it is within the
/// joint limits and free. An edge is the straight joint motion (continuous joints the short way
/// round); it is valid if both ends are within limits and, by method,
/// - fixed: it is free at samples, spread evenly so that no point of the collision geometry moves
///   more than `edge_resolution_m` between neighbours by the motion bound; both ends are samples;
/// - certified: it is proven free from end to end (CollisionChecker::CheckSamples). The edge is cut
///   into stretches; those that are not proven free as a whole are cut again, down to stretches
///   over which nothing moves more than kCertifiedDepth, which count as in collision. So an edge
///   that passes obstacles at less than that may be refused, and none that collides is accepted.
///
/// Free is what the checker's model says of every configuration on the edge: with a distance field,
/// that no centre of a sphere comes into a cell whose value is below the radius.
///
/// Configurations of the wrong size throw InputError; joint positions that are not finite are
/// outside the limits.
///
/// Not thread-safe: one instance a thread.
class EdgeChecker {
 public:
  /// Certified edges: motion within the last stretches, m.
  static constexpr double kCertifiedDepth = 0.0005;

  struct Counters {
    std::int64_t states = 0;  ///< States checked by themselves.
    std::int64_t edges = 0;   ///< Edges checked.
    /// Configurations (or stretches) checked for both, and those whose distances were found.
    std::int64_t configurations = 0;
    std::uint64_t ticks = 0;  ///< Time spent in all (Ticks).
  };

  /// The checker must outlive this; its scene is set before it is asked. Throws InputError unless
  /// edge_resolution_m > 0.
  EdgeChecker(CollisionChecker* checker, double edge_resolution_m, EdgeCheck method);
  /// Edges are sampled as `sampling` says. Throws InputError unless its weights are those of n
  /// joints and its step > 0.
  EdgeChecker(CollisionChecker* checker, EdgeSampling sampling);

  const JointSpace& space() const { return checker_->space(); }
  CollisionChecker& checker() const { return *checker_; }
  /// m, or in the unit of the sampling of its own.
  double edge_resolution() const { return resolution_; }

  /// A long edge can take long, and so can many short ones. `should_stop` is asked every so many
  /// configurations of edges, within one or not; when it says yes, the edge at hand is given up: it
  /// counts as blocked, and Stopped says so. So does every edge from then on, until `should_stop`,
  /// which is asked each time, says no. An empty function: never.
  void StopWhen(std::function<bool()> should_stop);
  /// True if an edge was given up since StopWhen.
  bool Stopped() const { return stopped_; }
  /// True if the edge that was asked about last was given up.
  bool GaveUp() const { return gave_up_; }
  EdgeCheck method() const { return method_; }

  bool IsValidState(std::span<const double> q);
  /// valid[i] = IsValidState(state i) for `num` states (row-major, num x n), at once where the
  /// engine can.
  void CheckStates(std::span<const double> qs, int num, std::span<unsigned char> valid);
  /// As CheckStates, but what would take the engine long may be left out: what is not valid is
  /// invalid for certain. For ends of edges, which are checked if they pass.
  void ScreenStates(std::span<const double> qs, int num, std::span<unsigned char> valid);
  /// Those of CollisionChecker, counted. Limits are the caller's to check.
  void FindClearances(std::span<const double> qs, int num, double at_most,
                      std::span<double> clearances);
  /// `from_is_free`: the caller has already checked `from`, so that its sample can be left out.
  bool IsValidEdge(std::span<const double> from, std::span<const double> to,
                   bool from_is_free = false);
  /// A fraction of the edge at which it is in collision or, certified, not proven free; nothing if
  /// it is free. Limits are the caller's to check.
  std::optional<double> FindBlocked(std::span<const double> from, std::span<const double> to,
                                    bool from_is_free = false);

  /// The part of the edge out of `from`, which is free, up to which it is free by the method: 1 if
  /// all of it is, 0 if `to` is outside the limits; else it is blocked no further on than the edge
  /// resolution. It is the same however many samples the engine handles at once. It is proven in
  /// pieces: that part as a single edge may be judged otherwise, since it is sampled elsewhere.
  /// Takes one edge; certified, two and log2(motion / edge resolution) blocks.
  double FindFreePart(std::span<const double> from, std::span<const double> to);

  /// Number of even intervals that the fixed method divides an edge into (its samples - 1), at
  /// least 1: a whole number, of any size.
  double NumIntervals(std::span<const double> from, std::span<const double> to) const;
  /// Calls visit(fraction, q) at the samples of the fixed method in order, both ends included,
  /// until it returns false; returns whether it never did. For callers that want more of an edge
  /// than its validity; limits are theirs to check.
  template <typename Visit>
  bool VisitSamples(std::span<const double> from, std::span<const double> to, Visit visit) const {
    const std::int64_t intervals = RequireFewIntervals(NumIntervals(from, to));
    std::vector<double> q(from.size());
    for (std::int64_t i = 0; i <= intervals; ++i) {
      const double fraction = static_cast<double>(i) / static_cast<double>(intervals);
      space().Interpolate(from, to, fraction, q);
      if (!visit(fraction, q)) return false;
    }
    return true;
  }

  const Counters& counters() const { return counters_; }

 private:
  void Reserve();
  /// Of CollisionChecker, for a run of states within the limits.
  using JudgeStates = void (CollisionChecker::*)(std::span<const double> qs, int num,
                                                 std::span<unsigned char> free);
  void CheckStatesBy(JudgeStates judge, std::span<const double> qs, int num,
                     std::span<unsigned char> valid);
  void RequireSize(std::span<const double> q) const;
  double NumIntervals(double motion) const;
  /// Sets `motion` to the edge's and returns its size, in the unit of the resolution.
  double Move(std::span<const double> from, std::span<const double> to,
              std::vector<double>* motion) const;
  /// Throws InputError for more than can be counted.
  std::int64_t RequireFewIntervals(double intervals) const;
  // Of the edge motion_ out of `from`, of size `motion`; certified, nothing moves more than
  // motion_m.
  std::optional<double> FindBlockedSample(std::span<const double> from, double motion,
                                          bool from_is_free);
  std::optional<double> FindBlockedStretch(std::span<const double> from, double motion_m);
  // FindFreePart.
  double FreeSamples(std::span<const double> from, double motion);
  double FreeStretches(std::span<const double> from, std::span<const double> to, double motion_m);
  SampleVerdicts CheckBlock(std::span<const double> from, std::span<const MotionSample> block,
                            SampleRole role);
  /// True if the edge at hand is to be given up.
  bool GiveUp();

  CollisionChecker* checker_;
  double resolution_;
  EdgeCheck method_;
  std::optional<EdgeSampling> sampling_;
  Counters counters_;
  std::function<bool()> should_stop_;
  bool stopped_ = false;
  bool gave_up_ = false;
  std::int64_t unasked_ = 0;  ///< Configurations of edges since should_stop_ was asked.

  // Scratch.
  std::vector<double> motion_;         ///< The edge's signed motion, by joint.
  std::vector<MotionSample> block_;    ///< Fixed: samples to be checked at once.
  std::vector<MotionSample> pending_;  ///< Certified: stretches to be checked, first of any edge.
};

}  // namespace planbench
