#include "planner_ara/ara_star.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "common/numbers.h"
#include "planner_ara/random_graph.h"
#include "tests/planner_ara/bound_of.h"

namespace planbench {
namespace {

constexpr StateId kStart = 0;
constexpr StateId kGoal = 1;
constexpr int kNumGraphs = 400;
const auto kNever = [] { return false; };

double CostOf(const ExplicitGraph& graph, const std::vector<PathStep>& path) {
  EXPECT_FALSE(path.empty());
  if (path.empty()) return kInfinity;
  EXPECT_EQ(path.front().state, kStart);
  EXPECT_EQ(path.back().state, kGoal);
  double cost = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const ExplicitGraph::Edge& edge = graph.edges[path[i - 1].state][path[i].action];
    EXPECT_EQ(edge.target, path[i].state);
    EXPECT_TRUE(edge.valid);
    cost += edge.cost;
  }
  return cost;
}

void ExpectNoneTwice(const std::vector<StateId>& expanded) {
  EXPECT_EQ(std::set<StateId>(expanded.begin(), expanded.end()).size(), expanded.size());
}

TEST(AraStar, TakesInEdgesThatCameLater) {
  int num_solved_later = 0;
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    const ExplicitGraph whole = RandomGraph(seed, kGoal);
    ExplicitGraph graph = whole;
    for (std::size_t s = 0; s < graph.edges.size(); ++s) {
      graph.edges[s].resize(graph.edges[s].size() * (seed % 4) / 4);
    }
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    search.ImprovePath(1 + seed % 3, kNever,
                       seed % 2 == 0 ? EdgeOrder::kGuide : EdgeOrder::kHeuristic);
    search.ProveLowerBound();
    const bool was_solved = search.goal_cost() < kInfinity;

    graph.edges = whole.edges;
    search.ExpandAgain();
    const double optimum = TrueCosts(graph, kStart, false)[kGoal];
    for (const double epsilon : {1.0 + seed % 3, 1.0}) {
      const ImproveOutcome outcome = search.ImprovePath(epsilon, kNever);
      if (optimum == kInfinity) {
        EXPECT_EQ(outcome, ImproveOutcome::kExhausted);
        continue;
      }
      ASSERT_EQ(outcome, ImproveOutcome::kConverged);
      EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
      EXPECT_LE(BoundOf(search), epsilon + 1e-12);
      EXPECT_LE(CostOf(graph, search.Path()), search.goal_cost() + 1e-9);
    }
    num_solved_later += !was_solved && optimum < kInfinity ? 1 : 0;
  }
  EXPECT_GT(num_solved_later, kNumGraphs / 10);
}

// A start with many neighbours, each of which gets an edge to the goal later.
TEST(AraStar, CanBeStoppedBetweenIterations) {
  constexpr StateId kNumStates = 3 * kStepsBetweenStops;
  // The states expanded again, one by one, then OPEN.
  constexpr int kNumStatesAgain = kNumStates - 1;
  for (const int num_asked : {1, 5000, kNumStatesAgain, kNumStatesAgain + 1, kNumStatesAgain + 9}) {
    SCOPED_TRACE(num_asked);
    ExplicitGraph graph(kNumStates);
    for (StateId s = 2; s < kNumStates; ++s) graph.Add(kStart, s, 1);
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    ASSERT_EQ(search.ImprovePath(1, kNever), ImproveOutcome::kExhausted);
    const int num_iterations = search.num_iterations();
    for (StateId s = 2; s < kNumStates; ++s) graph.Add(s, kGoal, 1 + s % 7);
    graph.expanded.clear();
    search.ExpandAgain();
    int budget = num_asked;
    ASSERT_EQ(search.ImprovePath(1, [&] { return --budget == 0; }), ImproveOutcome::kStopped);
    EXPECT_EQ(search.num_iterations(), num_iterations);
    EXPECT_LE(search.ProveLowerBound(), 2);
    EXPECT_EQ(static_cast<int>(graph.expanded.size()), std::min(num_asked - 1, kNumStatesAgain));
    EXPECT_EQ(search.ProveLowerBound() > 0, num_asked > kNumStatesAgain) << "OPEN lacks edges";
    EXPECT_EQ(search.ImprovePath(1, kNever), ImproveOutcome::kConverged);
    EXPECT_EQ(search.goal_cost(), 2);
    EXPECT_EQ(BoundOf(search), 1);
    ExpectNoneTwice(graph.expanded);
  }
}

