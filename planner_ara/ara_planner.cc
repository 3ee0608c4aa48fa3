#include "planner_ara/ara_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/content_hash.h"
#include "common/error.h"
#include "common/named_file.h"
#include "common/numbers.h"
#include "planner_ara/ara_settings.h"
#include "planner_ara/manipulation_graph.h"
#include "planner_ara/two_way_search.h"
#include "planning/experience.h"
#include "planning/proven_bound.h"

namespace planbench {
namespace {

/// The search for one goal, in one turn or several.
struct GoalSearch {
  GoalSearch(const SearchQuery& query, const ManipulationGraphOptions& options,
             const AraSettings& settings)
      : two_way(&query.edges(), query.start(), query.goal(), options, settings.two_way),
        epsilon(settings.epsilon.initial) {}

  TwoWaySearch two_way;
  std::optional<double> epsilon;  // to be proven
  TwoWaySearch::Counts before;    // the turn
};

class AraPlanner : public Planner {
 public:
  AraPlanner(const Robot& robot, const YamlNode& node) : Planner(robot), origin_(node.Where()) {
    settings_.Apply(node);
    settings_.Validate(origin_);
    RequireKnownJoints(node);
    const PlanningGroup& group = robot.Group("");
    if (!settings_.primitives.empty()) {
      primitives_ = ReadNamedFile(node.At("primitives"), robot.folder);
      // The file may change while its name stays.
      ContentHash hash;
      hash.Add(primitives_.text);
      primitives_id_ = hash.HexDigest();
    }
    options_.emplace(group.name, ResolveOptions(settings_, primitives_, robot, group, origin_));
    OwnEdgeSampling(group, EdgeCheck::kFixed, 1);  // throws now rather than at the first request
    if (!settings_.experience.empty()) experience_.emplace(robot, node.At("experience"));
  }

