#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"
#include "benchmark_driver/line_up.h"
#include "messaging/messages.h"
#include "messaging/node_registry.h"

namespace planbench {

/// The planners of a session.
struct FoundPlanners {
  std::map<std::string, NodeStatusMessage> planners;  ///< All of the line-up, by name.
  std::vector<Contestant> first_planners;  ///< Who find paths for contestants and are none.
};

/// Completes the session's conditions, contestants included, by what the scene server (`served`)
/// and the planners of the line-up say of themselves. `names`: NamesGiven. Throws InputError for
/// planners that do not fit.
FoundPlanners CompleteConditions(const NodeRegistry& registry, const ProblemSetsMessage& served,
                                 const std::vector<LineUpEntry>& line_up,
                                 const std::map<std::string, std::string>& names,
                                 DriverOptions* options);

}  // namespace planbench