TEST(AraStar, KeepsItsPromiseAtEveryEpsilon) {
  int num_solvable = 0;
  int num_improved = 0;
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph graph = RandomGraph(seed, kGoal);
    const double optimum = TrueCosts(graph, kStart, false)[kGoal];
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    double last_bound = kInfinity;
    double last_cost = kInfinity;
    for (const double epsilon : {20.0, 5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.0}) {
      graph.expanded.clear();
      const ImproveOutcome outcome = search.ImprovePath(epsilon, kNever);
      ExpectNoneTwice(graph.expanded);
      if (optimum == kInfinity) {
        EXPECT_EQ(outcome, ImproveOutcome::kExhausted);
        EXPECT_EQ(search.goal_cost(), kInfinity);
        EXPECT_EQ(BoundOf(search), kInfinity);
        EXPECT_TRUE(search.Path().empty());
        continue;
      }
      ASSERT_EQ(outcome, ImproveOutcome::kConverged);
      EXPECT_LE(search.goal_cost(), epsilon * optimum + 1e-9);
      EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
      EXPECT_GE(BoundOf(search), 1);
      EXPECT_LE(BoundOf(search), epsilon + 1e-12);
      EXPECT_LE(BoundOf(search), last_bound);
      EXPECT_LE(CostOf(graph, search.Path()), search.goal_cost() + 1e-9);
      num_improved += last_cost != kInfinity && search.goal_cost() < last_cost ? 1 : 0;
      last_bound = BoundOf(search);
      last_cost = search.goal_cost();
    }
    if (optimum == kInfinity) continue;
    ++num_solvable;
    EXPECT_NEAR(search.goal_cost(), optimum, 1e-9);
    EXPECT_NEAR(CostOf(graph, search.Path()), optimum, 1e-9);
    EXPECT_EQ(BoundOf(search), 1);
  }
  // The graphs put the promise to the test.
  EXPECT_GT(num_solvable, kNumGraphs / 2);
  EXPECT_LT(num_solvable, kNumGraphs);
  EXPECT_GT(num_improved, 50);
}

TEST(AraStar, BoundHoldsWhereverItIsStopped) {
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph graph = RandomGraph(seed, kGoal);
    const double optimum = TrueCosts(graph, kStart, false)[kGoal];
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    for (const double epsilon : {8.0, 1.3, 1.0}) {
      for (ImproveOutcome outcome = ImproveOutcome::kStopped;
           outcome == ImproveOutcome::kStopped;) {
        int budget = 2;
        outcome = search.ImprovePath(epsilon, [&] { return budget-- == 0; });
        if (search.goal_cost() == kInfinity) continue;
        EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
        EXPECT_LE(CostOf(graph, search.Path()), search.goal_cost() + 1e-9);
      }
    }
  }
}

TEST(AraStar, GoesOnWhereItWasStopped) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph at_once = RandomGraph(seed, kGoal);
    ExplicitGraph in_steps = at_once;
    AraStar<ExplicitGraph> search_at_once(&at_once, kStart, kGoal);
    AraStar<ExplicitGraph> search_in_steps(&in_steps, kStart, kGoal);
    for (const double epsilon : {4.0, 1.5, 1.0}) {
      const ImproveOutcome outcome = search_at_once.ImprovePath(epsilon, kNever);
      ImproveOutcome last = ImproveOutcome::kStopped;
      while (last == ImproveOutcome::kStopped) {
        int budget = 1;
        last = search_in_steps.ImprovePath(epsilon, [&] { return budget-- == 0; });
      }
      EXPECT_EQ(last, outcome);
      EXPECT_EQ(search_in_steps.goal_cost(), search_at_once.goal_cost());
    }
    EXPECT_EQ(in_steps.expanded, at_once.expanded);
  }
}

