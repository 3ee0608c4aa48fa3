#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "collision/collision_checker.h"
#include "collision/collision_model.h"
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

  virtual PlannerDescription Describe() const = 0;
  const Robot& robot() const { return *robot_; }

  /// Solves a request in its scene. Never throws for bad requests: they come back as
  /// kInvalidRequest with a message. The clock starts on entry (the caller has the scene).
  /// Deterministic up to the time limit: the same request gives the same path whatever ran before.
  /// A solution that comes after the time limit counts as kTimedOut. A search that breaks its
  /// contract (see SearchResult) aborts the process. `control` may be null.
  PlanResult Plan(const PlanRequest& request, const Scene& scene, PlanControl* control);

 protected:
  explicit Planner(const Robot& robot) : robot_(&robot) {}

  /// Throws InputError for bad parameters.
  virtual SearchResult Search(SearchQuery& query) = 0;

 private:
  void PlanInScene(const PlanRequest& request, const Scene& scene, PlanControl* control,
                   const Stopwatch& clock, PlanResult* result);
  CollisionChecker& CheckerFor(const PlanningGroup& group, CollisionModel model);

  const Robot* robot_;
  std::map<std::pair<std::string, CollisionModel>, std::unique_ptr<CollisionChecker>> checkers_;
};

}  // namespace planbench
