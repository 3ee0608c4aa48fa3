#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/numbers.h"
#include "planner_ara/chunked_array.h"
#include "planner_ara/edge_heap.h"

namespace planbench {

/// A directed edge out of a state, its validity not known.
struct CandidateEdge {
  double cost = 0;              ///< >= 0
  double target_heuristic = 0;  ///< Of the state it leads to.
  float guide = 0;              ///< Stands for target_heuristic in EdgeOrder::kGuide.
  std::uint16_t action = 0;     ///< The graph's own number of the edge among those of its source.
};

/// What is known of an edge.
enum class EdgeVerdict : std::uint64_t { kUnknown = 0, kFree = 1, kBlocked = 2 };

/// An implicit graph. State ids are dense: they are handed out from 0 upwards as states become
/// known.
/// - CandidateEdges(s, &edges) appends the edges out of s: those of the call before, but for their
/// guides, and perhaps more (AraStar::ExpandAgain).
/// - Target(s, action) is the state an edge leads to.
/// - CheckEdge(s, action) decides about an edge, or gives it up (kUnknown); asked only when it is
/// the most promising one. The heuristic h is a lower bound of the cost to the goal, 0 at the goal,
/// and consistent: h(s) <= cost + h(t) for every valid edge from s to t.
template <typename Graph>
concept SearchGraph = requires(Graph graph, StateId state, std::vector<CandidateEdge>* edges,
                               std::uint16_t action) {
  graph.CandidateEdges(state, edges);
  { graph.Target(state, action) } -> std::same_as<StateId>;
  { graph.CheckEdge(state, action) } -> std::same_as<EdgeVerdict>;
};

/// A state of a path and the edge that led to it.
struct PathStep {
  StateId state = 0;
  std::uint16_t action = 0;  ///< Of the edge from the step before; 0 for the first.
};

/// How a call of AraStar::ImprovePath ended.
enum class ImproveOutcome {
  kConverged,  ///< The solution is within epsilon of the optimum (EdgeOrder::kGuide: see there).
  kExhausted,  ///< There is no path to the goal.
  kStopped,    ///< should_stop said so; calling again with the same epsilon goes on.
};

/// ARA*: weighted A* that is run again with smaller and smaller epsilon, keeping the costs found so
/// far (Likhachev, Gordon, Thrun, "ARA*: Anytime A* with provable bounds on sub-optimality", NIPS
/// 2003). In one iteration no state is expanded twice: an edge that would lower the cost of a state
/// after its expansion waits in INCONS for the next.
///
/// Edges are evaluated lazily (as Cohen, Phillips and Likhachev do in "Planning single-arm
/// manipulations with n-arm robots", RSS 2014): OPEN holds candidate edges, keyed by what their
/// target's cost and heuristic would be, and an edge's validity is asked for only when it comes out
/// first. The states expanded, and their order, are those of an eager ARA*, which asks about every
/// edge of every expanded state: a state comes out with the least cost of all its valid edges in
/// OPEN. What a state has once got by expansion is consistent, so INCONS, too, holds edges.
///
/// Edges that cannot lie on a better path than the one found (g + h >= g(goal)) are dropped, as
/// Hansen and Zhou do
/// ("Anytime heuristic search", JAIR 2007); the bound stays valid, since each stands for paths of
/// at least g(goal). The goal is never expanded: an iteration ends when its cost is no greater than
/// the smallest key in OPEN.
template <SearchGraph Graph>
class AraStar {
 public:
  /// The graph must outlive this.
  AraStar(Graph* graph, StateId start, StateId goal)
      : graph_(graph), start_(start), goal_(goal), last_expanded_(start) {
    Touch(goal);
    Touch(start).g = 0;
  }

