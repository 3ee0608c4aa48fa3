#pragma once

#include "planner_ara/manipulation_graph.h"

namespace planbench {

inline bool IsFree(ManipulationGraph& graph, StateId source, std::uint16_t action) {
  return graph.CheckEdge(source, action) == EdgeVerdict::kFree;
}

}  // namespace planbench