  PlannerDescription Describe() const override {
    PlannerDescription description;
    description.algorithm = settings_.VariantName();
    description.planner_class = PlannerClass::kSearchAndSample;
    description.anytime = true;
    description.bidirectional = settings_.two_way;
    description.deterministic = true;
    description.collision_models = EnumValues<CollisionModel>();
    description.settings = settings_.AsText();
    if (!primitives_id_.empty()) description.settings["primitives_id"] = primitives_id_;
    if (experience_) experience_->Describe(&description.settings);
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    const AraSettings settings = SettingsFor(query);
    auto goal_search = std::static_pointer_cast<GoalSearch>(query.TakeKept());
    if (!goal_search) goal_search = Begin(query, settings);
    TwoWaySearch& search = goal_search->two_way;

    const double memory_limit = settings.memory_limit_mb * 1024 * 1024;
    const auto is_full = [&] {
      return static_cast<double>(search.bytes() + query.KeptBytes()) > memory_limit;
    };
    bool out_of_memory = false;
    const auto should_stop = [&] {
      out_of_memory = is_full();
      while (out_of_memory && query.KeptBytes() > 0) {
        query.DropLastKept();
        out_of_memory = is_full();
      }
      return out_of_memory || query.ShouldStop() || query.TurnIsOver();
    };

    double lower_bound = 0;
    // Without wrapping nothing is proven.
    const auto told_lower_bound = [&] { return settings.wrap_heuristic ? lower_bound : 0; };
    bool reported = false;
    const auto report = [&](double proven) {
      if (search.cost() < query.known_cost()) query.HoldPath();
      lower_bound = proven;
      reported = true;
      query.ReportSolution(told_lower_bound(), search.cost(),
                           search.counts().Since(goal_search->before).expansions);
    };
    search.SetKnownCost(query.known_cost());
    ImproveOutcome outcome = ImproveOutcome::kStopped;
    std::optional<double>& epsilon = goal_search->epsilon;
    while (epsilon) {
      outcome = search.Improve(*epsilon, should_stop, report);
      if (search.best_cost() == kInfinity) {
        lower_bound = search.ProveLowerBound();
        break;
      }
      if (const double proven = search.ProveLowerBound(); !reported || proven > lower_bound) {
        report(proven);
      }
      if (outcome != ImproveOutcome::kConverged || !query.anytime()) break;
      epsilon = settings.epsilon.Next(*epsilon, ProvenBound(search.best_cost(), lower_bound));
    }

    SearchResult result;
    const TwoWaySearch::Counts counts = search.counts().Since(goal_search->before);
    result.counters = {
        {"expansions", static_cast<double>(counts.expansions)},
        {"states", static_cast<double>(counts.states)},
        {"edges_generated", static_cast<double>(counts.edges_generated)},
        {"goal_connections_tried", static_cast<double>(counts.goal_connections_tried)},
    };
    result.path_counters = {
        {"search_iterations", static_cast<double>(counts.iterations)},
        {"found_backward", search.found_backward() ? 1.0 : 0.0},
        {"bridged", search.is_bridged() ? 1.0 : 0.0},
    };
    if (experience_) {
      result.counters["recalled_edges"] = static_cast<double>(counts.recalled_edges);
    }
    result.lower_bound = told_lower_bound();
    // A first solution is not held up where nothing can be proven.
    if (query.anytime()) {
      result.wanted_epsilon = settings.epsilon.final;
    } else if (settings.wrap_heuristic) {
      result.wanted_epsilon = settings.epsilon.initial;
    }
    if (!search.path().empty()) {
      result.status = PlanStatus::kSolved;
      result.path = search.path();
      result.cost = search.cost();
    } else if (outcome == ImproveOutcome::kExhausted) {
      result.status = PlanStatus::kExhausted;
      result.message = "the lattice holds no path to the goal";
      result.lower_bound = kInfinity;
    } else if (outcome == ImproveOutcome::kConverged) {
      result.status = PlanStatus::kExhausted;
      result.message = "the lattice holds no cheaper path than that to another goal";
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
    if (outcome == ImproveOutcome::kStopped && !out_of_memory) {
      goal_search->before = search.counts();
      query.Keep(goal_search, search.bytes());
    } else {
      result.remains = goal_search;
    }
    return result;
  }

  std::vector<double> LowerBounds(const SearchQuery& query, const Configuration& q,
                                  std::span<const GoalBox> ends) override {
    std::vector<double> bounds(ends.size(), 0.0);
    const AraSettings settings = SettingsFor(query);
    if (!settings.wrap_heuristic) return bounds;
    const ManipulationGraph graph(&query.edges(), q, ends.front(), OptionsOf(query, settings));
    std::transform(ends.begin(), ends.end(), bounds.begin(),
                   [&](const GoalBox& end) { return graph.LeastCostTo(end); });
    return bounds;
  }

  std::optional<EdgeSampling> OwnEdgeSampling(const PlanningGroup& group, EdgeCheck method,
                                              double resolution_m) const override {
    if (settings_.edge_weights.empty() || method != EdgeCheck::kFixed) return std::nullopt;
    EdgeSampling sampling;
    sampling.step = resolution_m;
    for (const JointSpace::Joint& joint : group.space.joints()) {
      const auto weight = settings_.edge_weights.find(joint.name);
      if (weight == settings_.edge_weights.end()) {
        throw InputError(fmt::format("{}: edge_weights: joint {} has none", origin_, joint.name));
      }
      sampling.weights.push_back(weight->second);
    }
    return sampling;
  }

 private:
  void RequireKnownJoints(const YamlNode& settings) const {
    for (const char* key : {"discretization", "joint_weights", "edge_weights"}) {
      const std::optional<YamlNode> by_joint = settings.Find(key);
      if (!by_joint) continue;
      for (const std::string& joint : by_joint->Keys()) {
        if (robot().model.FindJoint(joint) >= 0) continue;
        by_joint->At(joint).Fail("the robot has no joint of that name");
      }
    }
  }

  static YamlNode ParametersOf(const SearchQuery& query) {
    YamlNode request = YamlNode::Parse("{}", "request parameters");
    for (const auto& [key, text] : query.parameters()) {
      request.Override(key, text, "request parameter " + key);
    }
    return request;
  }

  AraSettings SettingsFor(const SearchQuery& query) const {
    if (query.parameters().empty()) return settings_;
    const YamlNode request = ParametersOf(query);
    // Paths have been read by then, and edges are sampled before a search is asked.
    for (const char* key : {"experience", "edge_weights"}) {
      const std::optional<YamlNode> value = request.Find(key);
      if (value) value->Fail("is a setting of the planner, which a request cannot change");
    }
    AraSettings settings = settings_;
    settings.Apply(request);
    RequireKnownJoints(request);
    settings.Validate("request parameters");
    return settings;
  }

  std::shared_ptr<GoalSearch> Begin(const SearchQuery& query, const AraSettings& settings) {
    auto begun = std::make_shared<GoalSearch>(query, OptionsOf(query, settings), settings);
    if (settings.tip_guide > 0) {
      begun->two_way.GuideByTip(query.scene(), query.base_positions(), settings.tip_guide);
    }
    if (const PathLibrary* known = experience_ ? experience_->For(query.space()) : nullptr) {
      begun->two_way.AddPaths(
          known->Recall(query.space(), query.start(), query.goal().nominal, settings.recall));
    }
    return begun;
  }

  /// `settings`: the query's.
  ManipulationGraphOptions OptionsOf(const SearchQuery& query, const AraSettings& settings) {
    const PlanningGroup& group = query.edges().checker().group();
    if (query.parameters().empty()) return OptionsFor(group);
    const std::optional<YamlNode> own = ParametersOf(query).Find("primitives");
    const NamedFile primitives =
        own && !settings.primitives.empty() ? ReadNamedFile(*own, robot().folder) : primitives_;
    return ResolveOptions(settings, primitives, robot(), group, "request parameters");
  }

  const ManipulationGraphOptions& OptionsFor(const PlanningGroup& group) {
    const auto known = options_.find(group.name);
    if (known != options_.end()) return known->second;
    return options_
        .emplace(group.name, ResolveOptions(settings_, primitives_, robot(), group, origin_))
        .first->second;
  }

  std::string origin_;  // of the settings
  AraSettings settings_;
  NamedFile primitives_;       // that settings_ name; empty without one, as is
  std::string primitives_id_;  // its content hash
  std::optional<Experience> experience_;
  std::map<std::string, ManipulationGraphOptions> options_;  // by group, of settings_
};

}  // namespace

std::unique_ptr<Planner> MakeAraPlanner(const Robot& robot, const YamlNode& settings) {
  return std::make_unique<AraPlanner>(robot, settings);
}

}  // namespace planbench
