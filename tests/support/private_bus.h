#pragma once

#include <string>

#include "messaging/lcm_url.h"

namespace planbench {

/// A real LCM bus that no other process is on.
inline std::string PrivateUdpUrl() { return LcmUrl(FreeUdpPort()); }

}  // namespace planbench
