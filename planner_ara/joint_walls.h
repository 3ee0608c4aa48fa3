#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/edge_checker.h"

namespace planbench {

/// By joint: of a continuous one that cannot turn the short way round from `start` to `goal` (n
/// joints, valid) a position in [-pi, pi) on that way, the one that collides most often. It cannot
/// if it collides on the way, moved alone, wherever the other joints were tried: where they are at
/// both ends, and where they were drawn, always the same, and it is free at both of its own.
/// Nothing for other joints, and where too little was drawn to tell.
std::vector<std::optional<double>> FindWalls(EdgeChecker* edges, std::span<const double> start,
                                             std::span<const double> goal);

}  // namespace planbench
