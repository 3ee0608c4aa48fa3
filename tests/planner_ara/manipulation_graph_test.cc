#include "planner_ara/manipulation_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <queue>
#include <set>
#include <utility>

#include "collision/collision_checker.h"
#include "support/expect_input_error.h"
#include "support/planning_problems.h"
#include "tests/planner_ara/bound_of.h"
#include "tests/planner_ara/is_free.h"
#include "tests/planner_ara/point_goal.h"

namespace planbench {
namespace {

const Configuration kLeft = {0.6, 0, 0};
const Configuration kRight = {-0.6, 0, 0};
const MotionPrimitives kSingleCells{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

GoalBox BoxAround(const Configuration& q, double tolerance) {
  GoalBox box = PointGoal(q);
  for (double& value : box.lower) value -= tolerance;
  for (double& value : box.upper) value += tolerance;
  return box;
}

// The planar arm between its two posts.
class ManipulationGraphTest : public testing::Test {
 protected:
  ManipulationGraphTest() {
    checker_->SetScene(PostsScene(), std::vector<double>(4, 0.0));
    edges_ = std::make_unique<EdgeChecker>(checker_.get(), robot_.edge_resolution_m,
                                           EdgeCheck::kCertified);
  }

  static ManipulationGraphOptions Options(double cell = 0.3) {
    ManipulationGraphOptions options;
    options.discretization.assign(3, cell);
    options.weights.assign(3, 1.0);
    options.primitives = kSingleCells;
    return options;
  }
  ManipulationGraph Graph(const GoalBox& goal, ManipulationGraphOptions options) {
    return ManipulationGraph(edges_.get(), kLeft, goal, std::move(options));
  }
  static std::vector<CandidateEdge> EdgesOf(ManipulationGraph* graph, StateId state) {
    std::vector<CandidateEdge> edges;
    graph->CandidateEdges(state, &edges);
    return edges;
  }
  // Follows edges breadth first, valid or not, until `num` states are known.
  static void Spread(ManipulationGraph* graph, StateId num) {
    for (StateId s = ManipulationGraph::kStart; s <= num && s <= graph->num_states(); ++s) {
      for (const CandidateEdge& edge : EdgesOf(graph, s)) graph->Target(s, edge.action);
    }
  }

  const Robot robot_ = LoadPlanarRobot();
  const JointSpace& space_ = robot_.groups.front().space;
  std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  std::unique_ptr<EdgeChecker> edges_;
};

TEST_F(ManipulationGraphTest, MovesLeadFromLatticePointToLatticePoint) {
  ManipulationGraph graph = Graph(PointGoal(kRight), Options());
  Spread(&graph, 300);
  ASSERT_GT(graph.num_states(), 300);
  int num_valid = 0;
  for (StateId s = 1; s < 300; ++s) {
    Configuration from(3);
    graph.ConfigurationOf(s, from);
    for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
      const StateId t = graph.Target(s, edge.action);
      Configuration to = kRight;
      if (t != ManipulationGraph::kGoal) {
        graph.ConfigurationOf(t, to);
        int num_moved = 0;
        for (int j = 0; j < 3; ++j) {
          const auto i = static_cast<std::size_t>(j);
          const double motion = std::abs(space_.Difference(j, from[i], to[i]));
          if (motion > 1e-9) {
            ++num_moved;
            EXPECT_NEAR(motion, graph.lattice().step(j), 1e-9);
          }
        }
        EXPECT_EQ(num_moved, 1);
        EXPECT_EQ(graph.Target(s, edge.action), t);
      }
      EXPECT_NEAR(edge.cost, space_.Distance(from, to), 1e-9);
      EXPECT_EQ(edge.target_heuristic, graph.Heuristic(t));
      const bool valid = IsFree(graph, s, edge.action);
      num_valid += valid ? 1 : 0;
      if (space_.WithinLimits(from) && edges_->IsValidState(from)) {
        EXPECT_EQ(valid, edges_->IsValidEdge(from, to));
      }
    }
  }
  EXPECT_GT(num_valid, 100);
  EXPECT_GT(graph.num_goal_connections_tried(), 0);
}

TEST_F(ManipulationGraphTest, RefinesItsMovesDownToSingleCells) {
  ManipulationGraphOptions options = Options(0.05);
  options.primitives = {{{4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 0}, {4, -4, 0}, {6, 0, 3}},
                        {{2, 0, 0}}};
  options.short_moves_within = 0.01;
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  const StateId state = graph.Target(ManipulationGraph::kStart, EdgesOf(&graph, 1)[1].action);
  ASSERT_NE(state, ManipulationGraph::kGoal);
  const auto cells_moved = [&](const CandidateEdge& edge) {
    Configuration from(3);
    Configuration to(3);
    graph.ConfigurationOf(state, from);
    graph.ConfigurationOf(graph.Target(state, edge.action), to);
    std::vector<int> cells;
    for (int j = 0; j < 3; ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double motion = space_.Difference(j, from[i], to[i]);
      cells.push_back(static_cast<int>(std::lround(motion / graph.lattice().step(j))));
    }
    return cells;
  };
  // What a level adds, without opposites.
  const std::vector<std::vector<std::vector<int>>> levels = {
      {{4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 0}, {4, -4, 0}, {6, 0, 3}},
      {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 0}, {2, -2, 0}, {3, 0, 1}},
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}}};
  std::multiset<std::vector<int>> expected;
  std::map<std::uint16_t, bool> verdicts;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    ASSERT_TRUE(level == 0 || graph.Refine());
    for (std::vector<int> row : levels[level]) {
      expected.insert(row);
      for (int& cells : row) cells = -cells;
      expected.insert(row);
    }
    std::multiset<std::vector<int>> moves;
    for (const CandidateEdge& edge : EdgesOf(&graph, state)) {
      if (graph.Target(state, edge.action) != ManipulationGraph::kGoal) {
        moves.insert(cells_moved(edge));
      }
      const auto checked = edges_->counters().edges;
      const bool valid = IsFree(graph, state, edge.action);
      const auto [known, is_new] = verdicts.emplace(edge.action, valid);
      EXPECT_EQ(known->second, valid);
      EXPECT_EQ(edges_->counters().edges - checked, is_new ? 1 : 0) << "a verdict was forgotten";
    }
    EXPECT_EQ(moves, expected);
  }
  EXPECT_FALSE(graph.Refine());
  options.refine = false;
  EXPECT_FALSE(Graph(PointGoal(kRight), options).Refine());
}

