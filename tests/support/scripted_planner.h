#pragma once

#include <functional>
#include <utility>

#include "planning/planner.h"

namespace planbench {

/// A planner whose search is a function of the test.
class ScriptedPlanner final : public Planner {
 public:
  using Script = std::function<SearchResult(SearchQuery&)>;
  ScriptedPlanner(const Robot& robot, Script script, PlannerDescription description = Able())
      : Planner(robot), description(std::move(description)), script_(std::move(script)) {}

  /// Everything but meshes.
  static PlannerDescription Able() {
    PlannerDescription description;
    description.algorithm = "scripted";
    description.backward = true;
    description.anytime = true;
    description.bidirectional = true;
    description.deterministic = true;
    description.collision_models = {CollisionModel::kSpheres};
    description.settings = {{"key", "value"}};
    return description;
  }

  PlannerDescription Describe() const override { return description; }

  PlannerDescription description;
  int num_searches = 0;

 protected:
  SearchResult Search(SearchQuery& query) override {
    ++num_searches;
    return script_(query);
  }

 private:
  Script script_;
};

/// A search that found nothing.
inline SearchResult Ended(PlanStatus status) {
  SearchResult result;
  result.status = status;
  result.message = "because";
  return result;
}

/// The straight line, whatever is in its way.
inline SearchResult StraightLine(const SearchQuery& query) {
  SearchResult result;
  result.status = PlanStatus::kSolved;
  result.path = {query.start(), query.goal().nominal};
  return result;
}

}  // namespace planbench
