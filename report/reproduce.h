#pragma once

#include <string>

#include "results/stored_session.h"

namespace planbench {

/// The command that runs a session again, from the driver's flags as it recorded them, quoted for a
/// shell; "" if they are not known. Flags that were left out, and those that name this session's
/// own folder or bus, are not in it.
std::string ReproducingCommand(const StoredSession& session);

}  // namespace planbench
