#include "planner_trajopt/trajopt_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "planner_trajopt/chomp.h"
#include "planner_trajopt/initial_guesses.h"
#include "planner_trajopt/stomp.h"
#include "planner_trajopt/trajectory.h"
#include "planner_trajopt/trajectory_cost.h"
#include "planner_trajopt/trajopt_settings.h"
#include "planning/path_measures.h"

namespace planbench {
namespace {

/// What counts as a lower cost or a shorter path, relative.
constexpr double kImprovement = 1e-3;

/// One search: guess after guess is optimised until one is free, or, anytime, until the end. Before
/// them, a path that is given is optimised as long as that helps, free or not.
class TrajectorySearch {
 public:
  TrajectorySearch(const TrajoptSettings& settings, SearchQuery* query)
      : settings_(settings),
        query_(query),
        cost_(&query->edges(), settings.clearance, settings.smoothness),
        // Another seed than the optimiser's, lest guesses and noise be the same numbers.
        guesses_(query->space(), query->start(), query->goal().nominal, settings, &cost_,
                 ~query->seed()) {
    cost_.StopWhen([query] { return query->ShouldStop(); });
    if (settings.algorithm == TrajoptAlgorithm::kStomp) {
      optimiser_ = std::make_unique<Stomp>(query->space(), settings, &cost_, query->seed());
    } else {
      optimiser_ = std::make_unique<Chomp>(query->space(), settings, &cost_);
    }
  }

  SearchResult Run() {
    if (!query_->initial_path().empty()) {
      KeepInitialPath();
      is_given_ = true;
      if (!path_.empty()) cost_.set_smoothness(settings_.given_smoothness);
      Trajectory trajectory = Through(query_->space(), query_->initial_path(), settings_.waypoints);
      Optimise(&trajectory);
      is_given_ = false;
      cost_.set_smoothness(settings_.smoothness);
    }
    while (MayGoOn() && !(settings_.guesses && guesses_.count() == *settings_.guesses)) {
      Trajectory trajectory = guesses_.Next();
      Optimise(&trajectory);
    }
    SearchResult result;
    result.counters = {{"guesses", guesses_.count()},
                       {"iterations", static_cast<double>(num_iterations_)}};
    if (!path_.empty()) {
      result.status = PlanStatus::kSolved;
      result.path = std::move(path_);
      result.cost = length_;
    } else if (query_->Cancelled()) {
      result.status = PlanStatus::kCancelled;
      result.message = "cancelled";
    } else {
      result.status = query_->ShouldStop() ? PlanStatus::kTimedOut : PlanStatus::kExhausted;
      result.message = WhyThereIsNone();
    }
    return result;
  }

 private:
  /// No path, when the search has ended by itself or by the time limit.
  std::string WhyThereIsNone() const {
    if (is_given_unchecked_) return "the path given was not checked in time";
    std::vector<std::string> beginnings;
    if (!query_->initial_path().empty()) beginnings.emplace_back("the path given");
    if (guesses_.count() == 1) beginnings.emplace_back("the straight motion");
    if (guesses_.count() > 1) beginnings.push_back(fmt::format("{} guesses", guesses_.count()));
    if (beginnings.empty()) return "the time was up before anything was optimised";
    return fmt::format("in collision all the same: {} optimised from {}",
                       EnumName(settings_.algorithm), fmt::join(beginnings, " and "));
  }

  bool MayGoOn() const {
    return !query_->ShouldStop() && (path_.empty() || is_given_ || query_->anytime());
  }

  void KeepInitialPath() {
    const Path& path = query_->initial_path();
    for (std::size_t i = 1; i < path.size(); ++i) {
      if (!query_->edges().IsValidEdge(path[i - 1], path[i], /*from_is_free=*/i > 1)) {
        is_given_unchecked_ = query_->edges().Stopped();
        return;
      }
    }
    path_ = path;
    length_ = PathLength(query_->space(), path);
    query_->ReportSolution(/*lower_bound=*/0, length_, num_iterations_);
  }

