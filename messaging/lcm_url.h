#pragma once

#include <string>

namespace planbench {

inline constexpr int kDefaultLcmPort = 7667;

/// URL of the bus of this machine on a UDP port. Its receive buffer keeps large messages from being
/// dropped (lcmtypes/README.md).
std::string LcmUrl(int port = kDefaultLcmPort);

/// `flag` if not empty, else $LCM_DEFAULT_URL if set, else LcmUrl().
std::string ResolveLcmUrl(const std::string& flag);

/// A free UDP port, chosen at random among those that nobody has bound.
int FreeUdpPort();

}  // namespace planbench