// Stopped within an edge each time.
TEST(AraStar, AnEdgeThatWasGivenUpCountsAndIsCheckedLater) {
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph at_once = RandomGraph(seed, kGoal);
    ExplicitGraph in_steps = at_once;
    const double optimum = TrueCosts(at_once, kStart, false)[kGoal];
    const EdgeOrder order = seed % 2 == 0 ? EdgeOrder::kGuide : EdgeOrder::kHeuristic;
    AraStar<ExplicitGraph> search_at_once(&at_once, kStart, kGoal);
    AraStar<ExplicitGraph> search_in_steps(&in_steps, kStart, kGoal);
    for (const double epsilon : {8.0, 1.3, 1.0}) {
      const ImproveOutcome outcome = search_at_once.ImprovePath(epsilon, kNever, order);
      double proven = 0;
      ImproveOutcome last = ImproveOutcome::kStopped;
      while (last == ImproveOutcome::kStopped) {
        in_steps.checks_left = static_cast<int>(1 + seed % 3);
        last = search_in_steps.ImprovePath(
            epsilon, [&] { return in_steps.checks_left < 0; }, order);
        const double lower_bound = search_in_steps.ProveLowerBound();
        EXPECT_LE(lower_bound, optimum + 1e-9);
        EXPECT_GE(lower_bound, std::min(proven, search_in_steps.best_cost()));
        proven = lower_bound;
      }
      EXPECT_EQ(last, outcome);
      EXPECT_EQ(search_in_steps.goal_cost(), search_at_once.goal_cost());
    }
    EXPECT_EQ(in_steps.expanded, at_once.expanded);
    EXPECT_EQ(in_steps.num_validity_checks, at_once.num_validity_checks);
  }
}

TEST(AraStar, IsDeterministic) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    ExplicitGraph first = RandomGraph(seed, kGoal);
    ExplicitGraph second = first;
    for (ExplicitGraph* graph : {&first, &second}) {
      AraStar<ExplicitGraph> search(graph, kStart, kGoal);
      for (const double epsilon : {3.0, 2.0, 1.0}) search.ImprovePath(epsilon, kNever);
    }
    EXPECT_EQ(first.expanded, second.expanded);
  }
}

TEST(AraStar, WithoutHeuristicAndInflationIsDijkstra) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph graph = RandomGraph(seed, kGoal);
    graph.heuristic.assign(graph.heuristic.size(), 0);
    const std::vector<double> costs = TrueCosts(graph, kStart, false);
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    search.ImprovePath(1, kNever);
    if (costs[kGoal] == kInfinity) {
      EXPECT_EQ(search.goal_cost(), kInfinity);
    } else {
      EXPECT_NEAR(search.goal_cost(), costs[kGoal], 1e-9);
    }
    ExpectNoneTwice(graph.expanded);
    for (std::size_t i = 0; i < graph.expanded.size(); ++i) {
      EXPECT_LE(costs[graph.expanded[i]], costs[kGoal]);
      if (i > 0) {
        EXPECT_GE(costs[graph.expanded[i]], costs[graph.expanded[i - 1]] - 1e-9);
      }
    }
  }
}

// A guide that leads anywhere: whatever the order of expansions, the bound is proven.
TEST(AraStar, BoundHoldsUnderAnyGuide) {
  int num_in_another_order = 0;
  int num_better = 0;
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph graph = RandomGraph(seed, kGoal);
    const double optimum = TrueCosts(graph, kStart, false)[kGoal];
    ExplicitGraph plain = graph;
    AraStar<ExplicitGraph>(&plain, kStart, kGoal).ImprovePath(10, kNever);
    graph.guide_seed = seed + 1;
    AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
    const ImproveOutcome outcome = search.ImprovePath(10, kNever, EdgeOrder::kGuide);
    ExpectNoneTwice(graph.expanded);
    num_in_another_order += graph.expanded != plain.expanded ? 1 : 0;
    if (optimum == kInfinity) {
      EXPECT_EQ(outcome, ImproveOutcome::kExhausted);
      continue;
    }
    ASSERT_EQ(outcome, ImproveOutcome::kConverged);
    EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
    // Another iteration of that kind ends at a better path, or where there is none for the guide.
    const double first_cost = search.goal_cost();
    graph.expanded.clear();
    ASSERT_EQ(search.ImprovePath(2, kNever, EdgeOrder::kGuide), ImproveOutcome::kConverged);
    ExpectNoneTwice(graph.expanded);
    EXPECT_LE(search.goal_cost(), first_cost);
    num_better += search.goal_cost() < first_cost ? 1 : 0;
    EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
    double last_bound = BoundOf(search);
    for (const double epsilon : {10.0, 2.0, 1.0}) {
      graph.expanded.clear();
      ASSERT_EQ(search.ImprovePath(epsilon, kNever), ImproveOutcome::kConverged);
      ExpectNoneTwice(graph.expanded);
      EXPECT_LE(search.goal_cost(), epsilon * optimum + 1e-9);
      EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
      EXPECT_LE(BoundOf(search), last_bound);
      last_bound = BoundOf(search);
    }
    EXPECT_NEAR(search.goal_cost(), optimum, 1e-9);
  }
  EXPECT_GT(num_in_another_order, kNumGraphs / 4);
  EXPECT_GT(num_better, 0);
}