TEST_F(ManipulationGraphTest, RefinesMovesOfTheSameHalfOnce) {
  ManipulationGraphOptions options = Options(0.05);
  options.primitives = {{{4, 0, 0}, {5, 0, 0}}, {}};
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  const std::size_t num_edges = EdgesOf(&graph, ManipulationGraph::kStart).size();
  ASSERT_TRUE(graph.Refine());
  EXPECT_EQ(EdgesOf(&graph, ManipulationGraph::kStart).size(), num_edges + 2);
}

TEST_F(ManipulationGraphTest, RandomMovesGoSomewhatBeyondTheLargestBothWays) {
  ManipulationGraphOptions options = Options(0.02);
  options.primitives = {{{4, 0, 0}, {0, 8, 0}, {0, 0, 6}}, {}};
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  std::map<std::uint16_t, bool> before;
  for (const CandidateEdge& edge : EdgesOf(&graph, ManipulationGraph::kStart)) {
    before[edge.action] = IsFree(graph, ManipulationGraph::kStart, edge.action);
  }
  graph.AddRandomMoves(20, 1);
  Configuration from(3);
  Configuration to(3);
  graph.ConfigurationOf(ManipulationGraph::kStart, from);
  const std::array<int, 3> most = {6, 12, 9};
  std::set<std::vector<int>> moves;
  for (const CandidateEdge& edge : EdgesOf(&graph, ManipulationGraph::kStart)) {
    const auto checked = edges_->counters().edges;
    const bool valid = IsFree(graph, ManipulationGraph::kStart, edge.action);
    if (const auto known = before.find(edge.action); known != before.end()) {
      EXPECT_EQ(valid, known->second);
      EXPECT_EQ(edges_->counters().edges, checked) << "a verdict was forgotten";
      continue;
    }
    graph.ConfigurationOf(graph.Target(ManipulationGraph::kStart, edge.action), to);
    EXPECT_NEAR(edge.cost, space_.Distance(from, to), 1e-9);
    EXPECT_EQ(valid, edges_->IsValidEdge(from, to));
    std::vector<int> cells;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto joint = static_cast<int>(j);
      const double motion = space_.Difference(joint, from[j], to[j]);
      cells.push_back(static_cast<int>(std::lround(motion / graph.lattice().step(joint))));
      EXPECT_LE(std::abs(cells.back()), most[j]);
    }
    moves.insert(std::move(cells));
  }
  EXPECT_EQ(moves.size(), 40);
  for (std::vector<int> move : moves) {
    for (int& cells : move) cells = -cells;
    EXPECT_TRUE(moves.contains(move)) << "without its opposite";
  }
  int largest = 0;
  for (const std::vector<int>& move : moves) largest = std::max(largest, move[1]);
  EXPECT_GT(largest, 8);
}

