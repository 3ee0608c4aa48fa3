#pragma once

#include <queue>
#include <utility>
#include <vector>

#include "planner_ara/manipulation_graph.h"
#include "tests/planner_ara/is_free.h"
#include "tests/planner_ara/point_goal.h"

namespace planbench {

/// Cost of the best path of the lattice anchored at `start`, by Dijkstra's algorithm.
inline double LatticeOptimum(EdgeChecker* edges, const Configuration& start,
                             const Configuration& goal, const ManipulationGraphOptions& options,
                             const std::vector<Path>& recalled = {}) {
  ManipulationGraph graph(edges, start, PointGoal(goal), options);
  graph.AddPaths(recalled);
  std::vector<double> costs(2, kInfinity);
  costs[ManipulationGraph::kStart] = 0;
  std::priority_queue<std::pair<double, StateId>> queue;
  queue.push({0, ManipulationGraph::kStart});
  std::vector<CandidateEdge> candidates;
  while (!queue.empty()) {
    const auto [negative, s] = queue.top();
    queue.pop();
    if (-negative > costs[s] || s == ManipulationGraph::kGoal) continue;
    candidates.clear();
    graph.CandidateEdges(s, &candidates);
    for (const CandidateEdge& edge : candidates) {
      const StateId t = graph.Target(s, edge.action);
      if (t >= costs.size()) costs.resize(t + 1, kInfinity);
      if (costs[s] + edge.cost >= costs[t] || !IsFree(graph, s, edge.action)) continue;
      costs[t] = costs[s] + edge.cost;
      queue.push({-costs[t], t});
    }
  }
  return costs[ManipulationGraph::kGoal];
}

}  // namespace planbench
