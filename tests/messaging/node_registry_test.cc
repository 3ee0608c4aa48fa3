#include "messaging/node_registry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "tests/support/message_collector.h"
#include "tests/support/private_bus.h"

namespace planbench {
namespace {

using std::chrono::milliseconds;

NodeStatusMessage Status(const std::string& name, NodeKind kind) {
  NodeStatusMessage status;
  status.name = name;
  status.kind = kind;
  status.start_utime = 1;
  status.instance = "0123456789abcdef";
  status.host = "host";
  status.pid = 1;
  return status;
}

class NodeRegistryTest : public testing::Test {
 protected:
  NodeRegistryTest() { bus_.Start(); }

  void Hear(const NodeStatusMessage& status) { bus_.Publish(channel::kNodeStatus, status); }
  bool Await(const std::function<bool()>& condition) {
    return registry_.WaitUntil(condition, kTestPatience);
  }

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
};

TEST_F(NodeRegistryTest, KnowsNobodyAtFirst) {
  EXPECT_TRUE(registry_.Live().empty());
  EXPECT_FALSE(registry_.ProblemSets());
}

TEST_F(NodeRegistryTest, FindsByNameAndKind) {
  Hear(Status("ara", NodeKind::kPlanner));
  Hear(Status("rrtc", NodeKind::kPlanner));
  Hear(Status("logger", NodeKind::kLogger));
  ASSERT_TRUE(Await([&] { return registry_.Live().size() == 3; }));
  EXPECT_EQ(registry_.Live(NodeKind::kPlanner).size(), 2u);
  EXPECT_EQ(registry_.Live(NodeKind::kLogger).size(), 1u);
  EXPECT_TRUE(registry_.Live(NodeKind::kSceneServer).empty());
  EXPECT_TRUE(registry_.Find("ara", NodeKind::kPlanner));
  EXPECT_FALSE(registry_.Find("ara", NodeKind::kLogger));
  EXPECT_FALSE(registry_.Find("prm", NodeKind::kPlanner));
}

TEST_F(NodeRegistryTest, WaitsNoLongerThanTold) {
  auto shortest = std::chrono::steady_clock::duration::max();
  for (int time = 0; time < 10; ++time) {  // one of them, however loaded the machine is
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(registry_.WaitUntil([] { return false; }, milliseconds(1)));
    shortest = std::min(shortest, std::chrono::steady_clock::now() - begin);
  }
  EXPECT_LT(shortest, milliseconds(100));
}

TEST_F(NodeRegistryTest, KeepsTheLatestStatus) {
  NodeStatusMessage status = Status("ara", NodeKind::kPlanner);
  Hear(status);
  status.busy = true;
  status.request_id = "request";
  Hear(status);
  ASSERT_TRUE(Await([&] {
    const auto found = registry_.Find("ara", NodeKind::kPlanner);
    return found && found->busy;
  }));
  EXPECT_EQ(registry_.Find("ara", NodeKind::kPlanner)->request_id, "request");
  EXPECT_EQ(registry_.Live().size(), 1u);
}

TEST_F(NodeRegistryTest, WhoFallsSilentIsGoneAndMayComeBack) {
  const auto begin = std::chrono::steady_clock::now();
  Hear(Status("ara", NodeKind::kPlanner));
  ASSERT_TRUE(Await([&] { return !registry_.Live().empty(); }));
  ASSERT_TRUE(Await([&] { return registry_.Live().empty(); }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, NodeRegistry::kLostAfter);
  EXPECT_FALSE(registry_.Find("ara", NodeKind::kPlanner));
  Hear(Status("ara", NodeKind::kPlanner));
  EXPECT_TRUE(Await([&] { return registry_.Find("ara", NodeKind::kPlanner).has_value(); }));
}

TEST_F(NodeRegistryTest, KeepsTheLatestProblemSets) {
  ProblemSetsMessage sets;
  sets.server = "server";
  sets.robot_name = "robot";
  sets.robot_id = "id";
  sets.edge_resolution_m = 0.02;
  Hear(Status("server", NodeKind::kSceneServer));
  bus_.Publish(channel::kProblemSets, sets);
  sets.sets.push_back({"cans", {1, 2}, "cans-1"});
  bus_.Publish(channel::kProblemSets, sets);
  ASSERT_TRUE(
      Await([&] { return registry_.ProblemSets() && !registry_.ProblemSets()->sets.empty(); }));
  EXPECT_EQ(registry_.ProblemSets()->sets[0].indices, (std::vector<int>{1, 2}));
}

/// A registry, a process at work and another one, each with a connection of its own.
class RivalsTest : public testing::Test {
 protected:
  void SetUp() override {
    for (Bus* bus : {&bus_, &node_bus_, &other_bus_}) bus->Start();
  }
  static NodeStatusMessage Arm(const std::string& instance) {
    NodeStatusMessage status = Status("arm", NodeKind::kPlanner);
    status.instance = instance;
    return status;
  }
  std::string Holder() const {
    const auto found = registry_.Find("arm", NodeKind::kPlanner);
    return found ? found->instance : "";
  }
  bool Await(const std::function<bool()>& condition) {
    return registry_.WaitUntil(condition, kTestPatience);
  }

  const std::string url_ = PrivateUdpUrl();
  Bus bus_{url_};
  Bus node_bus_{url_};
  Bus other_bus_{url_};
  NodeRegistry registry_{&bus_};
};

TEST_F(RivalsTest, NobodyTakesTheNameOfALiveNodeWhateverHeSays) {
  const NodeAnnouncer node(&node_bus_, [] { return Arm("true"); });
  ASSERT_TRUE(Await([&] { return Holder() == "true"; }));
  NodeStatusMessage forged = Arm("forged");
  forged.start_utime = 0;
  NodeStatusMessage copied = Arm("true");
  copied.settings = {{"step", "9"}};
  for (std::int64_t noted = 1; noted < 5; ++noted) {
    // The answer to the question that this raises shows who is at work.
    other_bus_.Publish(channel::kNodeStatus, noted % 2 == 0 ? forged : copied);
    ASSERT_TRUE(Await([&] { return bus_.contradictions().count() >= noted; }));
    EXPECT_EQ(Holder(), "true");
    EXPECT_TRUE(registry_.Find("arm", NodeKind::kPlanner)->settings.empty());
  }
  EXPECT_NO_THROW(node.ThrowIfDisplaced());
}

TEST_F(RivalsTest, WhatWasStartedAgainTakesItsNameBeforeTheOldOneIsGivenUp) {
  node_bus_.Publish(channel::kNodeStatus, Arm("old"));
  ASSERT_TRUE(Await([&] { return Holder() == "old"; }));
  const auto begin = std::chrono::steady_clock::now();
  const NodeAnnouncer again(&other_bus_, [] { return Arm("new"); });
  ASSERT_TRUE(Await([&] { return Holder() == "new"; }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, NodeRegistry::kRivalPatience);
  EXPECT_EQ(bus_.contradictions().count(), 0);
}

TEST_F(RivalsTest, WhoComesInThePlaceOfAProcessThatIsKnownToHaveEndedHasItsNameAtOnce) {
  MessageCollector<DiscoverMessage> questions(&other_bus_, channel::kDiscover);
  node_bus_.Publish(channel::kNodeStatus, Arm("old"));
  ASSERT_TRUE(Await([&] { return Holder() == "old"; }));
  registry_.Forget(Arm("another"));
  EXPECT_EQ(Holder(), "old");
  registry_.Forget(Arm("old"));
  EXPECT_EQ(Holder(), "");
  node_bus_.Publish(channel::kNodeStatus, Arm("old"));
  ASSERT_TRUE(Await([&] { return Holder() == "old"; }));
  other_bus_.Publish(channel::kNodeStatus, Arm("new"));
  ASSERT_EQ(questions.WaitFor(1).size(), 1u) << "whether the old one is live";
  registry_.Forget(Arm("old"));
  EXPECT_EQ(Holder(), "new");
}

TEST_F(RivalsTest, OnlyTheNodeItselfIsBelieved) {
  const NodeAnnouncer node(&node_bus_, [] { return Arm("true"); });
  ASSERT_TRUE(Await([&] { return Holder() == "true"; }));
  const PacketSender sender = registry_.LiveNodes(NodeKind::kPlanner).at(0).sender;
  EXPECT_TRUE(registry_.Believes(sender, NodeKind::kPlanner, "arm", "CHANNEL"));
  EXPECT_FALSE(registry_.Believes({sender.address, 1}, NodeKind::kPlanner, "arm", "CHANNEL"));
  EXPECT_EQ(bus_.contradictions().count(), 1);
  EXPECT_FALSE(registry_.Believes(sender, NodeKind::kPlanner, "leg", "CHANNEL"));
  EXPECT_EQ(bus_.contradictions().count(), 1);  // nothing is known of one
}

TEST_F(RivalsTest, LoggersStandBesideEachOther) {
  NodeStatusMessage logger = Status("logger", NodeKind::kLogger);
  node_bus_.Publish(channel::kNodeStatus, logger);
  logger.instance = "another";
  other_bus_.Publish(channel::kNodeStatus, logger);
  EXPECT_TRUE(Await([&] { return registry_.LiveNodes(NodeKind::kLogger).size() == 2; }));
  EXPECT_EQ(bus_.contradictions().count(), 0);
}

TEST_F(NodeRegistryTest, DiscoverAsksEverybody) {
  MessageCollector<DiscoverMessage> questions(&bus_, channel::kDiscover);
  registry_.Discover("driver");
  const auto heard = questions.WaitFor(1);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].sender, "driver");
}

TEST_F(NodeRegistryTest, WaitingEndsWithTheTimeout) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(registry_.WaitUntil([] { return false; }, milliseconds(150)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(150));
  EXPECT_TRUE(registry_.WaitUntil([] { return true; }, milliseconds(0)));
}

}  // namespace
}  // namespace planbench
