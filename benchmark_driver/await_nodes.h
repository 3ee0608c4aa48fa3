#pragma once

#include <functional>
#include <string>

#include "messaging/node_registry.h"

namespace planbench {

/// Asks everybody to announce himself until nothing is missing: `missing` names what is, "" for
/// nothing. `watch` is called meanwhile and may throw. Throws InputError with what is missing, and
/// who was heard, after `timeout_s`.
void AwaitNodes(NodeRegistry* registry, double timeout_s,
                const std::function<std::string()>& missing, const std::function<void()>& watch);

/// Throws InputError if a process is not of the driver's build: on one machine or on several, a
/// session compares planners, not versions of what is around them.
void RequireSameBuild(const NodeStatusMessage& node);

}  // namespace planbench
