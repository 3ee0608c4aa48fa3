#include "messaging/network_interfaces.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/own_network.h"

namespace planbench {
namespace {

std::string Described(const std::optional<NetworkInterface>& interface) {
  if (!interface) return "none";
  return fmt::format("{} {} {}", interface->name, interface->is_loopback ? "loopback" : "outward",
                     interface->mtu_bytes);
}

TEST(NetworkInterfaces, TellWhereTheMulticastRouteGoes) {
  const std::string group = "239.255.76.67";
  EXPECT_EQ(Described(InterfaceOfRoute("no address")), "none");
  const auto said = InOwnNetwork([&] {
    std::string routes = Described(InterfaceOfRoute(group));
    if (!RunsInShell(std::string(kMakeWire) + " && ip link set lo up && ip link set wire mtu 1400"))
      return std::string("no wire");
    RunsInShell(kRouteByWire);
    routes += ", " + Described(InterfaceOfRoute(group));
    // Of which the system still chooses the other interface's address to send from.
    RunsInShell("ip route replace 224.0.0.0/4 dev lo");
    return routes + ", " + Described(InterfaceOfRoute(group));
  });
  if (!said || *said == "no wire") GTEST_SKIP() << "needs a network of its own";
  EXPECT_EQ(*said, "none, wire outward 1400, lo loopback 65536");
}

TEST(NetworkInterfaces, AdviseARouteThatReachesAsFarAsMessages) {
  EXPECT_EQ(MulticastRouteAdvice(0),
            "as root: ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo");
  const auto said = InOwnNetwork([&] {
    const std::string without = MulticastRouteAdvice(1);
    if (!RunsInShell(std::string(kMakeWire) + " && ip link set lo up")) return std::string("none");
    const std::string with = MulticastRouteAdvice(1);
    RunsInShell("ip address add 10.9.7.1/24 dev end");
    return fmt::format("{}\n{}\n{}", without, with, MulticastRouteAdvice(1));
  });
  if (!said || *said == "none") GTEST_SKIP() << "needs a network of its own";
  EXPECT_EQ(*said,
            "no interface to a network is up and has an IPv4 address: bring one up, then, as root: "
            "ip route replace 224.0.0.0/4 dev INTERFACE\n"
            "as root: ip route replace 224.0.0.0/4 dev wire\n"
            "as root: ip route replace 224.0.0.0/4 dev end, or whichever of end, wire is the "
            "session's network");
}

TEST(NetworkInterfaces, KnowThisMachinesAddresses) {
  EXPECT_TRUE(IsOfThisMachine(0x7f000001));
  EXPECT_FALSE(IsOfThisMachine(0xcb007105)) << "203.0.113.5, of no machine";
}

}  // namespace
}  // namespace planbench
