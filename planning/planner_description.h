#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "collision/collision_model.h"
#include "common/enum_names.h"

namespace planbench {

/// The study's taxonomy of planners.
enum class PlannerClass {
  kSampleThenSearch,
  kSamplingGuided,
  kSearchAndSample,
  kTrajectoryOptimisation,
};
template <>
struct EnumNames<PlannerClass> {
  static constexpr auto kNames = std::to_array<std::string_view>(
      {"sample-then-search", "sampling-guided", "search-and-sample", "trajectory-optimisation"});
};

/// What a planner says of itself.
struct PlannerDescription {
  std::string algorithm;  ///< "ARA*", "RRT-Connect", ...
  PlannerClass planner_class = PlannerClass::kSampleThenSearch;
  bool backward = true;  ///< Can search backward.
  bool anytime = false;  ///< Keeps improving when asked. Its paths have costs.
  bool improve = false;  ///< Takes the initial path of a request, and improves it.
  /// Searches from both ends at once (a roadmap has no direction at all): a backward request is the
  /// same experiment as a forward one.
  bool bidirectional = false;
  /// The same path and counts whatever the seed.
  bool deterministic = false;
  std::vector<CollisionModel> collision_models;
  std::map<std::string, std::string> settings;  ///< Effective settings, as text.
};

}  // namespace planbench
