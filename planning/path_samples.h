#pragma once

#include "collision/edge_checker.h"
#include "planning/plan_result.h"

namespace planbench {

/// Calls visit(segment, fraction, q, motion_m) for the samples of the fixed method of all edges of
/// a path, in order: all of the first edge, then of each edge all but its first, which ended the
/// edge before. motion_m bounds the motion of any point since the sample before. Stops when visit
/// returns false. The path has waypoints, all of the group's size.
template <typename Visit>
void VisitSamples(const EdgeChecker& edges, const Path& path, Visit visit) {
  if (!visit(0, 0.0, path.front(), 0.0)) return;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double motion_m =
        edges.checker().motion_bound().Between(edges.space(), path[i - 1], path[i]) /
        edges.NumIntervals(path[i - 1], path[i]);
    const bool goes_on =
        edges.VisitSamples(path[i - 1], path[i], [&](double fraction, const Configuration& q) {
          return fraction == 0 || visit(static_cast<int>(i) - 1, fraction, q, motion_m);
        });
    if (!goes_on) return;
  }
}

}  // namespace planbench
