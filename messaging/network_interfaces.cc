#include "messaging/network_interfaces.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <memory>
#include <set>

namespace planbench {
namespace {

/// Of interfaces with an IPv4 address, one call an address.
void ForEachAddress(
    const std::function<void(const std::string& name, unsigned flags, std::uint32_t address)>& f) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address = {};
    std::memcpy(&address, entry->ifa_addr, sizeof(address));
    f(entry->ifa_name, entry->ifa_flags, ntohl(address.sin_addr.s_addr));
  }
}

NetworkInterface Describe(int socket_fd, const char* name) {
  NetworkInterface described;
  described.name = name;
  ifreq request = {};
  described.name.copy(request.ifr_name, sizeof(request.ifr_name) - 1);
  if (ioctl(socket_fd, SIOCGIFFLAGS, &request) == 0) {
    described.is_loopback = (request.ifr_flags & IFF_LOOPBACK) != 0;
  }
  if (ioctl(socket_fd, SIOCGIFMTU, &request) == 0) described.mtu_bytes = request.ifr_mtu;
  return described;
}

/// On which the socket has joined the group; it leaves.
std::optional<NetworkInterface> LeaveWhereJoined(int socket_fd, ip_mreqn membership) {
  std::optional<NetworkInterface> found;
  struct if_nameindex* const all = if_nameindex();
  for (auto* each = all; each != nullptr && each->if_index != 0 && !found; ++each) {
    membership.imr_ifindex = static_cast<int>(each->if_index);
    if (setsockopt(socket_fd, IPPROTO_IP, IP_DROP_MEMBERSHIP, &membership, sizeof(membership)) ==
        0) {
      found = Describe(socket_fd, each->if_name);
    }
  }
  if (all != nullptr) if_freenameindex(all);
  return found;
}

}  // namespace

std::optional<NetworkInterface> InterfaceOfRoute(const std::string& group) {
  // Where a socket that joins on no interface in particular joins is where the route goes; its own
  // address would not tell, since a route by the loopback interface takes another's.
  ip_mreqn membership = {};
  if (inet_pton(AF_INET, group.c_str(), &membership.imr_multiaddr) != 1) return std::nullopt;
  const int socket_fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_fd < 0) return std::nullopt;
  std::optional<NetworkInterface> found;
  if (setsockopt(socket_fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0) {
    found = LeaveWhereJoined(socket_fd, membership);
  }
  close(socket_fd);
  return found;
}

std::string MulticastRouteAdvice(int ttl) {
  if (ttl == 0) {
    return "as root: ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo";
  }
  std::set<std::string> outward;
  ForEachAddress([&](const std::string& name, unsigned flags, std::uint32_t) {
    if ((flags & IFF_UP) != 0 && (flags & IFF_LOOPBACK) == 0) outward.insert(name);
  });
  if (outward.empty()) {
    return "no interface to a network is up and has an IPv4 address: bring one up, then, as root: "
           "ip route replace 224.0.0.0/4 dev INTERFACE";
  }
  const std::string advice =
      fmt::format("as root: ip route replace 224.0.0.0/4 dev {}", *outward.begin());
  if (outward.size() == 1) return advice;
  return fmt::format("{}, or whichever of {} is the session's network", advice,
                     fmt::join(outward, ", "));
}

bool IsOfThisMachine(std::uint32_t address) {
  bool is_own = address >> 24 == IN_LOOPBACKNET;
  ForEachAddress(
      [&](const std::string&, unsigned, std::uint32_t own) { is_own = is_own || own == address; });
  return is_own;
}

}  // namespace planbench
