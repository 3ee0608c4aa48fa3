#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "planner_ara/chunked_array.h"
#include "planner_ara/state_heap.h"

namespace planbench {

/// A directed edge out of a state, its validity not yet known.
struct CandidateEdge {
  StateId target = 0;
  double cost = 0;           ///< >= 0
  std::uint16_t action = 0;  ///< The graph's own number of the edge among those of its source.
};

/// An implicit graph. Ids are dense: any id the graph has handed out is below the number of its
/// states.
/// - CandidateEdges(s, &edges) appends the edges out of s, validity unknown; the same at every
/// call.
/// - IsValidEdge(s, edge) decides about one of them; asked only where the edge would lower the cost
/// of its target.
/// - Heuristic(s) is a lower bound of the cost from s to the goal, 0 at the goal, and consistent:
///   h(s) <= cost(s, t) + h(t) for every valid edge.
template <typename Graph>
concept SearchGraph = requires(Graph graph, StateId state, std::vector<CandidateEdge>* edges,
                               const CandidateEdge& edge) {
  graph.CandidateEdges(state, edges);
  { graph.IsValidEdge(state, edge) } -> std::convertible_to<bool>;
  { graph.Heuristic(state) } -> std::convertible_to<double>;
};

/// A state of a path and the edge that led to it.
struct PathStep {
  StateId state = 0;
  std::uint16_t action = 0;  ///< Of the edge from the step before; 0 for the first.
};

/// How a call of AraStar::ImprovePath ended.
enum class ImproveOutcome {
  kConverged,  ///< The solution is within epsilon of the optimum.
  kExhausted,  ///< There is no path to the goal.
  kStopped,    ///< should_stop said so; calling again with the same epsilon goes on.
};

/// ARA*: weighted A* that is run again with smaller and smaller epsilon, keeping the costs found so
/// far (Likhachev, Gordon, Thrun, "ARA*: Anytime A* with provable bounds on sub-optimality", NIPS
/// 2003). In one iteration no state is expanded twice: a state whose cost falls after its expansion
/// waits in INCONS for the next one.
///
/// Beyond the paper, states that cannot lie on a better path than the one found (g + h >= g(goal))
/// are dropped, as Hansen and Zhou do ("Anytime heuristic search", JAIR 2007); the bound stays
/// valid, since each of them stands for paths of at least g(goal). The goal itself is never
/// expanded: an iteration ends when its cost is no greater than the smallest key in OPEN.
template <SearchGraph Graph>
class AraStar {
 public:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// The graph must outlive this.
  AraStar(Graph* graph, StateId start, StateId goal) : graph_(graph), start_(start), goal_(goal) {
    Touch(goal);
    Touch(start).g = 0;
    incons_.push_back(start);
  }

  /// Searches until the goal's cost is proven to be at most `epsilon` (>= 1) times the optimum. A
  /// new value of epsilon begins a new iteration. `should_stop` is asked before every expansion.
  template <std::predicate StopFunction>
  ImproveOutcome ImprovePath(double epsilon, StopFunction&& should_stop) {
    if (epsilon != epsilon_) BeginIteration(epsilon);
    ImproveOutcome outcome = ImproveOutcome::kConverged;
    while (!open_.empty() && open_.top().key < goal_cost()) {
      if (should_stop()) {
        outcome = ImproveOutcome::kStopped;
        break;
      }
      const StateId state = open_.Pop();
      const Node& node = nodes_[state];
      if (node.g + node.h < goal_cost()) Expand(state);
    }
    if (goal_cost() == kInfinity) {
      return outcome == ImproveOutcome::kStopped ? outcome : ImproveOutcome::kExhausted;
    }
    RaiseLowerBound(SmallestOpenCost());
    if (outcome == ImproveOutcome::kConverged) RaiseLowerBound(goal_cost() / epsilon);
    return outcome;
  }

