#include "planning/path_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/error.h"
#include "planning/path_samples.h"

namespace planbench {
namespace {

constexpr double kEndTolerance = 1e-6;  // rad or m

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

const char* UnitOf(const JointSpace::Joint& joint) { return joint.prismatic ? "m" : "rad"; }

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
                         ? fmt::format("waypoint {}: joint '{}' at {:.8g} {} is outside {}", i,
                                       joint.name, position, UnitOf(joint), space.DescribeLimits(j))
                         : fmt::format("waypoint {}: joint '{}' is {}, not a finite number", i,
                                       joint.name, position),
                     i);
      return false;
    }
  }
  return true;
}

bool IsIn(const JointSpace& space, GoalBox goal, const Configuration& q) {
  for (double& lower : goal.lower) lower -= kEndTolerance;
  for (double& upper : goal.upper) upper += kEndTolerance;
  return goal.Contains(space, q);
}

/// False, with the reason, if the path does not run from the start to one of the goals.
bool JudgeEnds(const JointSpace& space, const Path& path, std::span<const double> start,
               const std::vector<GoalBox>& goals, PathVerdict* verdict) {
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double off = space.Difference(j, start[k], path.front()[k]);
    if (std::abs(off) > kEndTolerance) {
      RejectWaypoint(
          verdict,
          fmt::format("the path does not begin at the start: joint '{}' is {:.3g} {} away",
                      space.joint(j).name, std::abs(off), UnitOf(space.joint(j))),
          0);
      return false;
    }
  }
  if (std::none_of(goals.begin(), goals.end(),
                   [&](const GoalBox& goal) { return IsIn(space, goal, path.back()); })) {
    RejectWaypoint(verdict, "the path does not end in the goal", path.size() - 1);
    return false;
  }
  return true;
}

double CountSamples(const EdgeChecker& edges, const Path& path) {
  double samples = 1;
  for (std::size_t i = 1; i < path.size(); ++i) samples += edges.NumIntervals(path[i - 1], path[i]);
  return samples;
}

/// False, with the reason, if the path is too long at any step.
bool JudgeLength(const EdgeChecker& edges, const Path& path, PathVerdict* verdict) {
  double motion_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    motion_m += edges.checker().motion_bound().Between(edges.space(), path[i - 1], path[i]);
  }
  if (motion_m <= kMaxPathMotion) return true;
  verdict->reason = fmt::format(
      "the path is too long: points of the robot move by up to {:.3g} m on it", motion_m);
  return false;
}

bool JudgeCollisions(const EdgeChecker& edges, const Path& path, PathVerdict* verdict) {
  CollisionChecker& checker = edges.checker();
  bool free = true;
  VisitSamples(edges, path, [&](int segment, double fraction, const Configuration& q, double) {
    ++verdict->num_samples;
    if (checker.IsFree(q)) return true;
    free = false;
    verdict->contact = checker.FindContact(q);
    const std::string bodies = verdict->contact ? Describe(*verdict->contact) : "no contact found";
    Reject(verdict, fmt::format("collision on segment {} at {:.3f}: {}", segment, fraction, bodies),
           segment, fraction);
    return false;
  });
  return free;
}

}  // namespace

PathVerdict JudgePath(CollisionChecker* checker, const Path& path, std::span<const double> start,
                      const std::vector<GoalBox>& goals, double step_m, bool with_clearance,
                      std::span<const double> base_positions) {
  if (!(step_m > 0) || !std::isfinite(step_m)) {
    throw InputError(fmt::format("path check: step_m is {}, must be greater than zero", step_m));
  }
  const JointSpace& space = checker->space();
  const auto n = static_cast<std::size_t>(space.size());
  const auto fits = [n](const GoalBox& goal) {
    return goal.nominal.size() == n && goal.lower.size() == n && goal.upper.size() == n;
  };
  if (start.size() != n || !std::all_of(goals.begin(), goals.end(), fits)) {
    throw InputError(
        fmt::format("path check: start and goal must have {} positions each", space.size()));
  }
  const EdgeChecker edges(checker, step_m, EdgeCheck::kFixed);
  PathVerdict verdict;
  if (!JudgeWaypoints(space, path, &verdict)) return verdict;
  const bool fits_ends = JudgeEnds(space, path, start, goals, &verdict);
  if (fits_ends && !JudgeLength(edges, path, &verdict)) return verdict;
  if (CountSamples(edges, path) > kMaxPathSamples) {
    if (!fits_ends) return verdict;
    throw InputError(fmt::format(
        "at a step_m of {} m the path has more than {:.0f} samples, which are not judged: "
        "choose a larger one (--referee-step)",
        step_m, kMaxPathSamples));
  }
  verdict.valid = fits_ends && JudgeCollisions(edges, path, &verdict);
  const std::vector<double> default_positions = checker->robot().model.DefaultPositions();
  PathSurvey survey(edges, path, base_positions.empty() ? default_positions : base_positions);
  verdict.measures = TakeMeasures(&survey, with_clearance && verdict.valid);
  return verdict;
}

}  // namespace planbench
