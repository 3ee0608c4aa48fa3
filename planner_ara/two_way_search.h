#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planner_ara/ara_star.h"
#include "planner_ara/manipulation_graph.h"
#include "planning/goal_box.h"
#include "planning/plan_result.h"

namespace planbench {

/// ARA* from the start and, if asked for, from the goal, in turn within one request. Each search
/// has the lattice anchored at its own root, with the other end as its goal. The way out of a
/// narrow place is found sooner than the way into it, so the one whose expansions take more work,
/// since more of its moves are blocked, does more: the ratio to the third power, at most five times
/// as much. Neither follows edges that cannot lead to a path cheaper than the best of both, once
/// the bound is what is left to do. Where a lattice holds no path, its search goes on with finer
/// moves (ManipulationGraph::Refine), the states kept.
///
/// Where they have been without success for a while, they look for walls between start and goal
/// that a continuous joint cannot pass on its short way (FindWalls), and are guided round those.
///
/// Where both have long been without success, each stuck before the narrow place in which the other
/// began, a search for a bridge between the widest states of both takes their place: for half as
/// much work as they have done together, and again when that has doubled. Where three bridges have
/// led nowhere, both get random moves besides (ManipulationGraph::AddRandomMoves), for states that
/// they have not expanded yet.
class TwoWaySearch {
 public:
  /// What the searches have done, both together.
  struct Counts {
    std::int64_t expansions = 0;
    std::int64_t states = 0;
    std::int64_t edges_generated = 0;
    std::int64_t goal_connections_tried = 0;
    std::int64_t recalled_edges = 0;  ///< Those that were free.
    std::int64_t iterations = 0;      ///< Of the search that had the most.
    Counts& operator+=(const Counts& more);
    /// What was done since; the iterations all the same.
    Counts Since(const Counts& before) const;
  };

  /// `start` and the goal's nominal point are valid. The edge checker must outlive this. Throws
  /// InputError as ManipulationGraph does.
  TwoWaySearch(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
               const ManipulationGraphOptions& options, bool two_way);
  ~TwoWaySearch();

  /// Before the first Improve: the tips' way round the obstacles guides the searches, too, by
  /// `weight` (rad/m). The scene must outlive this; Improve may then throw as TipGrid::Mark.
  void GuideByTip(const Scene& scene, std::span<const double> base_positions, double weight);

  /// Before the first Improve: both lattices get the edges of these paths (RecalledPaths).
  void AddPaths(std::span<const Path> paths);

  /// Says that a path of this cost is known from elsewhere. If it is the best, only cheaper ones
  /// are searched for from now on, as in the proof of a path that was found: without guide, bridge
  /// and further finer moves. That none is there is proof as good as a path.
  void SetKnownCost(double cost);

  /// Searches until the best path is proven to cost at most `epsilon` times the optimum of either
  /// lattice. A path that is not good enough is first shortened, if the options say so.
  /// `should_stop` is asked as AraStar does; `on_solution` is called at each better path with what
  /// ProveLowerBound says.
  ImproveOutcome Improve(double epsilon, const std::function<bool()>& should_stop,
                         const std::function<void(double)>& on_solution);

  /// Cost of the best path found, infinity without one.
  double cost() const { return cost_; }
  /// That, or what is known from elsewhere if it is less.
  double best_cost() const { return std::min(cost_, known_cost_); }
  /// The best path, start to goal; empty without one.
  const Path& path() const { return path_; }
  /// Proven lower bound of the optimum of either lattice, or of best_cost() if that is smaller.
  double ProveLowerBound();
  /// True if the best path was found from the goal.
  bool found_backward() const { return found_backward_; }
  /// True if the best path leads over a bridge.
  bool is_bridged() const { return is_bridged_; }

  Counts counts() const;
  std::size_t bytes() const;

 private:
  struct Side;
  struct Bridge;
  /// What the searches are after, one after the other.
  enum class Phase {
    kFirst,   ///< Any path, in the guide's order, most greedily.
    kBetter,  ///< Another, in the guide's order with the epsilon asked for. Guided only.
    kProof,   ///< A better path or a better bound, as ARA* goes on.
  };
  void BeginPhase(Phase phase);
  Side* NextSide() const;
  double MeanWork() const;
  bool Offer(const Side* side, const std::function<bool()>& should_stop);
  void TakePath(double cost, Path path, bool is_backward);
  void SetCost(double cost);
  bool ShortenPath(const std::function<bool()>& should_stop);
  void SeekWalls();
  void LookAround(Side* side);
  void BeginBridge();
  void GiveUpBridge();
  /// True if that has found the best path.
  bool WorkOnBridge(double epsilon, const std::function<bool()>& should_stop);

  struct TipGuide {
    const Scene* scene;
    std::vector<double> base_positions;
    double weight;
  };

  EdgeChecker* edges_;
  ManipulationGraphOptions options_;
  std::optional<TipGuide> tip_guide_;
  std::vector<std::unique_ptr<Side>> sides_;
  Phase phase_ = Phase::kFirst;
  double cost_ = std::numeric_limits<double>::infinity();
  double known_cost_ = std::numeric_limits<double>::infinity();
  Path path_;
  bool found_backward_ = false;
  bool is_bridged_ = false;
  bool may_be_shortened_ = false;
  bool may_have_walls_;  // that were not sought
  std::unique_ptr<Bridge> bridge_;
  double bridge_at_;      // mean work of the sides when the next bridge is begun
  int num_bridges_ = 0;   // begun
  Counts bridge_counts_;  // of those given up
};

}  // namespace planbench
