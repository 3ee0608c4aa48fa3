#include "planning/path_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "common/error.h"
#include "planning/path_metrics.h"
#include "robot_model/group_kinematics.h"

namespace planbench {
namespace {

constexpr double kEndTolerance = 1e-6;  // rad or m

/// Even intervals between samples such that nothing moves more than step_m over one.
int NumIntervals(const CollisionChecker& checker, const Configuration& from,
                 const Configuration& to, double step_m) {
  const double motion_m = checker.motion_bound().Between(checker.space(), from, to);
  return std::max(1, static_cast<int>(std::ceil(motion_m / step_m)));
}

/// Calls visit(segment, fraction, q, motion_m) for every sample in order: all of the first edge,
/// then of each edge all but its first, which ended the edge before. motion_m bounds the motion
/// since the sample before. Stops when visit returns false.
template <typename Visit>
void VisitSamples(const CollisionChecker& checker, const Path& path, double step_m, Visit visit) {
  const JointSpace& space = checker.space();
  if (!visit(0, 0.0, path.front(), 0.0)) return;
  Configuration q(path.front().size());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int intervals = NumIntervals(checker, path[i - 1], path[i], step_m);
    const double motion_m = checker.motion_bound().Between(space, path[i - 1], path[i]) / intervals;
    for (int s = 1; s <= intervals; ++s) {
      const double fraction = static_cast<double>(s) / intervals;
      space.Interpolate(path[i - 1], path[i], fraction, q);
      if (!visit(static_cast<int>(i) - 1, fraction, q, motion_m)) return;
    }
  }
}

void Reject(PathVerdict* verdict, const std::string& reason, int segment, double fraction) {
  verdict->reason = reason;
  verdict->segment = segment;
  verdict->fraction = fraction;
}

/// Segment and fraction of a waypoint.
void RejectWaypoint(PathVerdict* verdict, const std::string& reason, std::size_t waypoint) {
  if (waypoint == 0) {
    Reject(verdict, reason, 0, 0);
  } else {
    Reject(verdict, reason, static_cast<int>(waypoint) - 1, 1);
  }
}

/// False, with the reason, if some waypoint is no configuration of the space or outside its limits.
bool JudgeWaypoints(const JointSpace& space, const Path& path, PathVerdict* verdict) {
  if (path.empty()) {
    verdict->reason = "the path is empty";
    return false;
  }
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Configuration& q = path[i];
    if (q.size() != static_cast<std::size_t>(space.size())) {
      RejectWaypoint(verdict,
                     fmt::format("waypoint {} has {} positions, the group has {} joints", i,
                                 q.size(), space.size()),
                     i);
      return false;
    }
    const int j = space.FirstOutsideLimits(q);
    if (j >= 0) {
      const JointSpace::Joint& joint = space.joint(j);
      const double position = q[static_cast<std::size_t>(j)];
      RejectWaypoint(verdict,
                     std::isfinite(position)
                         ? fmt::format("waypoint {}: joint '{}' at {} is outside [{}, {}]", i,
                                       joint.name, position, joint.lower, joint.upper)
                         : fmt::format("waypoint {}: joint '{}' is {}, not a finite number", i,
                                       joint.name, position),
                     i);
      return false;
    }
  }
  return true;
}

/// False, with the reason, if the path does not run from the start to the goal.
bool JudgeEnds(const JointSpace& space, const Path& path, std::span<const double> start,
               GoalBox goal, PathVerdict* verdict) {
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double off = space.Difference(j, start[k], path.front()[k]);
    if (std::abs(off) > kEndTolerance) {
      RejectWaypoint(verdict,
                     fmt::format("the path does not begin at the start: joint '{}' is {} away",
                                 space.joint(j).name, off),
                     0);
      return false;
    }
    goal.lower[k] -= kEndTolerance;
    goal.upper[k] += kEndTolerance;
  }
  if (!goal.Contains(space, path.back())) {
    RejectWaypoint(verdict, "the path does not end in the goal", path.size() - 1);
    return false;
  }
  return true;
}