TEST_F(ManipulationGraphTest, SpinesOfBursAreFreeUnchecked) {
  for (const MoveCost cost : {MoveCost::kDistance, MoveCost::kUniform}) {
    ManipulationGraphOptions options = Options(0.02);
    options.burs = true;
    options.cost = cost;
    ManipulationGraph graph = Graph(PointGoal(kRight), options);
    EdgeChecker fine(checker_.get(), 0.001, EdgeCheck::kFixed);
    Spread(&graph, 200);
    int num_spines = 0;
    for (StateId s = 1; s < 200; ++s) {
      Configuration from(3);
      graph.ConfigurationOf(s, from);
      if (!edges_->IsValidState(from)) continue;
      for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
        const StateId target = graph.Target(s, edge.action);
        EXPECT_LE(graph.Heuristic(s), edge.cost + graph.Heuristic(target) + 1e-9);
        if (target == ManipulationGraph::kGoal) continue;
        Configuration to(3);
        graph.ConfigurationOf(target, to);
        const auto checked = edges_->counters().edges;
        const bool valid = IsFree(graph, s, edge.action);
        if (edges_->counters().edges > checked) continue;
        EXPECT_TRUE(valid);
        EXPECT_TRUE(fine.IsValidEdge(from, to)) << s;
        num_spines += space_.Distance(from, to) > 0.03 ? 1 : 0;
      }
    }
    EXPECT_GT(num_spines, 100);
  }
}

TEST_F(ManipulationGraphTest, SpinesOfAJointThatMovesNoGeometryEndAtItsLimits) {
  Robot bare = robot_;
  const int hand = bare.model.FindLink("hand");
  std::erase_if(bare.spheres, [&](const LinkSphere& sphere) { return sphere.link == hand; });
  const auto checker = MakeCollisionChecker(bare, bare.groups.front(), CollisionModel::kSpheres);
  checker->SetScene(PostsScene(), std::vector<double>(4, 0.0));
  ASSERT_EQ(checker->motion_bound().reach()[2], 0);
  EdgeChecker edges(checker.get(), bare.edge_resolution_m, EdgeCheck::kCertified);
  ManipulationGraphOptions options = Options(0.1);
  options.burs = true;
  ManipulationGraph graph(&edges, kLeft, PointGoal(kRight), options);
  double furthest = 0;
  for (const CandidateEdge& edge : EdgesOf(&graph, ManipulationGraph::kStart)) {
    const StateId target = graph.Target(ManipulationGraph::kStart, edge.action);
    if (target == ManipulationGraph::kGoal) continue;
    Configuration to(3);
    graph.ConfigurationOf(target, to);
    EXPECT_TRUE(bare.groups.front().space.WithinLimits(to));
    furthest = std::max(furthest, to[2]);
  }
  EXPECT_NEAR(furthest, 2.6, 0.1);
}