TEST(AraStar, AnUpperBoundEndsTheSearchOfDearerPaths) {
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    ExplicitGraph graph = RandomGraph(seed, kGoal);
    const double optimum = TrueCosts(graph, kStart, false)[kGoal];
    if (optimum == kInfinity || optimum == 0) continue;
    for (const double factor : {0.7, 1.5}) {
      AraStar<ExplicitGraph> search(&graph, kStart, kGoal);
      search.SetUpperBound(factor * optimum);
      for (const double epsilon : {3.0, 1.0}) {
        EXPECT_EQ(search.ImprovePath(epsilon, kNever), ImproveOutcome::kConverged);
        EXPECT_LE(search.best_cost(), epsilon * optimum + 1e-9);
        EXPECT_LE(search.ProveLowerBound(), optimum + 1e-9);
      }
      EXPECT_NEAR(search.best_cost(), std::min(1.0, factor) * optimum, 1e-9);
      EXPECT_EQ(search.goal_cost() < kInfinity, factor > 1);
    }
  }
}

// Start 0, goal 1. State 2 is cheap to reach by way of 3, but the inflated heuristic of 3 lets the
// search come to 2 directly first; when 3 is expanded in turn, 2 is closed and must wait.
ExplicitGraph GraphWithLateImprovement() {
  ExplicitGraph graph(5);
  graph.Add(0, 2, 6);
  graph.Add(0, 3, 1);
  graph.Add(3, 2, 1);
  graph.Add(2, 4, 1);
  graph.Add(4, 1, 10);
  graph.heuristic = {12, 0, 11, 12, 10};
  return graph;
}