  /// Cost of the best path known, infinity without one. (Path() may be cheaper by what has not been
  /// propagated yet.)
  double goal_cost() const { return nodes_[goal_].g; }
  /// Proven bound of goal_cost() / optimum, computed as the last ImprovePath ended: the goal's cost
  /// over the smallest g + h of OPEN and INCONS, or epsilon where that is smaller. Never rises.
  /// Infinity without a path or a bound.
  double bound() const {
    if (goal_cost() == kInfinity) return kInfinity;
    if (goal_cost() <= lower_bound_) return 1;
    return goal_cost() / lower_bound_;
  }
  /// The best path known, start to goal; empty without one.
  std::vector<PathStep> Path() const {
    std::vector<PathStep> path;
    if (goal_cost() == kInfinity) return path;
    for (StateId state = goal_; state != start_; state = nodes_[state].parent) {
      path.push_back({state, nodes_[state].action});
    }
    path.push_back({start_, 0});
    std::reverse(path.begin(), path.end());
    return path;
  }

  std::int64_t num_expansions() const { return num_expansions_; }
  std::int64_t num_edges_generated() const { return num_edges_generated_; }
  int num_iterations() const { return static_cast<int>(iteration_); }
  std::size_t bytes() const {
    return nodes_.bytes() + open_.bytes() + incons_.capacity() * sizeof(StateId);
  }

 private:
  struct Node {
    double g = kInfinity;
    double h = 0;
    StateId parent = 0;
    std::uint32_t closed_in = 0;  // iteration that expanded it last
    std::uint16_t action = 0;     // of the edge from parent
    bool in_incons = false;
  };

  Node& Touch(StateId state) {
    while (nodes_.size() <= state) {
      const auto id = static_cast<StateId>(nodes_.size());
      nodes_.Append()->h = graph_->Heuristic(id);
    }
    return nodes_[state];
  }

  double Key(const Node& node) const { return node.g + epsilon_ * node.h; }

  void BeginIteration(double epsilon) {
    epsilon_ = epsilon;
    ++iteration_;
    std::vector<StateHeap::Entry> entries;
    entries.reserve(open_.size() + incons_.size());
    const auto add = [&](StateId state) {
      const Node& node = nodes_[state];
      if (node.g + node.h >= goal_cost()) return;
      entries.push_back({Key(node), static_cast<float>(node.h), state});
    };
    for (const StateHeap::Entry& entry : open_.entries()) add(entry.state);
    for (const StateId state : incons_) {
      nodes_[state].in_incons = false;
      add(state);
    }
    incons_.clear();
    open_.Assign(std::move(entries));
  }

  void Expand(StateId state) {
    ++num_expansions_;
    Node& source = nodes_[state];
    source.closed_in = iteration_;
    edges_.clear();
    graph_->CandidateEdges(state, &edges_);
    num_edges_generated_ += static_cast<std::int64_t>(edges_.size());
    for (const CandidateEdge& edge : edges_) {
      Node& target = Touch(edge.target);
      const double g = source.g + edge.cost;
      if (g >= target.g || g + target.h >= goal_cost()) continue;
      if (!graph_->IsValidEdge(state, edge)) continue;
      target.g = g;
      target.parent = state;
      target.action = edge.action;
      if (edge.target == goal_) continue;
      if (target.closed_in != iteration_) {
        open_.Set(edge.target, Key(target), static_cast<float>(target.h));
      } else if (!target.in_incons) {
        target.in_incons = true;
        incons_.push_back(edge.target);
      }
    }
  }

  // Smallest g + h of the states whose improvement is not propagated yet: every path better than
  // the goal's cost leads through one of them.
  double SmallestOpenCost() const {
    double smallest = goal_cost();
    const auto consider = [&](StateId state) {
      const Node& node = nodes_[state];
      smallest = std::min(smallest, node.g + node.h);
    };
    for (const StateHeap::Entry& entry : open_.entries()) consider(entry.state);
    for (const StateId state : incons_) consider(state);
    return smallest;
  }
  void RaiseLowerBound(double cost) { lower_bound_ = std::max(lower_bound_, cost); }

  Graph* graph_;
  StateId start_;
  StateId goal_;
  ChunkedArray<Node> nodes_;
  StateHeap open_;
  std::vector<StateId> incons_;
  std::vector<CandidateEdge> edges_;  // scratch of Expand
  double epsilon_ = 0;
  std::uint32_t iteration_ = 0;
  double lower_bound_ = 0;  // of the optimal cost
  std::int64_t num_expansions_ = 0;
  std::int64_t num_edges_generated_ = 0;
};

}  // namespace planbench
