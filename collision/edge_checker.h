#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/collision_checker.h"

namespace planbench {

/// Validity of states and edges, the same for every planner. A state is valid if it is within the
/// joint limits and free. An edge is the straight joint motion (continuous joints the short way
/// round), sampled evenly so that no point of the collision geometry moves more than
/// `edge_resolution_m` between neighbouring samples by the motion bound; both ends are samples. It
/// is valid if both ends are within limits and all samples are free.
///
/// Configurations of the wrong size throw InputError; joint positions that are not finite are
/// outside the limits.
///
/// Not thread-safe: one instance a thread.
class EdgeChecker {
 public:
  struct Counters {
    std::int64_t states = 0;          ///< States checked by themselves.
    std::int64_t edges = 0;           ///< Edges checked.
    std::int64_t configurations = 0;  ///< Configurations checked for both.
    double seconds = 0;               ///< Time spent in both.
  };

  /// The checker must outlive this and have its scene set. Throws InputError unless
  /// edge_resolution_m > 0.
  EdgeChecker(CollisionChecker* checker, double edge_resolution_m);

  const JointSpace& space() const { return checker_->space(); }
  CollisionChecker& checker() const { return *checker_; }
  double edge_resolution_m() const { return edge_resolution_m_; }

  bool IsValidState(std::span<const double> q);
  /// valid[i] = IsValidState(state i) for `num` states (row-major, num x n), at once where the
  /// engine can.
  void CheckStates(std::span<const double> qs, int num, std::span<unsigned char> valid);
  /// `from_is_free`: the caller has already checked `from`, so that its sample can be left out.
  bool IsValidEdge(std::span<const double> from, std::span<const double> to,
                   bool from_is_free = false);
  /// valid[i] = IsValidEdge(from, configuration i of `tos`, from_is_free) for `num` edges out of
  /// one state (`tos`: row-major, num x n), several of which are checked at once where the engine
  /// can.
  void CheckEdges(std::span<const double> from, std::span<const double> tos, int num,
                  std::span<unsigned char> valid, bool from_is_free = false);
  /// Number of even intervals an edge is divided into (samples - 1); at least 1.
  int NumIntervals(std::span<const double> from, std::span<const double> to) const;

  const Counters& counters() const { return counters_; }

 private:
  void RequireSize(std::span<const double> q) const;

  CollisionChecker* checker_;
  double edge_resolution_m_;
  Counters counters_;
  std::vector<double> block_;  // scratch: configurations of one batch
};

}  // namespace planbench
