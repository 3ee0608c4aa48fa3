#include "planner_ara/ara_planner.h"

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "common/error.h"
#include "planner_ara/ara_settings.h"
#include "planner_ara/ara_star.h"
#include "planner_ara/manipulation_graph.h"

namespace planbench {
namespace {

class AraPlanner : public Planner {
 public:
  AraPlanner(const Robot& robot, const YamlNode& node) : Planner(robot), origin_(node.Where()) {
    settings_.Apply(node);
    settings_.Validate(origin_);
    const auto require_known = [&](const std::string& key, const auto& by_joint) {
      for (const auto& [joint, value] : by_joint) {
        if (robot.model.FindJoint(joint) >= 0) continue;
        node.At(key).At(joint).Fail("the robot has no joint of that name");
      }
    };
    require_known("discretization", settings_.discretization);
    require_known("joint_weights", settings_.joint_weights);
    Options(settings_, robot.Group("").space, origin_);
  }

  PlannerDescription Describe() const override {
    PlannerDescription description;
    description.algorithm = "ARA*";
    description.planner_class = PlannerClass::kSampleThenSearch;
    description.backward = true;
    description.anytime = true;
    description.collision_models = AvailableCollisionModels();
    description.settings = settings_.AsText();
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    const AraSettings settings = SettingsFor(query);
    ManipulationGraphOptions options = Options(settings, query.space(), origin_);
    options.remember_edges = query.anytime();
    ManipulationGraph graph(&query.edges(), query.start(), query.goal(), std::move(options));
    AraStar<ManipulationGraph> search(&graph, ManipulationGraph::kStart, ManipulationGraph::kGoal);

    const double memory_limit = settings.memory_limit_mb * 1024 * 1024;
    bool out_of_memory = false;
    const auto should_stop = [&] {
      out_of_memory = static_cast<double>(graph.bytes() + search.bytes()) > memory_limit;
      return out_of_memory || query.ShouldStop();
    };

    double reported_bound = std::numeric_limits<double>::infinity();
    ImproveOutcome outcome = ImproveOutcome::kStopped;
    std::optional<double> epsilon = settings.epsilon.initial;
    while (epsilon) {
      outcome = search.ImprovePath(*epsilon, should_stop);
      if (search.bound() < reported_bound) {
        reported_bound = search.bound();
        query.ReportSolution(search.bound(), search.goal_cost(), search.num_expansions());
      }
      if (outcome != ImproveOutcome::kConverged || !query.anytime()) break;
      epsilon = settings.epsilon.Next(*epsilon, search.bound());
    }

    SearchResult result;
    result.counters = {
        {"expansions", static_cast<double>(search.num_expansions())},
        {"states", static_cast<double>(graph.num_states())},
        {"edges_generated", static_cast<double>(search.num_edges_generated())},
        {"goal_connections_tried", static_cast<double>(graph.num_goal_connections_tried())},
        {"search_iterations", static_cast<double>(search.num_iterations())},
    };
    const std::vector<PathStep> steps = search.Path();
    if (!steps.empty()) {
      result.status = PlanStatus::kSolved;
      result.path = graph.Configurations(steps);
      result.epsilon = search.bound();
      result.cost = search.goal_cost();
    } else if (outcome == ImproveOutcome::kExhausted) {
      result.status = PlanStatus::kExhausted;
      result.message = "the lattice holds no path to the goal";
    } else if (out_of_memory) {
      result.status = PlanStatus::kMemoryLimit;
      result.message = "the search reached memory_limit_mb";
    } else if (query.Cancelled()) {
      result.status = PlanStatus::kCancelled;
      result.message = "cancelled before a path was found";
    } else {
      result.status = PlanStatus::kTimedOut;
      result.message = "the time limit came before a path was found";
    }
    return result;
  }

 private:
  AraSettings SettingsFor(const SearchQuery& query) const {
    AraSettings settings = settings_;
    for (const auto& [key, text] : query.parameters()) {
      YamlNode node = YamlNode::Parse("", "parameter " + key);
      node.Override(key, text, "parameter " + key);
      settings.Apply(node);
    }
    settings.Validate("request parameters");
    return settings;
  }

  ManipulationGraphOptions Options(const AraSettings& settings, const JointSpace& space,
                                   const std::string& origin) const {
    return ResolveOptions(settings, space, (robot().folder / settings.primitives).string(), origin);
  }

  std::string origin_;  // of the settings
  AraSettings settings_;
};

}  // namespace

std::unique_ptr<Planner> MakeAraPlanner(const Robot& robot, const YamlNode& settings) {
  return std::make_unique<AraPlanner>(robot, settings);
}

}  // namespace planbench
