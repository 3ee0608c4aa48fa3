#include "planning/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <numeric>
#include <string>
#include <utility>
#include <variant>

#include "collision/rigid_bodies.h"
#include "common/content_hash.h"
#include "common/error.h"
#include "common/numbers.h"
#include "planning/free_goal.h"
#include "planning/peak_memory.h"
#include "planning/proven_bound.h"
#include "planning/resolve.h"
#include "planning/shortcut.h"

namespace planbench {
namespace {

/// Of shortcutting, on every path, whatever planner found it.
constexpr int kShortcutRounds = 4;

/// How long after the time limit a path may still be shortened. Of a path of thousands of waypoints
/// all pairs of them may be tried; and one that is handed over when its request has been cancelled
/// for being overdue (RequestExchange) counts as none, though it was found in time.
constexpr double kSimplificationGrace = 5;  // s

/// Work of a goal's first turn, of several that are searched for in turn (SearchQuery::TurnIsOver):
/// most searches have found a path by then, in some 10 ms, and so leave nothing to the others.
constexpr double kFirstTurnWork = 100'000;

/// Ends of a path may differ from the asked ones by this much (rad or m), the rounding of
/// interpolation.
constexpr double kEndRounding = 1e-9;

/// A hash of the path. The request's seed has drawn the numbers of the search; and where that does
/// not look at it, the answer is not to depend on it.
std::uint64_t ShortcutSeed(const Path& path) {
  ContentHash hash;
  for (const Configuration& q : path) hash.Add(q);
  return std::stoull(hash.HexDigest().substr(0, 16), nullptr, 16);
}

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
      step_m && !(*step_m >= kFinestEdgeResolution && *step_m <= kCoarsestEdgeResolution)) {
    throw InputError(fmt::format("{}: edge_resolution_m is {}, must be from {} to {}", origin,
                                 *step_m, kFinestEdgeResolution, kCoarsestEdgeResolution));
  }
  const std::vector<CollisionModel>& models = description.collision_models;
  if (std::find(models.begin(), models.end(), request.collision_model) == models.end()) {
    throw InputError(fmt::format("{}: {} does not offer collision model '{}'", origin,
                                 description.algorithm, EnumName(request.collision_model)));
  }
  if (request.direction == Direction::kBackward && !description.backward) {
    throw InputError(fmt::format("{}: {} cannot search backward", origin, description.algorithm));
  }
  if (!request.initial_path.empty() && !description.improve) {
    throw InputError(fmt::format("{}: {} does not improve paths", origin, description.algorithm));
  }
}

GoalBox PointGoal(const Configuration& q) { return {q, q, q}; }

bool EndsIn(const JointSpace& space, const Path& path, const GoalBox& goal) {
  return !path.empty() && goal.Contains(space, path.back());
}

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

/// The parts of a total that do not overlap, as shares of it. What is left is the search's.
void SetPhases(std::uint64_t total, std::uint64_t setup, std::uint64_t collision,
               std::uint64_t guidance, PlanResult* result) {
  const std::uint64_t parts = setup + collision + guidance;
  total = std::max({total, parts, std::uint64_t{1}});
  const double tick_s = result->total_time_s / static_cast<double>(total);
  result->phases.setup_s = tick_s * static_cast<double>(setup);
  result->phases.collision_s = tick_s * static_cast<double>(collision);
  result->phases.guidance_s = tick_s * static_cast<double>(guidance);
  result->phases.search_s = tick_s * static_cast<double>(total - parts);
}

/// A request that came to nothing before there was a search.
PlanResult Unsearched(PlanStatus status, const std::string& message, const Stopwatch& clock) {
  PlanResult result;
  result.status = status;
  result.message = message;
  result.planning_time_s = result.total_time_s = result.phases.setup_s = clock.seconds();
  return result;
}

bool HasMeshes(const Scene& scene) {
  for (const SceneObject& object : scene.objects) {
    for (const PlacedShape& placed : object.shapes) {
      if (std::holds_alternative<Mesh>(placed.shape)) return true;
    }
  }
  return false;
}

}  // namespace

void Planner::Compile(const PlanningGroup& group, CollisionModel model, const Scene& scene,
                      std::span<const double> base_positions) {
  Compiled& compiled = compiled_[{group.name, model}];
  std::vector<double> held = HeldPositions(robot_->model, group, base_positions);
  const bool is_compiled = compiled.checker && compiled.held == held &&
                           compiled.allowed_collisions == scene.allowed_collisions &&
                           compiled.attached == scene.attached;
  if (is_compiled && !HasMeshes(scene)) return;
  if (!compiled.checker) {
    compiled.checker = MakeCollisionChecker(*robot_, group, model);
  }
  compiled.held.clear();  // should the scene be refused
  compiled.checker->SetScene(scene, base_positions);
  compiled.held = std::move(held);
  compiled.allowed_collisions = scene.allowed_collisions;
  compiled.attached = scene.attached;
  if (!is_compiled) ++num_compilations_;
}

