#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_checker.h"
#include "collision/collision_model.h"
#include "collision/edge_checker.h"
#include "common/stopwatch.h"
#include "planning/plan_control.h"
#include "planning/plan_request.h"
#include "planning/plan_result.h"
#include "planning/planner_description.h"
#include "planning/search_query.h"
#include "planning/search_result.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

struct ResolvedQuery;

/// A planner: resolves requests against the robot, sets the scene, checks start and goal, runs the
/// search in the asked direction, takes the times, and simplifies, all the same for every
/// algorithm. Only Search differs. tests/contract/planner_contract.h is the suite every planner
/// passes.
///
/// Not thread-safe: one request at a time. The robot must outlive it.
class Planner {
 public:
  virtual ~Planner() = default;
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;

  /// Always the same.
  virtual PlannerDescription Describe() const = 0;
  const Robot& robot() const { return *robot_; }

  /// Compiles those of Describe()'s collision models that are among `models` for every group, so
  /// that no request has to. Returns the rest of Describe()'s, and those that cannot be used, with
  /// the reason.
  std::map<CollisionModel, std::string> WarmUp(
      const std::vector<CollisionModel>& models = EnumValues<CollisionModel>());
  /// How often a robot was compiled for a model and a group: at most once at warming up, and again
  /// for other positions of the joints outside the group and another allowed-collision matrix. For
  /// tests.
  int num_compilations() const { return num_compilations_; }

  /// Solves a request in its scene. Never throws for bad requests: they come back as
  /// kInvalidRequest with a message. The clock starts when robot and meshes are compiled as the
  /// request has them, which only the first of requests that are alike in this has to wait for.
  /// Deterministic up to the time limit: the same request gives the same path whatever ran before.
  /// A solution that comes after the time limit counts as kTimedOut, one that is too long for a
  /// result (kMostResultWaypoints) as kMemoryLimit. A search that breaks its contract (see
  /// SearchResult) aborts the process. `control` may be null.
  PlanResult Plan(const PlanRequest& request, const Scene& scene, PlanControl* control);

 protected:
  explicit Planner(const Robot& robot) : robot_(&robot) {}

  /// Throws InputError for bad parameters.
  virtual SearchResult Search(SearchQuery& query) = 0;
  /// By end, what is known before any search: a lower bound of what paths between `q` and that goal
  /// cost, in the unit of SearchResult::cost, as SearchResult::lower_bound means it; 0: nothing.
  /// Asked of several goals. `query` lacks start and goal. Throws InputError for bad parameters.
  virtual std::vector<double> LowerBounds(const SearchQuery& /*query*/, const Configuration& /*q*/,
                                          std::span<const GoalBox> ends) {
    return std::vector<double>(ends.size(), 0.0);
  }
  /// How edges are sampled, for a planner that reproduces another system's way; nothing: as the
  /// request says, by `method` and at `resolution_m`. A setting tells of it
  /// (planning/told_edges.h).
  virtual std::optional<EdgeSampling> OwnEdgeSampling(const PlanningGroup& /*group*/,
                                                      EdgeCheck /*method*/,
                                                      double /*resolution_m*/) const {
    return std::nullopt;
  }

 private:
  /// A checker, and the state of the robot it is compiled for.
  struct Compiled {
    std::unique_ptr<CollisionChecker> checker;
    std::vector<double> held;
    AllowedCollisionMatrix allowed_collisions;
    std::vector<AttachedObject> attached;
  };

  /// For a request whose robot is compiled.
  EdgeChecker EdgesOf(const PlanningGroup& group, const PlanRequest& request);
  void PlanInScene(const PlanRequest& request, ResolvedQuery resolved, const Scene& scene,
                   PlanControl* control, const Stopwatch& clock, EdgeChecker* edges,
                   PlanResult* result);
  /// Searches for goals, all with valid nominal points, in turn until one is reached: first the one
  /// that a path is given to, then those to which paths may be the cheapest. Searches that can
  /// (SearchQuery::TurnIsOver) go round after round, each turn of twice the work of the round
  /// before; the others have one turn, each with a seed of its own, that of the nearest goal being
  /// the request's. Of k goals left in a round each has a k-th of the time that is left at most,
  /// with a path to it in hand all of it. As long as the search wants a better bound
  /// (SearchResult::wanted_epsilon) than is proven over all goals, the turns go on with the goals
  /// that stand against it.
  SearchResult SearchInTurn(const std::string& algorithm, const ResolvedQuery& resolved,
                            bool backward, SearchQuery* query);
  /// One turn of these: sets the ends of the query, and searches.
  SearchResult SearchFor(const std::string& algorithm, const GoalBox& goal,
                         const ResolvedQuery& resolved, bool backward, SearchQuery* query);
  /// Has a checker compiled for what it keeps from one scene to the next.
  void Compile(const PlanningGroup& group, CollisionModel model, const Scene& scene,
               std::span<const double> base_positions);

  const Robot* robot_;
  std::optional<PlannerDescription> description_;  // from the first request on
  std::map<std::pair<std::string, CollisionModel>, Compiled> compiled_;
  int num_compilations_ = 0;
};

}  // namespace planbench