TEST_F(ManipulationGraphTest, EagerEvaluationOffersTheValidEdgesOfALazyGraph) {
  ManipulationGraph lazy = Graph(PointGoal(kRight), Options());
  ManipulationGraphOptions options = Options();
  options.evaluation = Evaluation::kEager;
  ManipulationGraph eager = Graph(PointGoal(kRight), options);
  Spread(&lazy, 100);
  for (StateId s = 1; s < 100; ++s) {
    Configuration q(3);
    lazy.ConfigurationOf(s, q);
    if (!edges_->IsValidState(q)) continue;
    ManipulationGraph from_here(edges_.get(), q, PointGoal(kRight), options);
    std::vector<std::uint16_t> valid;
    for (const CandidateEdge& edge : EdgesOf(&lazy, s)) {
      if (IsFree(lazy, s, edge.action)) valid.push_back(edge.action);
    }
    std::vector<std::uint16_t> offered;
    for (const CandidateEdge& edge : EdgesOf(&from_here, ManipulationGraph::kStart)) {
      offered.push_back(edge.action);
    }
    EXPECT_EQ(offered, valid) << "state " << s;
  }
}

TEST_F(ManipulationGraphTest, AnEdgeThatWasGivenUpIsCheckedAnotherTime) {
  for (const Evaluation evaluation : {Evaluation::kLazy, Evaluation::kEager}) {
    ManipulationGraphOptions options = Options();
    options.evaluation = evaluation;
    const auto is_free = [&](ManipulationGraph* graph) {
      std::vector<bool> free;
      for (const CandidateEdge& edge : EdgesOf(graph, ManipulationGraph::kStart)) {
        free.push_back(IsFree(*graph, ManipulationGraph::kStart, edge.action));
      }
      return free;
    };
    ManipulationGraph undisturbed = Graph(PointGoal(kRight), options);
    const std::vector<bool> expected = is_free(&undisturbed);

    ManipulationGraph graph = Graph(PointGoal(kRight), options);
    edges_->StopWhen([] { return true; });
    // Until it is asked for the first time.
    const Configuration near = {0.7, 0, 0};
    while (!edges_->Stopped()) edges_->IsValidEdge(kLeft, near);
    const std::vector<CandidateEdge> offered = EdgesOf(&graph, ManipulationGraph::kStart);
    EXPECT_EQ(offered.size(), 7u) << "none is blocked for certain";
    for (const CandidateEdge& edge : offered) {
      EXPECT_EQ(graph.CheckEdge(ManipulationGraph::kStart, edge.action), EdgeVerdict::kUnknown);
    }
    edges_->StopWhen({});
    EXPECT_EQ(is_free(&graph), expected);
    EXPECT_EQ(graph.num_goal_connections_tried(), 1);
  }
}

TEST_F(ManipulationGraphTest, AHeuristicThatDoesNotWrapRemembersTheTurns) {
  ManipulationGraphOptions options = Options(2 * M_PI / 20);
  const std::size_t bytes_without = Graph(PointGoal(kRight), options).bytes();
  options.wrap_heuristic = false;
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  EXPECT_GT(graph.bytes(), bytes_without) << "what the turns take counts";
  const StateId start = ManipulationGraph::kStart;
  EXPECT_NEAR(graph.Heuristic(start), 1.2, 1e-9);
  // The first joint alone, upwards past half a turn: the way back grows and grows, up to the cell
  // that the start's move downwards reached first.
  StateId state = start;
  for (int i = 1; i < 19; ++i) {
    const std::vector<CandidateEdge> edges = EdgesOf(&graph, state);
    const auto up = std::max_element(edges.begin(), edges.end(), [](const auto& a, const auto& b) {
      return a.target_heuristic < b.target_heuristic;
    });
    state = graph.Target(state, up->action);
    EXPECT_EQ(up->target_heuristic, graph.Heuristic(state));
    EXPECT_NEAR(graph.Heuristic(state), 1.2 + i * 2 * M_PI / 20, 1e-9);
  }
}

