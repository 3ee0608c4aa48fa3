#include "bus_tools/diagnosis.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/version.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/private_bus.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;
using Kind = Finding::Kind;

std::vector<Finding> Look(const std::string& url, int listen_ms = 50) {
  return Diagnose({.lcm_url = url,
                   .listen = std::chrono::milliseconds(listen_ms),
                   .num_small = 20,
                   .num_large = 2});
}

/// The finding whose text begins with that.
Finding Of(const std::vector<Finding>& findings, const std::string& subject) {
  for (const Finding& finding : findings) {
    if (finding.text.compare(0, subject.size(), subject) == 0) return finding;
  }
  ADD_FAILURE() << "nothing is said of " << subject;
  return {};
}

TEST(Diagnosis, OfAQuietBusFindsNoFault) {
  const std::vector<Finding> findings = Look(PrivateUdpUrl());
  for (const std::string subject : {"route", "reach", "port", "types"}) {
    EXPECT_EQ(Of(findings, subject).kind, Kind::kGood) << Of(findings, subject).text;
  }
  EXPECT_THAT(Of(findings, "loss").text, HasSubstr("messages of 1 kB arrived"));
  EXPECT_THAT(findings.back().text, HasSubstr("messages of 1 MB arrived"));
}

TEST(Diagnosis, NamesWhatTheUrlLacks) {
  const std::string port = fmt::format("udpm://239.255.76.67:{}", FreeUdpPort());
  EXPECT_EQ(Of(Look(port), "reach").kind, Kind::kGood) << "LCM's own default stays here";
  const std::string bare = port + "?ttl=1";
  const std::vector<Finding> findings = Look(bare);
  EXPECT_EQ(Of(findings, "reach").kind, Kind::kNote);
  EXPECT_THAT(Of(findings, "reach").mend, HasSubstr("ttl=0"));
  EXPECT_EQ(Of(findings, "receive buffer").kind, Kind::kNote);
  EXPECT_THAT(Of(findings, "receive buffer").mend, HasSubstr("recv_buf_size=4194304"));
  EXPECT_EQ(Of(Look(bare + "&recv_buf_size=100000"), "receive buffer").kind, Kind::kFault);
  ExpectInputError([] { Look("tcpq://localhost"); }, {"tcpq://localhost", "udpm://"});
}

TEST(Diagnosis, NamesWhoElseIsOnThePort) {
  const std::string url = PrivateUdpUrl();
  Bus bus(url);
  bus.Start();
  NodeStatusMessage one;
  one.name = "scene_server";
  one.kind = NodeKind::kSceneServer;
  one.host = "here";
  one.pid = 11;
  one.start_utime = 1;
  one.instance = std::string(16, 'a');
  one.version = Version();
  NodeStatusMessage twin = one;
  twin.pid = 12;
  twin.instance = std::string(16, 'b');
  twin.version = "0.0.1";
  NodeStatusMessage planner = one;
  planner.name = "straight";
  planner.kind = NodeKind::kPlanner;
  planner.pid = 13;
  planner.instance = std::string(16, 'c');
  planner.version = "example";
  NodeStatusMessage homonym = planner;
  homonym.name = "Straight";
  homonym.pid = 15;
  homonym.instance = std::string(16, 'e');
  std::vector<NodeStatusMessage> loggers(2, one);
  for (NodeStatusMessage& logger : loggers) {
    logger.name = "logger";
    logger.kind = NodeKind::kLogger;
    logger.instance = std::string(16, 'd');
  }
  loggers[1].pid = 14;
  const Subscription asked =
      bus.Subscribe<DiscoverMessage>(channel::kDiscover, [&](const DiscoverMessage&) {
        bus.Publish(channel::kNodeStatus, one);
        bus.Publish(channel::kNodeStatus, twin);
        bus.Publish(channel::kNodeStatus, planner);
        bus.Publish(channel::kNodeStatus, homonym);
        for (const NodeStatusMessage& logger : loggers) bus.Publish(channel::kNodeStatus, logger);
        bus.PublishBytes("STRANGE", std::vector<std::uint8_t>(30, 9));
      });
  const std::vector<Finding> findings = Look(url, 1500);
  EXPECT_THAT(
      Of(findings, "port").text,
      testing::AllOf(HasSubstr("6 processes on it"), HasSubstr("scene_server, pid 11 on here"),
                     HasSubstr("pid 12"), HasSubstr("version 0.0.1")));
  for (const std::string subject : {"names: 2", "scene servers: 2", "versions", "types: 1"}) {
    const Finding finding = Of(findings, subject);
    EXPECT_EQ(finding.kind, Kind::kFault) << finding.text;
    EXPECT_FALSE(finding.mend.empty());
  }
  EXPECT_THAT(Of(findings, "names").text, HasSubstr("'scene_server'"));
  for (const Finding& finding : findings) EXPECT_THAT(finding.text, Not(HasSubstr("'logger'")));
  EXPECT_EQ(Of(findings, "names: the planners").text,
            "names: the planners 'Straight' and 'straight' share their channels "
            "(PLAN_REQUEST_STRAIGHT, ...)");
  EXPECT_THAT(Of(findings, "versions: this").text,
              testing::AllOf(HasSubstr("0.0.1"), Not(HasSubstr("example"))));
  EXPECT_EQ(Of(findings, "versions: planners").kind, Kind::kNote);
  EXPECT_THAT(Of(findings, "versions: planners").text, HasSubstr("straight (example)"));
  EXPECT_THAT(Of(findings, "types").text, HasSubstr("STRANGE"));
}

TEST(FindingText, HasTheMendBelow) {
  EXPECT_EQ(FindingText({Kind::kFault, "loss", "do this"}), "FAULT  loss\n       -> do this\n");
  EXPECT_EQ(FindingText({Kind::kGood, "route", ""}), "good   route\n");
}

}  // namespace
}  // namespace planbench
