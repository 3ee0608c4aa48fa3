#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collision/edge_checker.h"
#include "common/yaml.h"
#include "planning/plan_request.h"
#include "planning/plan_result.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// The study's taxonomy of planners.
enum class PlannerClass {
  kSampleThenSearch,
  kSamplingGuided,
  kSearchAndSample,
  kTrajectoryOptimisation,
};
template <>
struct EnumNames<PlannerClass> {
  static constexpr auto kNames = std::to_array<std::string_view>(
      {"sample-then-search", "sampling-guided", "search-and-sample", "trajectory-optimisation"});
};

/// What a planner says of itself.
struct PlannerDescription {
  std::string algorithm;  ///< "ARA*", "RRT-Connect", ...
  PlannerClass planner_class = PlannerClass::kSampleThenSearch;
  bool backward = true;  ///< Can search backward.
  bool anytime = false;  ///< Keeps improving when asked.
  /// Searches from both ends at once (a roadmap has no direction at all): a backward request is the
  /// same experiment as a forward one.
  bool bidirectional = false;
  /// The same raw path and counts whatever the seed.
  bool deterministic = false;
  std::vector<CollisionModel> collision_models;
  std::map<std::string, std::string> settings;  ///< Effective settings, as text.
};

/// How a running plan is watched and stopped. Thread-safe.
struct PlanControl {
  std::atomic<bool> cancelled = false;
  /// Called on the solver thread at each improved solution; may be empty.
  std::function<void(const PlanProgress&)> on_progress;
};

/// Goal of a search: a box in configuration space around a nominal point.
struct GoalBox {
  Configuration nominal;
  Configuration lower;  ///< <= nominal
  Configuration
      upper;  ///< >= nominal; continuous joints are not wrapped: lower <= nominal <= upper holds.

  /// True if q is inside (continuous joints compared the short way round from nominal), limits
  /// inclusive with 1e-9 to spare for rounding.
  bool Contains(const JointSpace& space, std::span<const double> q) const;
};

/// One search, from `start` to `goal` whatever the request's direction was (Planner has swapped
/// them). Start and nominal goal have been found valid.
class SearchQuery {
 public:
  const JointSpace& space() const { return edges_->space(); }
  const Configuration& start() const { return start_; }
  const GoalBox& goal() const { return goal_; }
  /// The scene and the full positions that joints outside the group are held at.
  const Scene& scene() const { return *scene_; }
  const std::vector<double>& base_positions() const { return *base_positions_; }
  /// Validity of states and edges; the only way to ask.
  EdgeChecker& edges() const { return *edges_; }
  std::uint64_t seed() const { return seed_; }
  bool anytime() const { return anytime_; }
  /// Settings of this request, to be applied over the planner's own (see YamlNode::Override).
  const std::map<std::string, std::string>& parameters() const { return *parameters_; }

  /// True once the time limit has passed or the request was cancelled. Cheap (one clock reading).
  bool ShouldStop() const;
  bool Cancelled() const;
  double RemainingSeconds() const;
  /// Reports a solution of an anytime search the moment it is ready: the first stops the planning
  /// clock.
  void ReportSolution(double epsilon, double cost, std::int64_t expansions);

 private:
  friend class Planner;
  double ElapsedSeconds() const;

  Configuration start_;
  GoalBox goal_;
  const Scene* scene_ = nullptr;
  const std::vector<double>* base_positions_ = nullptr;
  EdgeChecker* edges_ = nullptr;
  std::uint64_t seed_ = 0;
  bool anytime_ = false;
  const std::map<std::string, std::string>* parameters_ = nullptr;
  PlanControl* control_ = nullptr;
  std::chrono::steady_clock::time_point begin_;
  double time_limit_s_ = 0;
  std::vector<PlanProgress> progress_;
};

/// What a search found. Status is one of kSolved, kTimedOut, kExhausted, kCancelled, kMemoryLimit;
/// a cancelled or timed-out anytime search that has a path returns it as kSolved.
struct SearchResult {
  PlanStatus status = PlanStatus::kTimedOut;
  std::string message;
  Path path;  ///< Query start to a point of the goal box; waypoints' edges all found valid by
              ///< edges().
  double epsilon = 0;
  double cost = 0;
  double guidance_s = 0;  ///< Time spent on heuristic or nearest neighbours, if measured.
  std::map<std::string, double> counters;
};

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

  /// Has requests checked by the exact engine (MakeReferenceChecker) instead of the fastest one.
  void UseReferenceChecker() {
    exact_ = true;
    checkers_.clear();
  }

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
                   std::chrono::steady_clock::time_point begin, PlanResult* result);
  CollisionChecker& CheckerFor(const PlanningGroup& group, CollisionModel model);

  const Robot* robot_;
  bool exact_ = false;
  std::map<std::pair<std::string, CollisionModel>, std::unique_ptr<CollisionChecker>> checkers_;
};

}  // namespace planbench