  void Optimise(Trajectory* trajectory) {
    optimiser_->Restart();
    double least = std::numeric_limits<double>::infinity();
    int since_least = 0;
    for (int i = 0; MayGoOn(); ++i) {
      if (!cost_.FindDistances(*trajectory, &distances_)) return;
      Keep(*trajectory);
      const double cost = cost_.OfTrajectory(*trajectory, distances_);
      since_least = cost < (1 - kImprovement) * least ? 0 : since_least + 1;
      least = std::min(least, cost);
      if (i == settings_.iterations || since_least == settings_.patience || !MayGoOn()) return;
      optimiser_->Iterate(distances_, trajectory);
      *trajectory = SpacedEvenly(*trajectory, settings_.waypoints);
      ++num_iterations_;
    }
  }

  /// Takes the trajectory for the path if it is free and shorter than what there is.
  void Keep(const Trajectory& trajectory) {
    // Of the path: where few waypoints are far apart, the rows may differ by more.
    Path path = PathOf(query_->space(), trajectory);
    const double length = PathLength(query_->space(), path);
    if (!path_.empty() && !(length < (1 - kImprovement) * length_)) return;
    if (!IsFree(trajectory)) return;
    path_ = std::move(path);
    length_ = length;
    query_->ReportSolution(/*lower_bound=*/0, length_, num_iterations_);
  }

  /// The edges that are likeliest blocked are checked first.
  bool IsFree(const Trajectory& trajectory) {
    const std::size_t num_edges = distances_.size() - 1;
    for (std::size_t i = 1; i < num_edges; ++i) {
      if (!(distances_[i] > 0)) return false;
    }
    std::vector<int> order(num_edges);
    std::iota(order.begin(), order.end(), 0);
    const auto nearest = [this](int edge) {
      const auto i = static_cast<std::size_t>(edge);
      return std::min(distances_[i], distances_[i + 1]);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&nearest](int a, int b) { return nearest(a) < nearest(b); });
    return std::all_of(order.begin(), order.end(), [&](int edge) {
      return query_->edges().IsValidEdge(Row(trajectory, edge), Row(trajectory, edge + 1),
                                         /*from_is_free=*/true);
    });
  }

  TrajoptSettings settings_;
  SearchQuery* query_;
  TrajectoryCost cost_;
  InitialGuesses guesses_;
  std::unique_ptr<Optimiser> optimiser_;
  std::vector<double> distances_;  ///< Of the trajectory at hand.
  std::int64_t num_iterations_ = 0;
  bool is_given_ = false;            ///< What is optimised is the path given.
  bool is_given_unchecked_ = false;  ///< The time was up before that was checked to its end.
  Path path_;
  double length_ = 0;
};

class TrajoptPlanner final : public Planner {
 public:
  TrajoptPlanner(const Robot& robot, const TrajoptSettings& settings)
      : Planner(robot), settings_(settings) {}

  PlannerDescription Describe() const override {
    PlannerDescription description;
    description.algorithm = settings_.VariantName();
    description.planner_class = PlannerClass::kTrajectoryOptimisation;
    description.anytime = true;
    description.improve = true;
    description.deterministic =
        settings_.algorithm == TrajoptAlgorithm::kChomp && settings_.guesses == 1;
    description.collision_models = EnumValues<CollisionModel>();
    description.settings = DescribeSettings(settings_);
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    const TrajoptSettings settings = SettingsOfRequest(settings_, query.parameters());
    const auto search = std::make_shared<TrajectorySearch>(settings, &query);
    SearchResult result = search->Run();
    result.remains = search;
    return result;
  }

 private:
  TrajoptSettings settings_;
};

}  // namespace

std::unique_ptr<Planner> MakeTrajoptPlanner(const Robot& robot, const YamlNode& settings) {
  return std::make_unique<TrajoptPlanner>(robot, ReadTrajoptSettings(settings, TrajoptSettings{}));
}

}  // namespace planbench
