// A planner of its own: the straight line from start to goal, if it is free.
#include "messaging/planner_main.h"
#include "planning/planner.h"

using namespace planbench;

class StraightLine : public Planner {
 public:
  explicit StraightLine(const Robot& robot) : Planner(robot) {}

  PlannerDescription Describe() const override {
    PlannerDescription description;
    description.algorithm = "Straight line";
    description.planner_class = PlannerClass::kSearchAndSample;
    description.deterministic = true;
    description.collision_models = {CollisionModel::kSpheres, CollisionModel::kMeshes};
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    SearchResult result;
    const Configuration& goal = query.goal().nominal;
    if (query.edges().IsValidEdge(query.start(), goal, /*from_is_free=*/true)) {
      result.status = PlanStatus::kSolved;
      result.path = {query.start(), goal};
    } else {
      result.status = PlanStatus::kExhausted;
      result.message = "the straight line is not free";
    }
    return result;
  }
};

int main(int argc, char** argv) {
  return PlannerMain(argc, argv, "straight", "The straight line from start to goal.",
                     [](const Robot& robot, const YamlNode& settings) {
                       settings.AllowOnly({});
                       return std::make_unique<StraightLine>(robot);
                     });
}