TEST_F(ManipulationGraphTest, HeuristicIsConsistent) {
  for (const MoveCost cost : {MoveCost::kDistance, MoveCost::kUniform}) {
    for (const double tolerance : {0.0, 0.25}) {
      ManipulationGraphOptions options = Options();
      options.cost = cost;
      options.weights = {2, 0.5, 1};
      options.primitives.long_moves = {{2, 0, 0}, {3, -1, 2}};
      ManipulationGraph graph = Graph(BoxAround(kRight, tolerance), options);
      Spread(&graph, 2000);
      EXPECT_EQ(graph.Heuristic(ManipulationGraph::kGoal), 0);
      for (StateId s = 1; s < 2000; ++s) {
        for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
          EXPECT_LE(graph.Heuristic(s), edge.cost + edge.target_heuristic + 1e-12);
          if (cost == MoveCost::kUniform && graph.Target(s, edge.action) != 0) {
            EXPECT_EQ(edge.cost, 1);
          }
        }
      }
    }
  }
}

TEST_F(ManipulationGraphTest, SearchAtEpsilonOneFindsWhatDijkstraFinds) {
  for (const MoveCost cost : {MoveCost::kDistance, MoveCost::kUniform}) {
    ManipulationGraphOptions options = Options();
    options.cost = cost;

    // Dijkstra over every lattice point that can be reached.
    ManipulationGraph all = Graph(PointGoal(kRight), options);
    std::vector<double> costs(2, std::numeric_limits<double>::infinity());
    costs[ManipulationGraph::kStart] = 0;
    std::priority_queue<std::pair<double, StateId>> queue;
    queue.push({0, ManipulationGraph::kStart});
    while (!queue.empty()) {
      const auto [negative, s] = queue.top();
      queue.pop();
      if (-negative > costs[s] || s == ManipulationGraph::kGoal) continue;
      for (const CandidateEdge& edge : EdgesOf(&all, s)) {
        const StateId t = all.Target(s, edge.action);
        if (t >= costs.size()) costs.resize(t + 1, std::numeric_limits<double>::infinity());
        if (costs[s] + edge.cost >= costs[t] || !IsFree(all, s, edge.action)) continue;
        costs[t] = costs[s] + edge.cost;
        queue.push({-costs[t], t});
      }
    }
    const double optimum = costs[ManipulationGraph::kGoal];
    ASSERT_TRUE(std::isfinite(optimum));
    EXPECT_GT(optimum, all.Heuristic(ManipulationGraph::kStart) * 1.01);  // there is a way round

    ManipulationGraph graph = Graph(PointGoal(kRight), options);
    AraStar<ManipulationGraph> search(&graph, ManipulationGraph::kStart, ManipulationGraph::kGoal);
    for (const double epsilon : {10.0, 2.0, 1.0}) {
      ASSERT_EQ(search.ImprovePath(epsilon, [] { return false; }), ImproveOutcome::kConverged);
      EXPECT_LE(search.goal_cost(), epsilon * optimum + 1e-9);
      EXPECT_LE(search.goal_cost(), BoundOf(search) * optimum + 1e-9);
      const Path path = graph.Configurations(search.Path());
      EXPECT_EQ(path.front(), kLeft);
      EXPECT_EQ(path.back(), kRight);
      for (std::size_t i = 1; i < path.size(); ++i) {
        EXPECT_TRUE(edges_->IsValidEdge(path[i - 1], path[i]));
      }
    }
    EXPECT_NEAR(search.goal_cost(), optimum, 1e-9);
    EXPECT_LT(graph.num_states(), all.num_states());
  }
}

TEST_F(ManipulationGraphTest, GoalBoxIsReachedAtItsNearestOrNominalPoint) {
  const GoalBox box = BoxAround(kRight, 0.2);
  ManipulationGraph graph = Graph(box, Options());
  const std::vector<CandidateEdge> edges = EdgesOf(&graph, ManipulationGraph::kStart);
  ASSERT_GE(edges.size(), 2U);
  const Path nearest = graph.Configurations(
      {{ManipulationGraph::kStart, 0}, {ManipulationGraph::kGoal, edges[0].action}});
  const Path nominal = graph.Configurations(
      {{ManipulationGraph::kStart, 0}, {ManipulationGraph::kGoal, edges[1].action}});
  EXPECT_NEAR(nearest.back()[0], -0.4, 1e-12);
  EXPECT_EQ(nominal.back(), kRight);
  EXPECT_NEAR(edges[0].cost, 1.0, 1e-12);
  EXPECT_NEAR(edges[1].cost, 1.2, 1e-12);
  EXPECT_EQ(graph.Target(ManipulationGraph::kStart, edges[0].action), ManipulationGraph::kGoal);
  EXPECT_EQ(graph.Target(ManipulationGraph::kStart, edges[1].action), ManipulationGraph::kGoal);
}

