#include "planning/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>

#include "common/error.h"
#include "planning/peak_memory.h"
#include "planning/resolve.h"
#include "planning/shortcut.h"

namespace planbench {
namespace {

/// Random shortcuts tried on every path, whatever planner found it.
constexpr int kShortcutAttempts = 200;

/// Ends of a path may differ from the asked ones by this much (rad or m), the rounding of
/// interpolation.
constexpr double kEndRounding = 1e-9;

[[noreturn]] void BrokenInvariant(const std::string& algorithm, const std::string& what) {
  fmt::print(stderr, "{}: broken invariant: {}\n", algorithm, what);
  std::abort();
}

void RequireValid(const PlanRequest& request, const PlannerDescription& description,
                  const std::string& origin) {
  if (!(request.time_limit_s > 0)) {
    throw InputError(fmt::format("{}: time_limit_s is {}, must be greater than zero", origin,
                                 request.time_limit_s));
  }
  if (const auto step_m = request.edge_resolution_m;
      step_m && (!(*step_m > 0) || !std::isfinite(*step_m))) {
    throw InputError(
        fmt::format("{}: edge_resolution_m is {}, must be a positive number", origin, *step_m));
  }
  const std::vector<CollisionModel>& models = description.collision_models;
  if (std::find(models.begin(), models.end(), request.collision_model) == models.end()) {
    throw InputError(fmt::format("{}: {} does not offer collision model '{}'", origin,
                                 description.algorithm, EnumName(request.collision_model)));
  }
  if (request.direction == Direction::kBackward && !description.backward) {
    throw InputError(fmt::format("{}: {} cannot search backward", origin, description.algorithm));
  }
}

/// Why a state is not valid, in one line; empty if it is valid.
std::string FindFault(EdgeChecker* edges, const Configuration& q, std::string_view what) {
  if (edges->IsValidState(q)) return "";
  const JointSpace& space = edges->space();
  const int j = space.FirstOutsideLimits(q);
  if (j >= 0) {
    const JointSpace::Joint& joint = space.joint(j);
    return fmt::format("{}: joint '{}' at {} is outside its limits [{}, {}]", what, joint.name,
                       q[static_cast<std::size_t>(j)], joint.lower, joint.upper);
  }
  const std::optional<Contact> contact = edges->checker().FindContact(q);
  if (!contact) return fmt::format("{} is in collision", what);
  return fmt::format("{} is in collision: {}", what, Describe(*contact));
}

GoalBox PointGoal(const Configuration& q) { return {q, q, q}; }

/// Holds the search to its contract: what it returns is what every table is made of. Gives the ends
/// of the path exactly the asked values (a continuous joint may have come back wrapped).
void AcceptPath(const SearchQuery& query, const std::string& algorithm, Path* path) {
  const JointSpace& space = query.space();
  if (path->empty()) BrokenInvariant(algorithm, "solved without a path");
  for (const Configuration& q : *path) {
    if (q.size() != static_cast<std::size_t>(space.size())) {
      BrokenInvariant(algorithm, "a waypoint of the path has the wrong size");
    }
  }
  if (!(space.Distance(path->front(), query.start()) <= kEndRounding)) {
    BrokenInvariant(algorithm, "the path does not begin at the start");
  }
  if (!query.goal().Contains(space, path->back())) {
    BrokenInvariant(algorithm, "the path does not end in the goal");
  }
  if (path->size() == 1) return;
  path->front() = query.start();
  if (space.Distance(path->back(), query.goal().nominal) <= kEndRounding) {
    path->back() = query.goal().nominal;
  }
}

void RequireSearchStatus(const std::string& algorithm, PlanStatus status) {
  constexpr std::array kAllowed = {PlanStatus::kSolved, PlanStatus::kTimedOut,
                                   PlanStatus::kExhausted, PlanStatus::kCancelled,
                                   PlanStatus::kMemoryLimit};
  if (std::find(kAllowed.begin(), kAllowed.end(), status) == kAllowed.end()) {
    BrokenInvariant(algorithm, fmt::format("the search returned status {}", EnumName(status)));
  }
}

}  // namespace

CollisionChecker& Planner::CheckerFor(const PlanningGroup& group, CollisionModel model) {
  std::unique_ptr<CollisionChecker>& checker = checkers_[{group.name, model}];
  if (!checker) checker = MakeCollisionChecker(*robot_, group, model);
  return *checker;
}

PlanResult Planner::Plan(const PlanRequest& request, const Scene& scene, PlanControl* control) {
  ResetPeakMemory();
  const Stopwatch clock;
  PlanResult result;
  try {
    PlanControl unwatched;
    PlanInScene(request, scene, control != nullptr ? control : &unwatched, clock, &result);
  } catch (const InputError& error) {
    result = {};
    result.status = PlanStatus::kInvalidRequest;
    result.message = error.what();
    result.planning_time_s = result.total_time_s = clock.seconds();
  } catch (const std::bad_alloc&) {
    result = {};
    result.status = PlanStatus::kMemoryLimit;
    result.message = "out of memory";
    result.planning_time_s = result.total_time_s = clock.seconds();
  }
  result.peak_memory_mb = PeakMemoryMb();
  return result;
}

void Planner::PlanInScene(const PlanRequest& request, const Scene& scene, PlanControl* control,
                          const Stopwatch& clock, PlanResult* result) {
  const std::string origin =
      request.request_id.empty() ? "request" : "request " + request.request_id;
  const PlannerDescription description = Describe();
  RequireValid(request, description, origin);
  const PlanningGroup& group = robot_->Group(request.group);
  const ResolvedQuery resolved = ResolveQuery(*robot_, group, request.start, request.goal, origin);
  CollisionChecker& checker = CheckerFor(group, request.collision_model);
  // Even for the scene of the request before: what a request costs must not depend on its place in
  // the run.
  checker.SetScene(scene, resolved.base_positions);
  EdgeChecker edges(&checker, request.edge_resolution_m.value_or(robot_->edge_resolution_m),
                    request.edge_check.value_or(robot_->edge_check));
  result->phases.setup_s = clock.seconds();

  SearchQuery query;
  const bool backward = request.direction == Direction::kBackward;
  query.start_ = backward ? resolved.goal.nominal : resolved.start;
  query.goal_ = backward ? PointGoal(resolved.start) : resolved.goal;
  query.scene_ = &scene;
  query.base_positions_ = &resolved.base_positions;
  query.edges_ = &edges;
  query.seed_ = request.seed;
  query.anytime_ = request.anytime && description.anytime;
  query.parameters_ = &request.parameters;
  query.control_ = control;
  query.clock_ = clock;
  query.time_limit_s_ = request.time_limit_s;

  SearchResult found;
  if (std::string fault = FindFault(&edges, resolved.start, "start"); !fault.empty()) {
    found.status = PlanStatus::kStartInvalid;
    found.message = std::move(fault);
  } else if (fault = FindFault(&edges, resolved.goal.nominal, "goal"); !fault.empty()) {
    found.status = PlanStatus::kGoalInvalid;
    found.message = std::move(fault);
  } else if (resolved.goal.Contains(group.space, resolved.start)) {
    found.status = PlanStatus::kSolved;
    found.path = {resolved.start};
  } else {
    edges.StopWhen([&query] { return query.ShouldStop(); });
    found = Search(query);
    RequireSearchStatus(description.algorithm, found.status);
    if (edges.Stopped() && found.status == PlanStatus::kExhausted) {
      // Of a space that lacks the edge given up.
      found.status = query.Cancelled() ? PlanStatus::kCancelled : PlanStatus::kTimedOut;
    }
    if (found.status == PlanStatus::kSolved) {
      AcceptPath(query, description.algorithm, &found.path);
      if (backward) std::reverse(found.path.begin(), found.path.end());
    }
  }

  result->total_time_s = clock.seconds();
  result->planning_time_s =
      query.progress_.empty() ? result->total_time_s : query.progress_.front().elapsed_s;
  const EdgeChecker::Counters counters = edges.counters();
  result->phases.collision_s = counters.seconds;
  result->phases.guidance_s = found.guidance_s;
  result->phases.search_s = std::max(
      0.0, result->total_time_s - result->phases.setup_s - counters.seconds - found.guidance_s);
  result->status = found.status;
  result->message = std::move(found.message);
  result->progress = std::move(query.progress_);
  result->counters = std::move(found.counters);
  result->counters["edges_checked"] = static_cast<double>(counters.edges);
  result->counters["configurations_checked"] = static_cast<double>(counters.configurations);
  if (result->status != PlanStatus::kSolved) return;

  if (result->planning_time_s > request.time_limit_s) {
    // Between two looks at the clock: a solution after the limit is none, however late the search
    // noticed.
    result->status = PlanStatus::kTimedOut;
    result->message = fmt::format("solved after {:.6f} s, beyond the time limit of {} s",
                                  result->planning_time_s, request.time_limit_s);
    return;
  }
  result->path = std::move(found.path);
  result->epsilon = found.epsilon;
  result->cost = found.cost;
  if (!request.simplify) return;
  const ScopedTimer timer(&result->phases.simplification_s);
  edges.StopWhen([&query] { return query.Cancelled(); });
  result->simplified_path = ShortcutPath(&edges, result->path, request.seed, kShortcutAttempts,
                                         [&query] { return query.Cancelled(); });
}

}  // namespace planbench
