#pragma once

#include <cstdint>

#include "messaging/node_registry.h"

namespace planbench {

/// Whether a process of that id runs on this machine, as far as can be seen from here.
bool IsRunning(std::int32_t pid);

/// Whether a node's process is the one of its id on this machine. Hosts of one name, and containers
/// with the host's, have ids of their own: it is, if it has the socket that the node sends from. In
/// doubt, as with a process whose sockets this one may not see, it is not.
bool IsSeenHere(const NodeRegistry::Node& node);

}  // namespace planbench