TEST_F(ManipulationGraphTest, RemembersWhatItHasChecked) {
  ManipulationGraphOptions options = Options();
  for (int k = 0; k < 20; ++k) options.primitives.long_moves.push_back({2, k % 3, -1});
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  Spread(&graph, 100);
  std::vector<bool> first;
  for (StateId s = 1; s < 100; ++s) {
    for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
      first.push_back(IsFree(graph, s, edge.action));
    }
  }
  EXPECT_EQ(edges_->counters().edges, static_cast<std::int64_t>(first.size()));
  std::vector<bool> second;
  for (StateId s = 1; s < 100; ++s) {
    for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
      second.push_back(IsFree(graph, s, edge.action));
    }
  }
  EXPECT_EQ(second, first);
  EXPECT_EQ(edges_->counters().edges, static_cast<std::int64_t>(first.size()));
}

TEST_F(ManipulationGraphTest, PrimitivesCanBeKeptToTheirPlaces) {
  ManipulationGraphOptions options = Options();
  options.primitives.long_moves = {{4, 0, 0}};
  options.long_moves_beyond = 0.5;
  options.short_moves_within = 0.5;
  ManipulationGraph graph = Graph(PointGoal({-2.0, 0, 0}), options);
  Spread(&graph, 500);
  const double long_step = 4 * graph.lattice().step(0);
  int num_near = 0;
  int num_far = 0;
  for (StateId s = 1; s < 500; ++s) {
    Configuration q(3);
    graph.ConfigurationOf(s, q);
    const double distance =
        std::min(space_.Distance(q, kLeft), space_.Distance(q, Configuration{-2.0, 0, 0}));
    for (const CandidateEdge& edge : EdgesOf(&graph, s)) {
      if (graph.Target(s, edge.action) == ManipulationGraph::kGoal) continue;
      if (edge.cost > long_step - 1e-9) {
        EXPECT_GE(distance, 0.5);
        ++num_far;
      } else {
        EXPECT_LE(distance, 0.5);
        ++num_near;
      }
    }
  }
  EXPECT_GT(num_near, 0);
  EXPECT_GT(num_far, 0);
}

TEST_F(ManipulationGraphTest, CrowdedPlacesArePutOff) {
  ManipulationGraphOptions options = Options();
  options.crowding = 0.5;
  options.crowded_joints = {1, 0, 0};  // all states of one shoulder angle are one place
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  for (int visits = 0; visits < 3; ++visits) {
    for (const CandidateEdge& edge : EdgesOf(&graph, ManipulationGraph::kStart)) {
      const double factor = 1 + 0.5 * (std::log2(1 + visits) + visits / 5.0);
      EXPECT_FLOAT_EQ(edge.guide, static_cast<float>(factor * edge.target_heuristic));
    }
  }
}

TEST_F(ManipulationGraphTest, HasNoMoreMovesThanItCanNumber) {
  ManipulationGraphOptions options = Options();
  // Beside 4 other edges there are numbers below 0x8000 for so many moves and their opposites.
  options.primitives = {{{4, 0, 0}, {0, 4, 0}}, {}};
  options.primitives.short_moves.assign(16380, {1, 0, 0});
  ManipulationGraph graph = Graph(PointGoal(kRight), options);
  const std::uint16_t last = EdgesOf(&graph, ManipulationGraph::kStart).back().action;
  EXPECT_EQ(last, 0x7fff);
  graph.CheckEdge(ManipulationGraph::kStart, last);
  EXPECT_EQ(edges_->counters().edges, 1) << "it was not checked";
  EXPECT_FALSE(graph.Refine()) << "no room for halves";
  EXPECT_EQ(EdgesOf(&graph, ManipulationGraph::kStart).back().action, last);

  options.primitives.short_moves.push_back({1, 0, 0});
  ExpectInputError([&] { Graph(PointGoal(kRight), options); }, {"16383 motion primitives"});
}

}  // namespace
}  // namespace planbench