TEST(AraStar, StateImprovedAfterItsExpansionWaitsForTheNextIteration) {
  ExplicitGraph graph = GraphWithLateImprovement();
  // At epsilon 10 the keys are: 2: 6 + 110, 3: 1 + 120, 4: 7 + 100; the goal is reached at 17
  // before 3 is looked at.
  AraStar<ExplicitGraph> search(&graph, 0, 1);
  ASSERT_EQ(search.ImprovePath(10, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(graph.expanded, (std::vector<StateId>{0, 2, 4}));
  EXPECT_EQ(search.goal_cost(), 17);
  EXPECT_DOUBLE_EQ(BoundOf(search), 17.0 / 13);  // 3 is the only open state: 1 + 12

  // At 1.2: 3 has 1 + 14.4 < 17. It improves 2 (key 2 + 13.2), 4 (3 + 12) and the goal.
  graph.expanded.clear();
  ASSERT_EQ(search.ImprovePath(1.2, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(graph.expanded, (std::vector<StateId>{3, 2, 4}));
  EXPECT_EQ(search.goal_cost(), 13);
  EXPECT_EQ(BoundOf(search), 1);
}

TEST(AraStar, ClosedStateIsImprovedButNotExpandedAgain) {
  ExplicitGraph graph = GraphWithLateImprovement();
  graph.edges[4][0].cost = 30;
  graph.heuristic = {4, 0, 3, 4, 2};
  // At epsilon 6 the keys are: 2: 6 + 18, 4: 7 + 12, goal 37, then 3: 1 + 24 < 37. State 2 falls to
  // 2, but is closed; waiting in INCONS it puts the lower bound at 2 + 3, which proves less than
  // epsilon does.
  AraStar<ExplicitGraph> search(&graph, 0, 1);
  ASSERT_EQ(search.ImprovePath(6, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(graph.expanded, (std::vector<StateId>{0, 2, 4, 3}));
  EXPECT_EQ(search.goal_cost(), 37);
  EXPECT_EQ(BoundOf(search), 6);
  // The next iteration takes it up.
  graph.expanded.clear();
  ASSERT_EQ(search.ImprovePath(5.9, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(graph.expanded, (std::vector<StateId>{2, 4}));
  EXPECT_EQ(search.goal_cost(), 33);
  EXPECT_EQ(BoundOf(search), 1);
}

// ARA* as the paper has it: every edge of an expanded state is evaluated at once, OPEN and INCONS
// hold states. States that cannot lie on a better path are passed over, as AraStar does.
class EagerAraStar {
 public:
  explicit EagerAraStar(const ExplicitGraph& graph)
      : graph_(graph), g_(graph.edges.size(), kInfinity), open_{kStart} {
    g_[kStart] = 0;
  }

  // Returns the states it expanded, in order.
  std::vector<StateId> ImprovePath(double epsilon) {
    open_.insert(incons_.begin(), incons_.end());
    incons_.clear();
    std::set<StateId> closed;
    std::vector<StateId> expanded;
    const auto key = [&](StateId s) { return g_[s] + epsilon * graph_.heuristic[s]; };
    while (!open_.empty()) {
      const StateId state = *std::min_element(
          open_.begin(), open_.end(), [&](StateId a, StateId b) { return key(a) < key(b); });
      if (key(state) >= g_[kGoal]) break;
      open_.erase(state);
      if (g_[state] + graph_.heuristic[state] >= g_[kGoal]) continue;
      closed.insert(state);
      expanded.push_back(state);
      for (const ExplicitGraph::Edge& edge : graph_.edges[state]) {
        const double g = g_[state] + edge.cost;
        if (!edge.valid || g >= g_[edge.target]) continue;
        g_[edge.target] = g;
        if (edge.target == kGoal) continue;
        (closed.count(edge.target) > 0 ? incons_ : open_).insert(edge.target);
      }
    }
    return expanded;
  }
  double goal_cost() const { return g_[kGoal]; }

 private:
  const ExplicitGraph& graph_;
  std::vector<double> g_;
  std::set<StateId> open_;
  std::set<StateId> incons_;
};

TEST(AraStar, LazyEvaluationExpandsWhatEagerEvaluationDoes) {
  int num_edges = 0;
  int num_checked = 0;
  for (unsigned seed = 0; seed < kNumGraphs; ++seed) {
    SCOPED_TRACE(seed);
    // Without free edges and with some heuristic everywhere, so that no two keys are equal.
    ExplicitGraph graph = RandomGraph(seed, kGoal, /*with_free_edges=*/false);
    EagerAraStar eager(graph);
    AraStar<ExplicitGraph> lazy(&graph, kStart, kGoal);
    for (const double epsilon : {9.0, 4.0, 2.0, 1.5, 1.2, 1.0}) {
      graph.expanded.clear();
      lazy.ImprovePath(epsilon, kNever);
      ASSERT_EQ(graph.expanded, eager.ImprovePath(epsilon)) << "epsilon " << epsilon;
      ASSERT_EQ(lazy.goal_cost(), eager.goal_cost()) << "epsilon " << epsilon;
    }
    num_edges += static_cast<int>(lazy.num_edges_generated());
    num_checked += graph.num_validity_checks;
  }
  EXPECT_LT(num_checked, num_edges / 2);
}

TEST(AraStar, AsksOnlyAboutEdgesThatComeOutFirst) {
  ExplicitGraph graph(4);
  graph.Add(0, 2, 1);
  graph.Add(0, 1, 5);
  graph.Add(0, 3, 9);  // too far
  graph.Add(2, 0, 1);  // back to the start
  graph.Add(2, 1, 6);  // dearer than what is known
  graph.Add(2, 2, 0);  // nowhere
  AraStar<ExplicitGraph> search(&graph, 0, 1);
  EXPECT_EQ(search.ImprovePath(1, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(graph.expanded, (std::vector<StateId>{0, 2}));
  EXPECT_EQ(graph.num_validity_checks, 2);
  EXPECT_EQ(search.num_expansions(), 2);
  EXPECT_EQ(search.num_edges_generated(), 6);
}

TEST(AraStar, StartThatIsTheGoalNeedsNoSearch) {
  ExplicitGraph graph(1);
  AraStar<ExplicitGraph> search(&graph, 0, 0);
  EXPECT_EQ(search.ImprovePath(3, kNever), ImproveOutcome::kConverged);
  EXPECT_EQ(search.goal_cost(), 0);
  EXPECT_EQ(BoundOf(search), 1);
  EXPECT_EQ(search.Path().size(), 1U);
  EXPECT_TRUE(graph.expanded.empty());
}

TEST(AraStar, StoppedAtOnceHasEvaluatedNothing) {
  ExplicitGraph graph = GraphWithLateImprovement();
  AraStar<ExplicitGraph> search(&graph, 0, 1);
  EXPECT_EQ(search.ImprovePath(2, [] { return true; }), ImproveOutcome::kStopped);
  EXPECT_EQ(BoundOf(search), kInfinity);
  EXPECT_TRUE(search.Path().empty());
  EXPECT_EQ(graph.num_validity_checks, 0);
}

}  // namespace
}  // namespace planbench
