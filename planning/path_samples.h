#pragma once

#include <algorithm>
#include <cmath>

#include "collision/collision_checker.h"
#include "planning/plan_result.h"

namespace planbench {

/// Calls visit(segment, fraction, q, motion_m) for samples of a path so close that no point of the
/// geometry moves more than step_m between neighbours, in order: all of the first edge, then of
/// each edge all but its first, which ended the edge before. motion_m bounds the motion since the
/// sample before. Stops when visit returns false.
template <typename Visit>
void VisitSamples(const CollisionChecker& checker, const Path& path, double step_m, Visit visit) {
  const JointSpace& space = checker.space();
  if (!visit(0, 0.0, path.front(), 0.0)) return;
  Configuration q(path.front().size());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double edge_motion_m = checker.motion_bound().Between(space, path[i - 1], path[i]);
    const int intervals = std::max(1, static_cast<int>(std::ceil(edge_motion_m / step_m)));
    for (int s = 1; s <= intervals; ++s) {
      const double fraction = static_cast<double>(s) / intervals;
      space.Interpolate(path[i - 1], path[i], fraction, q);
      if (!visit(static_cast<int>(i) - 1, fraction, q, edge_motion_m / intervals)) return;
    }
  }
}

}  // namespace planbench