std::map<CollisionModel, std::string> Planner::WarmUp(const std::vector<CollisionModel>& models) {
  std::map<CollisionModel, std::string> unusable;
  Scene empty;
  empty.world_frame = robot_->model.links().front().name;
  const std::vector<double> positions = robot_->model.DefaultPositions();
  for (const CollisionModel model : Describe().collision_models) {
    if (std::find(models.begin(), models.end(), model) == models.end()) {
      unusable[model] = "not among --collision-models";
      continue;
    }
    try {
      for (const PlanningGroup& group : robot_->groups) Compile(group, model, empty, positions);
    } catch (const InputError& error) {
      unusable[model] = error.what();
    }
  }
  return unusable;
}

PlanResult Planner::Plan(const PlanRequest& request, const Scene& scene, PlanControl* control) {
  ResetPeakMemory();
  Stopwatch clock;
  PlanResult result;
  try {
    const std::string origin =
        request.request_id.empty() ? "request" : "request " + request.request_id;
    if (!description_) description_ = Describe();
    RequireValid(request, *description_, origin);
    const PlanningGroup& group = robot_->Group(request.group);
    ResolvedQuery resolved = ResolveQuery(*robot_, group, request.start, request.goal, origin);
    resolved.initial_path = ResolveInitialPath(group, resolved, request.initial_joint_names,
                                               request.initial_path, origin);
    Compile(group, request.collision_model, scene, resolved.base_positions);
    // Not on the clock: whoever first asks for much memory has to wait until what the reading of
    // scenes left in small pieces is swept together.
    EdgeChecker edges = EdgesOf(group, request);
    PlanControl unwatched;
    clock = Stopwatch();
    PlanInScene(request, std::move(resolved), scene, control != nullptr ? control : &unwatched,
                clock, &edges, &result);
  } catch (const InputError& error) {
    result = Unsearched(PlanStatus::kInvalidRequest, error.what(), clock);
  } catch (const std::bad_alloc&) {
    result = Unsearched(PlanStatus::kMemoryLimit, "out of memory", clock);
  }
  result.peak_memory_mb = PeakMemoryMb();
  return result;
}

