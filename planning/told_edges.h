#pragma once

#include <map>
#include <optional>
#include <string>

#include "robot_model/edge_check.h"

namespace planbench {

/// Settings by which planners tell that they sample edges by a rule of their own
/// (Planner::OwnEdgeSampling): a part of the extent instead of the request's resolution, and what
/// joints count by that resolution. They hold where edges are sampled, not where they are
/// certified.
inline constexpr char kSegmentFraction[] = "longest_valid_segment_fraction";
inline constexpr char kEdgeWeights[] = "edge_weights";

/// What samples the edges of a planner.
struct ToldSampling {
  std::optional<double> resolution_m;  ///< Of the request; none: the robot's, or none counts.
  std::string own;  ///< Rule of its own, e.g. "longest_valid_segment_fraction 0.005"; "": none.
};

/// The same of a planner of such effective settings that is asked for `method` (none: the robot's)
/// at `resolution_m`.
ToldSampling SamplingOf(std::optional<EdgeCheck> method, std::optional<double> resolution_m,
                        const std::map<std::string, std::string>& settings);

/// How its edges are checked: "certified", "fixed at 0.02 m", "fixed, own sampling:
/// longest_valid_segment_fraction 0.005".
std::string DescribeEdges(std::optional<EdgeCheck> method, std::optional<double> resolution_m,
                          const std::map<std::string, std::string>& settings);

}  // namespace planbench
