#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/collision_checker.h"
#include "planning/goal_box.h"
#include "planning/path_measures.h"
#include "planning/plan_result.h"

namespace planbench {

/// Samples of a path that are judged: more would take minutes, with clearances at any rate.
inline constexpr double kMaxPathSamples = 1e6;
/// A path is too long, whatever the step, if points of the robot may move further than this on it,
/// m: then there would be as many at steps of 1 cm.
inline constexpr double kMaxPathMotion = 1e4;
/// The finest step at which paths are judged where none is asked for, m: a verdict on a usual path
/// of an arm takes seconds at most.
inline constexpr double kFinestDefaultRefereeStep = 2e-4;

/// The step at which paths are judged where none is asked for, m: half of the edge resolution, but
/// not finer than that.
inline double DefaultRefereeStep(double edge_resolution_m) {
  return std::max(edge_resolution_m / 2, kFinestDefaultRefereeStep);
}

/// The referee's finding about a path.
struct PathVerdict {
  bool valid = false;
  std::string reason;   ///< Why not, in one line; empty if valid.
  int segment = -1;     ///< Where: segment index, -1 if it is not a matter of place.
  double fraction = 0;  ///< Where on the segment, [0, 1].
  std::optional<Contact> contact;
  /// Of paths of configurations that could be sampled; clearances if valid and asked for.
  MeasuredValues measures;
  int num_samples = 0;  ///< Found free, or the first that is not.
  bool operator==(const PathVerdict&) const = default;
};

/// Judges a path by an engine of the caller's choice, independently of the planner: waypoints
/// finite, of the right size, within limits; the first at `start`, the last inside one of `goals`
/// (both to 1e-6); every edge sampled so that no point of the geometry moves more than `step_m`
/// between samples, all samples free. A path that is empty or too long is invalid. `base_positions`
/// (full positions, those the checker's scene was set with) only serve the tip's travel; empty: the
/// model's default positions, which is as good unless a held joint lies between the group's joints.
/// Throws InputError for a step that is not positive, or too fine for a path that nothing else
/// speaks against, and for a start or goal of the wrong size.
PathVerdict JudgePath(CollisionChecker* checker, const Path& path, std::span<const double> start,
                      const std::vector<GoalBox>& goals, double step_m, bool with_clearance,
                      std::span<const double> base_positions = {});

}  // namespace planbench