  /// Searches until best_cost() is proven to be at most `epsilon` (>= 1) times the optimum. A new
  /// value of epsilon, or another order, begins a new iteration. `should_stop` is asked before
  /// an edge is evaluated, before a state is expanded again, and every few thousand edges where
  /// OPEN is put in another order. (That begins anew after a stop.) It is to say so once an edge
  /// was given up: that goes back to OPEN, where it counts in what is proven.
  ///
  /// In EdgeOrder::kGuide the edge with the least g + epsilon guide is followed first, and an
  /// iteration ends at its first path, if there is one better than those before. Whatever the order
  /// of expansions, the smallest g + h of OPEN and INCONS stays a lower bound of the optimum, so
  /// such a path, too, has a proven bound (ProveLowerBound), though not the one asked for.
  template <std::predicate StopFunction>
  ImproveOutcome ImprovePath(double epsilon, StopFunction&& should_stop,
                             EdgeOrder order = EdgeOrder::kHeuristic) {
    if (!TakeInLaterEdges(should_stop)) return ImproveOutcome::kStopped;
    if ((epsilon != epsilon_ || order != order_) && !BeginIteration(epsilon, order, should_stop)) {
      return ImproveOutcome::kStopped;
    }
    const bool ends_at_first = order == EdgeOrder::kGuide;
    ImproveOutcome outcome = ImproveOutcome::kConverged;
    while (!open_.empty() &&
           (ends_at_first ? goal_cost() == cost_before_ : open_.top_key() < best_cost())) {
      if (should_stop()) {
        outcome = ImproveOutcome::kStopped;
        break;
      }
      Evaluate(open_.Pop());
    }
    if (outcome == ImproveOutcome::kStopped) return outcome;
    if (best_cost() == kInfinity) return ImproveOutcome::kExhausted;
    if (!ends_at_first) RaiseLowerBound(best_cost() / epsilon);
    return outcome;
  }

  /// Has the next ImprovePath take in the edges that the graph has got since its states were
  /// expanded, and the guides that the others have by now, and begin a new iteration. What was
  /// proven of the optimum does not hold any more.
  void ExpandAgain() {
    open_.Clear();  // Its edges are among those to be taken in.
    lower_bound_ = 0;
    epsilon_ = 0;
    expand_again_at_ = 0;
    expand_again_end_ = static_cast<StateId>(nodes_.size());
  }

  /// Says that a path of this cost is known from elsewhere: from now on edges that cannot lie on a
  /// cheaper one are dropped, and the search converges when it has none left.
  void SetUpperBound(double cost) { upper_bound_ = std::min(upper_bound_, cost); }

