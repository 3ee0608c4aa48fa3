#include "planner_ara/two_way_search.h"

#include <algorithm>

#include "common/numbers.h"

namespace planbench {
namespace {

/// A search goes on until it has done this much more work than the other.
constexpr std::int64_t kSlice = 200;
/// Work of an expansion, a configuration checked being 1.
constexpr std::int64_t kExpansionWork = 10;

}  // namespace

struct TwoWaySearch::Side {
  Side(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
       const ManipulationGraphOptions& options)
      : root(start),
        target(goal.nominal),
        graph(edges, start, goal, options),
        search(&graph, ManipulationGraph::kStart, ManipulationGraph::kGoal) {}

  Configuration root;
  Configuration target;
  ManipulationGraph graph;
  AraStar<ManipulationGraph> search;
  bool converged = false;
  std::int64_t work = 0;
};

TwoWaySearch::TwoWaySearch(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
                           const ManipulationGraphOptions& options, bool two_way)
    : edges_(edges), guided_(options.crowding > 0) {
  sides_.push_back(std::make_unique<Side>(edges, start, goal, options));
  if (!two_way) return;
  const GoalBox back_to_start{start, start, start};
  sides_.push_back(std::make_unique<Side>(edges, goal.nominal, back_to_start, options));
}

TwoWaySearch::~TwoWaySearch() = default;

void TwoWaySearch::GuideByTip(const Scene& scene, std::span<const double> base_positions,
                              double weight) {
  guided_ = true;
  const CollisionChecker& checker = edges_->checker();
  const Side& forward = *sides_.front();
  const auto grid = std::make_shared<TipGrid>(scene, checker.robot().model, checker.group(),
                                              base_positions, forward.root, forward.target);
  for (const auto& side : sides_) {
    side->graph.GuideByTip(std::make_unique<TipDistance>(grid, side->target), weight);
  }
}

TwoWaySearch::Side* TwoWaySearch::NextSide() const {
  Side* next = nullptr;
  for (const auto& side : sides_) {
    if (!side->converged && (next == nullptr || side->work < next->work)) next = side.get();
  }
  return next;
}

ImproveOutcome TwoWaySearch::Improve(double epsilon, const std::function<bool()>& should_stop,
                                     const std::function<void(double)>& on_solution) {
  for (const auto& side : sides_) side->converged = false;
  while (Side* side = NextSide()) {
    const EdgeOrder order =
        guided_ && cost_ == kInfinity ? EdgeOrder::kGuide : EdgeOrder::kHeuristic;
    const bool alone = sides_.size() == 1;
    const std::int64_t expansions = side->search.num_expansions();
    const std::int64_t configurations = edges_->counters().configurations;
    const auto work = [&] {
      return edges_->counters().configurations - configurations +
             kExpansionWork * (side->search.num_expansions() - expansions);
    };
    bool stopped = false;
    const ImproveOutcome outcome = side->search.ImprovePath(
        epsilon,
        [&] {
          stopped = should_stop();
          return stopped || (!alone && work() >= kSlice);
        },
        order);
    side->work += work();
    if (outcome == ImproveOutcome::kExhausted && side->graph.Refine()) {
      side->search.ExpandAgain();
      continue;
    }
    // In the order of the guide a search that has a path is at its end, but has proven nothing yet.
    side->converged = outcome == ImproveOutcome::kExhausted ||
                      (outcome == ImproveOutcome::kConverged && order == EdgeOrder::kHeuristic);
    if (side->search.goal_cost() < cost_) {
      TakePath(*side);
      const double bound = ProveBound();
      on_solution(bound);
      if (bound <= epsilon) return ImproveOutcome::kConverged;
    }
    if (stopped) return ImproveOutcome::kStopped;
  }
  return cost_ < kInfinity ? ImproveOutcome::kConverged : ImproveOutcome::kExhausted;
}

void TwoWaySearch::TakePath(const Side& side) {
  cost_ = side.search.goal_cost();
  path_ = side.graph.Configurations(side.search.Path());
  found_backward_ = &side != sides_.front().get();
  if (found_backward_) std::reverse(path_.begin(), path_.end());
  for (const auto& other : sides_) other->search.SetUpperBound(cost_);
}

double TwoWaySearch::ProveBound() {
  double lower_bound = kInfinity;
  for (const auto& side : sides_) {
    lower_bound = std::min(lower_bound, side->search.ProveLowerBound());
  }
  return cost_ <= lower_bound ? 1 : cost_ / lower_bound;
}

TwoWaySearch::Counts TwoWaySearch::counts() const {
  Counts counts;
  for (const auto& side : sides_) {
    counts.expansions += side->search.num_expansions();
    counts.states += side->graph.num_states();
    counts.edges_generated += side->search.num_edges_generated();
    counts.goal_connections_tried += side->graph.num_goal_connections_tried();
    counts.iterations = std::max<std::int64_t>(counts.iterations, side->search.num_iterations());
  }
  return counts;
}

std::size_t TwoWaySearch::bytes() const {
  std::size_t bytes = 0;
  for (const auto& side : sides_) bytes += side->graph.bytes() + side->search.bytes();
  return bytes;
}

}  // namespace planbench
