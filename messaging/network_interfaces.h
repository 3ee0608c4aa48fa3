#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace planbench {

/// A network interface of this machine.
struct NetworkInterface {
  std::string name;
  bool is_loopback = false;
  int mtu_bytes = 0;  ///< Of the largest packet that leaves by it in one piece; 0: unknown.
};

/// The interface by which this machine's messages to a multicast group leave; nothing if there is
/// no route.
std::optional<NetworkInterface> InterfaceOfRoute(const std::string& group);

/// What to do as root, so that messages with that ttl have the multicast route that they need:
/// within this machine with ttl 0, else by an interface to the network, one of those being named
/// that are up and have an IPv4 address.
std::string MulticastRouteAdvice(int ttl);

/// Whether packets from that address, in host byte order, are this machine's.
bool IsOfThisMachine(std::uint32_t address);

}  // namespace planbench