  /// Cost of the best path known, infinity without one. (Path() may be cheaper by what has not been
  /// propagated yet.)
  double goal_cost() const { return nodes_[goal_].g; }
  /// The smaller of goal_cost() and the upper bound that was set.
  double best_cost() const { return std::min(goal_cost(), upper_bound_); }
  /// Proven lower bound of the optimal cost, or of best_cost() if that is smaller: the smallest g +
  /// h of OPEN and INCONS, or best_cost() over the epsilon last converged at where that is greater.
  /// Never falls. Takes time linear in OPEN.
  double ProveLowerBound() {
    if (started_ && !lacks_edges()) RaiseLowerBound(SmallestOpenCost());
    return std::min(lower_bound_, best_cost());
  }
  /// Cost of the best way known to a state that has been expanded.
  double CostTo(StateId state) const { return nodes_[state].g; }
  /// The best path known, start to goal; empty without one.
  std::vector<PathStep> Path() const {
    return goal_cost() == kInfinity ? std::vector<PathStep>() : PathTo(goal_);
  }
  /// The best way known to a state that has been expanded.
  std::vector<PathStep> PathTo(StateId end) const {
    std::vector<PathStep> path;
    for (StateId state = end; state != start_; state = nodes_[state].parent) {
      path.push_back({state, nodes_[state].action});
    }
    path.push_back({start_, 0});
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// The state expanded last, the start before any.
  StateId last_expanded() const { return last_expanded_; }
  std::int64_t num_expansions() const { return num_expansions_; }
  std::int64_t num_edges_generated() const { return num_edges_generated_; }
  int num_iterations() const { return static_cast<int>(iteration_); }
  std::size_t bytes() const {
    return nodes_.bytes() + open_.bytes() + incons_.capacity() * sizeof(EdgeHeap::Entry);
  }

 private:
  struct Node {
    double g = kInfinity;
    StateId parent = 0;
    std::uint32_t closed_in = 0;  // iteration that expanded it last
    std::uint16_t action = 0;     // of the edge from parent
  };

  Node& Touch(StateId state) {
    while (nodes_.size() <= state) nodes_.Append();
    return nodes_[state];
  }

  bool CanImproveGoal(const EdgeHeap::Entry& edge) const { return edge.g + edge.h < best_cost(); }

  // False if it was stopped before it could begin.
  template <std::predicate StopFunction>
  bool BeginIteration(double epsilon, EdgeOrder order, StopFunction& should_stop) {
    epsilon_ = 0;  // should it be stopped
    const bool is_ordered = open_.Rebuild(
        epsilon, order, incons_,
        [this](const EdgeHeap::Entry& edge) { return CanImproveGoal(edge); }, should_stop);
    incons_.clear();
    if (!is_ordered) return false;
    epsilon_ = epsilon;
    order_ = order;
    cost_before_ = goal_cost();
    ++iteration_;
    if (!started_ && start_ != goal_) Expand(start_);
    started_ = true;
    return true;
  }

  // Between ExpandAgain and the end of this OPEN lacks edges.
  bool lacks_edges() const { return expand_again_at_ < expand_again_end_; }
  // False if it was stopped before all were taken in.
  template <std::predicate StopFunction>
  bool TakeInLaterEdges(StopFunction& should_stop) {
    for (; lacks_edges(); ++expand_again_at_) {
      if (nodes_[expand_again_at_].closed_in == 0) continue;
      if (should_stop()) return false;
      PushEdges(expand_again_at_);
    }
    return true;
  }

  void Evaluate(const EdgeHeap::Entry& edge) {
    if (!CanImproveGoal(edge)) return;
    const StateId state = graph_->Target(edge.source, edge.action);
    Node& target = Touch(state);
    if (edge.g >= target.g) return;
    if (target.closed_in == iteration_) {
      incons_.push_back(edge);
      return;
    }
    const EdgeVerdict verdict = graph_->CheckEdge(edge.source, edge.action);
    if (verdict == EdgeVerdict::kUnknown) open_.Push(edge);
    if (verdict != EdgeVerdict::kFree) return;
    target.g = edge.g;
    target.parent = edge.source;
    target.action = edge.action;
    if (state != goal_) Expand(state);
  }

  void Expand(StateId state) {
    ++num_expansions_;
    last_expanded_ = state;
    nodes_[state].closed_in = iteration_;
    PushEdges(state);
  }

  void PushEdges(StateId state) {
    const double g = nodes_[state].g;
    edges_.clear();
    graph_->CandidateEdges(state, &edges_);
    num_edges_generated_ += static_cast<std::int64_t>(edges_.size());
    for (const CandidateEdge& edge : edges_) {
      const EdgeHeap::Entry entry{g + edge.cost, edge.target_heuristic, edge.guide, state,
                                  edge.action};
      if (CanImproveGoal(entry)) open_.Push(entry);
    }
  }

  // Smallest g + h of the edges that have not been followed: every path better than the goal's cost
  // takes one.
  double SmallestOpenCost() const {
    double smallest = best_cost();
    for (const EdgeHeap::Entry& edge : open_.entries())
      smallest = std::min(smallest, edge.g + edge.h);
    for (const EdgeHeap::Entry& edge : incons_) smallest = std::min(smallest, edge.g + edge.h);
    return smallest;
  }
  void RaiseLowerBound(double cost) { lower_bound_ = std::max(lower_bound_, cost); }

  Graph* graph_;
  StateId start_;
  StateId goal_;
  ChunkedArray<Node> nodes_;
  EdgeHeap open_;
  std::vector<EdgeHeap::Entry> incons_;
  std::vector<CandidateEdge> edges_;  // scratch of Expand
  double epsilon_ = 0;
  EdgeOrder order_ = EdgeOrder::kHeuristic;
  bool started_ = false;  // the start has been expanded
  std::uint32_t iteration_ = 0;
  double cost_before_ = kInfinity;  // of the goal, when the iteration began
  double lower_bound_ = 0;          // of the optimal cost
  double upper_bound_ = kInfinity;  // cost of a path known from elsewhere
  StateId last_expanded_;
  // The states that are still to be expanded again.
  StateId expand_again_at_ = 0;
  StateId expand_again_end_ = 0;
  std::int64_t num_expansions_ = 0;
  std::int64_t num_edges_generated_ = 0;
};

}  // namespace planbench
