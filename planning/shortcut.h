#pragma once

#include <cstdint>
#include <functional>

#include "collision/edge_checker.h"
#include "planning/plan_result.h"

namespace planbench {

/// The shared simplification pass: drops waypoints that a valid straight edge can bypass (greedily,
/// longest first), then, `rounds` times, tries 20 random shortcuts between points anywhere on the
/// path (Geraerts and Overmars, "Creating high-quality paths for motion planning", 2007), which
/// find the long ways round, and cuts every corner, which random ones seldom hit; what would
/// shorten it by less than three thousandths is left out. Every edge of the result is one of the
/// input's, was found valid by `edges`, or is part of one that `edges` has proven free (certified
/// edges). Never longer than the input. Deterministic for a seed. Ends keep their exact values.
/// `should_stop`, asked before each shortcut, ends it early: then the path is as short as it is.
Path ShortcutPath(EdgeChecker* edges, const Path& path, std::uint64_t seed, int rounds,
                  const std::function<bool()>& should_stop);

}  // namespace planbench
