#include "bus_tools/diagnosis.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "common/version.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "tests/messaging/stranger.h"
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
  EXPECT_THAT(Of(findings, "loss within this machine").text, HasSubstr("messages of 1 kB arrived"));
  EXPECT_THAT(findings.back().text, HasSubstr("messages of 1 MB arrived"));
}

TEST(Diagnosis, NamesWhatTheUrlLacks) {
  const std::string port = fmt::format("udpm://239.255.76.67:{}", FreeUdpPort());
  EXPECT_EQ(Of(Look(port), "reach").kind, Kind::kGood) << "LCM's own default stays here";
  const std::string bare = port + "?ttl=1";
  const std::vector<Finding> findings = Look(bare);
  const Finding reach = Of(findings, "reach");
  EXPECT_NE(reach.kind, Kind::kGood) << "a fault where this machine's route goes by 'lo'";
  EXPECT_THAT(reach.mend, HasSubstr(reach.kind == Kind::kNote ? "ttl=0" : "ip route"));
  EXPECT_EQ(Of(findings, "way: nobody on another machine").kind, Kind::kNote);
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
  for (const std::string subject : {"names: 2", "scene servers: 2", "versions", "types: "}) {
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

NodeStatusMessage Announced(const std::string& name, NodeKind kind, int pid,
                            const std::string& robot_id) {
  NodeStatusMessage status;
  status.name = name;
  status.kind = kind;
  status.host = "here";
  status.pid = pid;
  status.start_utime = 1;
  status.instance = std::string(16, 'a');
  status.version = Version();
  status.robot_name = robot_id.empty() ? "" : "arm";
  status.robot_id = robot_id;
  return status;
}

/// What is found where that is announced to whoever asks.
std::vector<Finding> LookAmong(const std::vector<NodeStatusMessage>& nodes) {
  const std::string url = PrivateUdpUrl();
  Bus bus(url);
  bus.Start();
  const Subscription asked =
      bus.Subscribe<DiscoverMessage>(channel::kDiscover, [&](const DiscoverMessage&) {
        for (const NodeStatusMessage& node : nodes) bus.Publish(channel::kNodeStatus, node);
      });
  return Look(url, 1500);
}

TEST(Diagnosis, NamesRobotsAndDriversOfWhichThereIsToBeOne) {
  const std::string id = "0123456789abcdef0123456789abcdef";
  const std::string other_id = "fedcba9876543210fedcba9876543210";
  const std::vector<Finding> findings = LookAmong(
      {Announced("driver", NodeKind::kDriver, 1, ""), Announced("driver", NodeKind::kDriver, 2, ""),
       Announced("scene_server", NodeKind::kSceneServer, 3, id),
       Announced("ara", NodeKind::kPlanner, 4, id),
       Announced("rrtc", NodeKind::kPlanner, 5, other_id)});
  EXPECT_EQ(Of(findings, "robots").kind, Kind::kFault);
  EXPECT_EQ(Of(findings, "robots").text,
            "robots: 2 on one bus: arm [01234567] of ara on here, scene_server on here; "
            "arm [fedcba98] of rrtc on here");
  EXPECT_EQ(Of(findings, "drivers: 2").kind, Kind::kFault);
  EXPECT_THAT(Of(findings, "drivers: 2").mend, HasSubstr("--resume"));
}

TEST(Diagnosis, TakesProcessesOfOneNamePidAndHostForTwo) {
  const std::string url = PrivateUdpUrl();
  Bus first(url);
  Bus second(url);
  const NodeStatusMessage planner = Announced("rrtc", NodeKind::kPlanner, 1, "");
  first.Start();
  const Subscription asked =
      first.Subscribe<DiscoverMessage>(channel::kDiscover, [&](const DiscoverMessage&) {
        for (Bus* bus : {&first, &second}) bus->Publish(channel::kNodeStatus, planner);
      });
  EXPECT_EQ(Of(Look(url, 1500), "names: 2 processes are called 'rrtc'").kind, Kind::kFault);
}

TEST(Diagnosis, TellsWhatOthersSentInVain) {
  const std::string url = PrivateUdpUrl();
  Bus bus(url);
  bus.Start();
  const Stranger stranger(url);
  char number = 0;
  const Subscription asked =
      bus.Subscribe<DiscoverMessage>(channel::kDiscover, [&](const DiscoverMessage&) {
        number = static_cast<char>(number + 3);
        stranger.Send(std::string("LC02\0\0\0", 7) + number + std::string("A\0", 2));
      });
  const std::vector<Finding> findings = Look(url, 1500);
  const auto lost = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.text.find("did not come") != std::string::npos;
  });
  ASSERT_NE(lost, findings.end());
  EXPECT_EQ(lost->kind, Kind::kFault);
  EXPECT_THAT(lost->text, testing::StartsWith("way: "));
}

TEST(FindingText, HasTheMendBelow) {
  EXPECT_EQ(FindingText({Kind::kFault, "loss", "do this"}), "FAULT  loss\n       -> do this\n");
  EXPECT_EQ(FindingText({Kind::kGood, "route", ""}), "good   route\n");
}

}  // namespace
}  // namespace planbench