SearchResult Planner::SearchInTurn(const std::string& algorithm, const ResolvedQuery& resolved,
                                   bool backward, SearchQuery* query) {
  const std::vector<GoalBox>& goals = resolved.goals;
  std::vector<double> lower_bounds(goals.size(), 0.0);  // of the costs of paths to the goals
  std::vector<std::size_t> waiting(goals.size());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  if (goals.size() > 1) {
    std::vector<GoalBox> ends = goals;
    if (backward) {
      for (GoalBox& end : ends) end = PointGoal(end.nominal);
    }
    lower_bounds = LowerBounds(*query, resolved.start, ends);
    std::stable_sort(waiting.begin(), waiting.end(), [&](std::size_t a, std::size_t b) {
      return lower_bounds[a] < lower_bounds[b];
    });
    std::stable_partition(waiting.begin(), waiting.end(), [&](std::size_t i) {
      return EndsIn(query->space(), resolved.initial_path, goals[i]);
    });
  }
  const std::vector<double> known_before = lower_bounds;
  const std::uint64_t seed = query->seed_;

  SearchResult found;  // the best path or, without one, what came of the goals so far
  bool has_path = false;
  std::vector<std::size_t> later;     // whose searches go on in the next round
  std::vector<std::size_t> given_up;  // for want of time or memory
  SearchResult last_given_up;         // its status and message
  std::vector<std::size_t> enough;    // is proven of them for the path in hand
  double turn_work = kFirstTurnWork;
  while (!waiting.empty()) {
    const std::size_t num_left = waiting.size();  // in this round
    const std::size_t turn = waiting.front();
    waiting.erase(waiting.begin());
    // A search that goes on knows itself what of its proof still holds: its space may grow.
    if (!has_path || query->IsKept(turn)) lower_bounds[turn] = known_before[turn];
    query->turn_ = turn;
    query->seed_ = seed + turn;  // lest all turns draw alike
    query->turn_ends_work_ = num_left > 1 || !later.empty() ? query->Work() + turn_work : kInfinity;
    query->known_cost_ = has_path ? found.cost : kInfinity;
    query->lower_bound_ = std::exchange(lower_bounds[turn], kInfinity);
    query->lower_bound_of_others_ = *std::min_element(lower_bounds.begin(), lower_bounds.end());
    if (const auto count = found.counters.find("expansions"); count != found.counters.end()) {
      query->expansions_before_ = static_cast<std::int64_t>(count->second);
    }
    if (num_left > 1) {
      query->turn_ends_s_ = query->time_limit_s_ - query->RemainingSeconds() *
                                                       static_cast<double>(num_left - 1) /
                                                       static_cast<double>(num_left);
    }
    const auto num_told = static_cast<std::ptrdiff_t>(query->progress_.size());
    SearchResult next;
    try {
      next = SearchFor(algorithm, goals[turn], resolved, backward, query);
    } catch (const std::bad_alloc&) {
      if (!has_path) throw;
      // The path in hand stands. What this turn told is lost with its search.
      query->progress_.erase(query->progress_.begin() + num_told, query->progress_.end());
      query->turn_ends_s_.reset();
      lower_bounds[turn] = query->lower_bound_;
      break;
    }
    lower_bounds[turn] = std::max(query->lower_bound_, next.lower_bound);
    const bool cut_short = query->edges().Stopped() || (num_left > 1 && query->ShouldStop());
    if (cut_short && next.status == PlanStatus::kExhausted) {
      // Of a space that lacks the edge given up, or of some of the goals.
      next.status = query->Cancelled() ? PlanStatus::kCancelled : PlanStatus::kTimedOut;
    }
    const PlanStatus status = next.status;  // of this turn
    if (query->IsKept(turn)) {
      later.push_back(turn);
    } else if (status == PlanStatus::kTimedOut || status == PlanStatus::kMemoryLimit) {
      given_up.push_back(turn);
      last_given_up.status = status;
      last_given_up.message = next.message;
    }
    for (const auto& [name, count] : found.counters) next.counters[name] += count;
    next.guidance_ticks += found.guidance_ticks;
    if (has_path && !(next.status == PlanStatus::kSolved && next.cost < found.cost)) {
      found.counters = std::move(next.counters);
      found.guidance_ticks = next.guidance_ticks;
      found.remains = std::move(next.remains);
    } else {
      if (next.status == PlanStatus::kExhausted && !(later.empty() && given_up.empty())) {
        const SearchResult& theirs = later.empty() ? last_given_up : found;
        next.status = theirs.status;
        next.message = theirs.message;
      }
      found = std::move(next);
    }
    if (found.status == PlanStatus::kSolved) {
      if (!has_path) waiting.insert(waiting.end(), given_up.begin(), given_up.end());
      has_path = true;
      const auto suffices = [&](std::size_t i) {
        if (found.wanted_epsilon > 0 && found.cost > found.wanted_epsilon * lower_bounds[i]) {
          return false;
        }
        enough.push_back(i);
        return true;
      };
      std::erase_if(waiting, suffices);
      std::erase_if(later, suffices);
    } else if (status == PlanStatus::kCancelled) {
      break;
    }
    if (query->ShouldStop()) break;
    if (waiting.empty()) {
      waiting.swap(later);
      turn_work *= 2;
    }
    if (!waiting.empty()) {  // Makes room for the next goal's search.
      found.remains.reset();
      for (const std::size_t i : enough) query->TakeKeptOf(i);
    }
  }
  found.lower_bound = *std::min_element(lower_bounds.begin(), lower_bounds.end());
  return found;
}

SearchResult Planner::SearchFor(const std::string& algorithm, const GoalBox& goal,
                                const ResolvedQuery& resolved, bool backward, SearchQuery* query) {
  EdgeChecker& edges = query->edges();
  query->start_ = backward ? goal.nominal : resolved.start;
  query->goal_ = backward ? PointGoal(resolved.start) : goal;
  query->initial_path_ = {};
  const Path& initial = resolved.initial_path;
  if (EndsIn(edges.space(), initial, goal)) {
    query->initial_path_ = initial;
    if (backward) {
      query->start_ = initial.back();
      std::reverse(query->initial_path_.begin(), query->initial_path_.end());
    }
  }
  // A turn ends between edges where there are more: one given up would have to be checked anew.
  edges.StopWhen([query] { return query->GoesOn() ? query->IsOver() : query->ShouldStop(); });
  SearchResult result = Search(*query);
  query->turn_ends_s_.reset();
  RequireSearchStatus(algorithm, result.status);
  if (result.status == PlanStatus::kSolved) {
    AcceptPath(*query, algorithm, &result.path);
    if (backward) std::reverse(result.path.begin(), result.path.end());
  }
  return result;
}

EdgeChecker Planner::EdgesOf(const PlanningGroup& group, const PlanRequest& request) {
  CollisionChecker* checker = compiled_.at({group.name, request.collision_model}).checker.get();
  const EdgeCheck method = request.edge_check.value_or(robot_->edge_check);
  const double resolution_m = request.edge_resolution_m.value_or(robot_->edge_resolution_m);
  std::optional<EdgeSampling> own_sampling = OwnEdgeSampling(group, method, resolution_m);
  return own_sampling ? EdgeChecker(checker, std::move(*own_sampling))
                      : EdgeChecker(checker, resolution_m, method);
}