bool JudgeCollisions(CollisionChecker* checker, const Path& path, double step_m,
                     PathVerdict* verdict) {
  bool free = true;
  VisitSamples(
      *checker, path, step_m, [&](int segment, double fraction, const Configuration& q, double) {
        ++verdict->num_samples;
        if (checker->IsFree(q)) return true;
        free = false;
        verdict->contact = checker->FindContact(q);
        const std::string bodies =
            verdict->contact ? fmt::format("'{}' and '{}', {:.4f} m deep", verdict->contact->body_a,
                                           verdict->contact->body_b, verdict->contact->depth_m)
                             : "no contact found";
        Reject(verdict,
               fmt::format("collision on segment {} at {:.3f}: {}", segment, fraction, bodies),
               segment, fraction);
        return false;
      });
  return free;
}

double TipTravel(const CollisionChecker& checker, const Path& path, double step_m,
                 std::span<const double> base_positions) {
  GroupKinematics kinematics(checker.robot().model, checker.group(), base_positions);
  double travel_m = 0;
  std::optional<Eigen::Vector3d> previous;
  VisitSamples(checker, path, step_m, [&](int, double, const Configuration& q, double) {
    kinematics.Update(q);
    const Eigen::Vector3d p_BT = kinematics.X_BL(checker.group().tip_link).translation();
    if (previous) travel_m += (p_BT - *previous).norm();
    previous = p_BT;
    return true;
  });
  return travel_m;
}

void MeasureClearance(CollisionChecker* checker, const Path& path, double step_m,
                      PathVerdict* verdict) {
  double minimum_m = std::numeric_limits<double>::infinity();
  double first_m = 0;
  double previous_m = 0;
  double weighted_sum = 0;
  double weight = 0;
  bool first = true;
  VisitSamples(*checker, path, step_m, [&](int, double, const Configuration& q, double motion_m) {
    const double clearance_m = checker->FindClosest(q).distance_m;
    minimum_m = std::min(minimum_m, clearance_m);
    if (first) {
      first_m = clearance_m;
      first = false;
    } else {
      weighted_sum += motion_m * (previous_m + clearance_m) / 2;
      weight += motion_m;
    }
    previous_m = clearance_m;
    return true;
  });
  verdict->clearance_min_m = minimum_m;
  verdict->clearance_mean_m = weight > 0 ? weighted_sum / weight : first_m;
}

}  // namespace

PathVerdict JudgePath(CollisionChecker* checker, const Path& path, std::span<const double> start,
                      const GoalBox& goal, double step_m, bool with_clearance,
                      std::span<const double> base_positions) {
  if (!(step_m > 0) || !std::isfinite(step_m)) {
    throw InputError(fmt::format("path check: step_m is {}, must be greater than zero", step_m));
  }
  const JointSpace& space = checker->space();
  const auto n = static_cast<std::size_t>(space.size());
  if (start.size() != n || goal.nominal.size() != n || goal.lower.size() != n ||
      goal.upper.size() != n) {
    throw InputError(
        fmt::format("path check: start and goal must have {} positions each", space.size()));
  }
  PathVerdict verdict;
  if (!JudgeWaypoints(space, path, &verdict)) return verdict;
  verdict.length = PathLength(space, path);
  verdict.smoothness = PathSmoothness(space, path);
  const std::vector<double> default_positions = checker->robot().model.DefaultPositions();
  verdict.tip_travel_m = TipTravel(*checker, path, step_m,
                                   base_positions.empty() ? default_positions : base_positions);
  if (!JudgeEnds(space, path, start, goal, &verdict)) return verdict;
  if (!JudgeCollisions(checker, path, step_m, &verdict)) return verdict;
  verdict.valid = true;
  if (with_clearance) MeasureClearance(checker, path, step_m, &verdict);
  return verdict;
}

}  // namespace planbench
