#pragma once

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "planner_ara/ara_star.h"

namespace planbench {

/// An explicit directed graph, some of whose edges are blocked, that keeps count of what a search
/// asks.
struct ExplicitGraph {
  struct Edge {
    StateId target;
    double cost;
    bool valid;
  };
  std::vector<std::vector<Edge>> edges;  // by source
  std::vector<double> heuristic;

  std::vector<StateId> expanded;  // in order
  int num_validity_checks = 0;
  int checks_left = -1;     // then one is given up; negative: none is
  unsigned guide_seed = 0;  // of a guide without sense; 0: the heuristic

  explicit ExplicitGraph(std::size_t num_states) : edges(num_states), heuristic(num_states, 0) {}
  void Add(StateId from, StateId to, double cost, bool valid = true) {
    edges[from].push_back({to, cost, valid});
  }

  void CandidateEdges(StateId state, std::vector<CandidateEdge>* candidates) {
    expanded.push_back(state);
    for (std::size_t i = 0; i < edges[state].size(); ++i) {
      const Edge& edge = edges[state][i];
      const double h = heuristic[edge.target];
      const double guide = guide_seed == 0 ? h : (edge.target * 7919 + guide_seed * 104729) % 101;
      candidates->push_back(
          {edge.cost, h, static_cast<float>(guide), static_cast<std::uint16_t>(i)});
    }
  }
  StateId Target(StateId source, std::uint16_t action) const {
    return edges[source][action].target;
  }
  EdgeVerdict CheckEdge(StateId source, std::uint16_t action) {
    if (checks_left-- == 0) return EdgeVerdict::kUnknown;
    ++num_validity_checks;
    return edges[source][action].valid ? EdgeVerdict::kFree : EdgeVerdict::kBlocked;
  }
};

/// Costs from `source` to every state over valid edges (along them, or against them), by relaxing
/// until nothing changes: as unlike the search under test as can be.
inline std::vector<double> TrueCosts(const ExplicitGraph& graph, StateId source, bool against) {
  std::vector<double> costs(graph.edges.size(), std::numeric_limits<double>::infinity());
  costs[source] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (StateId s = 0; s < graph.edges.size(); ++s) {
      for (const ExplicitGraph::Edge& edge : graph.edges[s]) {
        if (!edge.valid) continue;
        double& to = costs[against ? s : edge.target];
        const double cost = costs[against ? edge.target : s] + edge.cost;
        if (cost < to) {
          to = cost;
          changed = true;
        }
      }
    }
  }
  return costs;
}

/// A random graph with a random consistent heuristic for `goal`: uneven, so that weighted searches
/// meet states in the wrong order.
inline ExplicitGraph RandomGraph(unsigned seed, StateId goal, bool with_free_edges = true) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const int num_states = 5 + static_cast<int>(random() % 60);
  ExplicitGraph graph(static_cast<std::size_t>(num_states));
  const int num_edges = num_states * (2 + static_cast<int>(random() % 4));
  for (int i = 0; i < num_edges; ++i) {
    const auto from = static_cast<StateId>(random() % static_cast<unsigned>(num_states));
    const auto to = static_cast<StateId>(random() % static_cast<unsigned>(num_states));
    const bool is_free = with_free_edges && unit(random) < 0.05;
    graph.Add(from, to, is_free ? 0 : 10 * unit(random), unit(random) < 0.8);
  }
  const std::vector<double> to_goal = TrueCosts(graph, goal, /*against=*/true);
  for (std::size_t s = 0; s < graph.edges.size(); ++s) {
    graph.heuristic[s] = std::min(to_goal[s], 100.0) * unit(random);
  }
  // The largest consistent function below it.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t s = 0; s < graph.edges.size(); ++s) {
      for (const ExplicitGraph::Edge& edge : graph.edges[s]) {
        if (edge.valid && graph.heuristic[edge.target] + edge.cost < graph.heuristic[s]) {
          graph.heuristic[s] = graph.heuristic[edge.target] + edge.cost;
          changed = true;
        }
      }
    }
  }
  return graph;
}

}  // namespace planbench