void Planner::PlanInScene(const PlanRequest& request, ResolvedQuery resolved, const Scene& scene,
                          PlanControl* control, const Stopwatch& clock, EdgeChecker* edges,
                          PlanResult* result) {
  const PlannerDescription& description = *description_;
  // Even for the scene of the request before: what a request costs must not depend on its place in
  // the run.
  edges->checker().SetScene(scene, resolved.base_positions);
  const std::uint64_t setup_ticks = clock.ticks();

  SearchQuery query;
  const bool backward = request.direction == Direction::kBackward;
  query.scene_ = &scene;
  query.base_positions_ = &resolved.base_positions;
  query.edges_ = edges;
  query.seed_ = request.seed;
  query.anytime_ = request.anytime && description.anytime;
  query.parameters_ = &request.parameters;
  query.control_ = control;
  query.clock_ = clock;
  query.time_limit_s_ = request.time_limit_s;

  SearchResult found;
  GoalFinding goals;
  if (std::string fault = FindFault(edges, resolved.start, "start"); !fault.empty()) {
    found.status = PlanStatus::kStartInvalid;
    found.message = std::move(fault);
  } else if (std::any_of(resolved.goals.begin(), resolved.goals.end(), [&](const GoalBox& goal) {
               return goal.Contains(edges->space(), resolved.start);
             })) {
    found.status = PlanStatus::kSolved;
    found.path = {resolved.start};
    if (description.anytime) {
      found.lower_bound = kInfinity;  // No other path costs less than none.
      query.ReportSolution(found.lower_bound, found.cost, 0);
    }
  } else if (goals = KeepFreeGoals(edges, resolved.start, &resolved.goals,
                                   [&query] { return query.ShouldStop(); });
             goals.verdict == GoalVerdict::kInvalid) {
    found.status = PlanStatus::kGoalInvalid;
    found.message = std::move(goals.fault);
  } else if (goals.verdict == GoalVerdict::kUndecided) {
    const bool cancelled = query.Cancelled();
    found.status = cancelled ? PlanStatus::kCancelled : PlanStatus::kTimedOut;
    found.message = std::move(goals.fault) +
                    (cancelled ? " before the request was cancelled" : " before the time limit");
  } else {
    found = SearchInTurn(description.algorithm, resolved, backward, &query);
  }

  result->total_time_s = clock.seconds();
  result->planning_time_s =
      query.progress_.empty() ? result->total_time_s : query.progress_.front().elapsed_s;
  const EdgeChecker::Counters counters = edges->counters();
  SetPhases(clock.ticks(), setup_ticks, counters.ticks, found.guidance_ticks, result);
  result->status = found.status;
  found.remains.reset();
  query.kept_.clear();
  result->message = std::move(found.message);
  result->progress = std::move(query.progress_);
  result->counters = std::move(found.counters);
  result->counters.merge(found.path_counters);
  result->counters["edges_checked"] = static_cast<double>(counters.edges);
  result->counters["configurations_checked"] = static_cast<double>(counters.configurations);
  if (result->status != PlanStatus::kSolved) return;

  if (query.path_held_s_.value_or(result->planning_time_s) > request.time_limit_s) {
    // Between two looks at the clock: a solution after the limit is none, however late the search
    // noticed.
    result->status = PlanStatus::kTimedOut;
    result->message = fmt::format("solved after {:.6f} s, beyond the time limit of {} s",
                                  result->planning_time_s, request.time_limit_s);
    return;
  }
  // A search that still wanted a better bound when the limit came had its path by then.
  result->planning_time_s = std::min(result->planning_time_s, request.time_limit_s);
  if (std::string fault = WhyTooLong(found.path); !fault.empty()) {
    result->status = PlanStatus::kMemoryLimit;
    result->message = std::move(fault);
    return;
  }
  result->path = std::move(found.path);
  result->epsilon = ToldEpsilon(found.cost, found.lower_bound);
  result->cost = found.cost;
  if (!request.simplify) return;
  const Stopwatch simplification;
  const auto should_stop = [&query] {
    return query.Cancelled() || query.RemainingSeconds() < -kSimplificationGrace;
  };
  edges->StopWhen(should_stop);
  result->simplified_path =
      ShortcutPath(edges, result->path, ShortcutSeed(result->path), kShortcutRounds, should_stop);
  // Cut corners are waypoints more.
  if (!WhyTooLong(result->simplified_path).empty()) result->simplified_path = result->path;
  result->phases.simplification_s = simplification.seconds();
}

}  // namespace planbench
