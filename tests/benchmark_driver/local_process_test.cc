#include "benchmark_driver/local_process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "messaging/node_announcer.h"
#include "tests/benchmark_driver/idle_process.h"
#include "tests/support/private_bus.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

TEST(LocalProcessTest, RunsWhatHasNotEnded) {
  EXPECT_TRUE(IsRunning(getpid()));
  EXPECT_FALSE(IsRunning(0));
  EXPECT_FALSE(IsRunning(-1));
  const pid_t pid = StartProcess();
  EXPECT_TRUE(IsRunning(pid));
  EndProcess(pid);
  EXPECT_FALSE(IsRunning(pid));
}

TEST(LocalProcessTest, IsSeenIfItHasTheSocketThatTheNodeSendsFrom) {
  Bus bus(PrivateUdpUrl());
  NodeRegistry registry(&bus);
  bus.Start();
  const NodeStatusMessage self = MakeNodeStatus("arm", NodeKind::kPlanner);
  const NodeAnnouncer announcer(&bus, [&] { return self; });
  ASSERT_TRUE(registry.WaitUntil(
      [&] { return registry.FindNode("arm", NodeKind::kPlanner).has_value(); }, kTestPatience));
  const NodeRegistry::Node node = *registry.FindNode("arm", NodeKind::kPlanner);
  EXPECT_TRUE(IsSeenHere(node));

  NodeRegistry::Node other = node;
  other.status.host += "2";
  EXPECT_FALSE(IsSeenHere(other));
  // On a host of the same name, or in a container, another process has the id.
  other = node;
  other.status.pid = StartProcess();
  EXPECT_FALSE(IsSeenHere(other));
  EndProcess(other.status.pid);
  other = node;
  other.sender.port = 1;
  EXPECT_FALSE(IsSeenHere(other));
}

TEST(LocalProcessTest, OnABusWithinThisProcessItIsWhoeverRuns) {
  NodeRegistry::Node node;
  node.status = MakeNodeStatus("arm", NodeKind::kPlanner);
  EXPECT_TRUE(IsSeenHere(node));
  node.status.pid = 0;
  EXPECT_FALSE(IsSeenHere(node));
}

}  // namespace
}  // namespace planbench
