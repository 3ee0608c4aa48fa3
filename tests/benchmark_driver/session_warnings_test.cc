#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "planning/told_warnings.h"
#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What a session tells of its robots or problems.
std::vector<std::string> ToldBy(const SessionMessage& session, const std::string& kind) {
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.kind == NodeKind::kSceneServer) return ToldWarnings(kind, node.settings);
  }
  return {};
}

TEST_F(DriverTest, WhatWasOddAboutRobotsAndProblemsIsToldWithTheSession) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_, {{std::string(kRobotWarning) + " 01", "arm.urdf: is odd"}});
  FakeLogger logger(&bus_);
  server.AlterProblems([](ProblemMessage* problem) {
    problem->message = "request000" + std::to_string(problem->problem_index) + ".yaml: is odd";
  });
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  options.robot_warnings = {"a mesh of 3000 m"};
  {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    MakeAll(&driver);
  }
  const std::vector<SessionMessage> sessions = logger.sessions().messages();
  for (const SessionMessage& session : {sessions.front(), sessions.back()}) {
    EXPECT_THAT(ToldBy(session, kRobotWarning),
                ElementsAre("arm.urdf: is odd", "a mesh of 3000 m"));
    EXPECT_THAT(ToldBy(session, kProblemWarning), ElementsAre("request0001.yaml: is odd"))
        << "one of a kind";
    for (const NodeStatusMessage& node : session.nodes) {
      if (node.kind == NodeKind::kSceneServer) continue;
      EXPECT_THAT(ToldWarnings(kRobotWarning, node.settings), IsEmpty()) << node.name;
    }
  }
  // Resumed, it asks for nothing, and forgets nothing.
  Driver again(&bus_, options, LineUp({"arm"}), {}, {sessions, Held(logger.records().messages())});
  MakeAll(&again);
  EXPECT_THAT(ToldBy(logger.sessions().messages().back(), kProblemWarning),
              ElementsAre("request0001.yaml: is odd"));
}

/// Hosts of the nodes of a name that a session tells of.
std::multiset<std::string> HostsOf(const std::string& name, const SessionMessage& session) {
  std::multiset<std::string> hosts;
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.name == name) hosts.insert(node.host);
  }
  return hosts;
}

TEST_F(DriverTest, APlannerThatComesBackOnAnotherHostIsTold) {
  std::atomic<bool> dies = false;
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.request_id.find("/forward/2@") == std::string::npos) return planner.Solve(request);
    dies = true;
  });
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  options.problem_indices = {1};
  options.trials = 4;
  {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    driver.Discover(true, Idle);
    bool has_come = false;
    testing::internal::CaptureStdout();  // Where messages go.
    EXPECT_TRUE(driver.Run(Never, [&] {
      if (!dies || std::exchange(has_come, true)) return;
      planner.status.host = "elsewhere";
      planner.Restart();
    }));
    const std::string said = testing::internal::GetCapturedStdout();
    const std::size_t told = said.find("and is on elsewhere from");
    EXPECT_NE(told, std::string::npos) << said;
    EXPECT_EQ(said.find("and is on elsewhere from", told + 1), std::string::npos) << "once";
  }
  const std::vector<SessionMessage> sessions = logger.sessions().messages();
  const auto is_told = ElementsAre("the planner 'arm' was on " + HostName() +
                                   " and is on elsewhere from run/cans/1/arm/forward/3 on: its "
                                   "times are not of one machine");
  const std::multiset<std::string> both = {HostName(), "elsewhere"};
  EXPECT_THAT(ToldBy(sessions.front(), kPlannerWarning), IsEmpty());
  EXPECT_THAT(ToldBy(sessions.back(), kPlannerWarning), is_told);
  EXPECT_EQ(HostsOf("arm", sessions.back()), both);
  // The resumed session finds it where it is, and forgets nothing.
  planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
  Driver again(&bus_, options, LineUp({"arm"}), {}, {sessions, Held(logger.records().messages())});
  MakeAll(&again);
  EXPECT_THAT(ToldBy(logger.sessions().messages().back(), kPlannerWarning), is_told);
  EXPECT_EQ(HostsOf("arm", logger.sessions().messages().back()), both);
}

TEST_F(DriverTest, OfASceneServerThatIsGoneAtTheEndTheWarningsStay) {
  PlanResult failed;
  failed.status = PlanStatus::kTimedOut;
  std::atomic<bool> is_asked = false;
  FakePlanner planner(&bus_);
  auto server = std::make_optional<FakeSceneServer>(
      &bus_, std::map<std::string, std::string>{{std::string(kRobotWarning) + " 01", "is odd"}});
  FakeLogger logger(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.request_id.ends_with("/warm-up")) {
      planner.SendResult(request.request_id, failed);
    } else {
      planner.Acknowledge(request, PlanAckVerdict::kWorking);
      is_asked = true;
    }
  });
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  options.problem_indices = {1};
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  NodeRegistry registry(&bus_);  // hears whatever the driver's does, and after it
  const auto is_gone = [&] { return registry.Live(NodeKind::kSceneServer).empty(); };
  ASSERT_TRUE(registry.WaitUntil([&] { return !is_gone(); }, kTestPatience));
  const auto end_server = [&] {
    if (!is_asked) return;
    server.reset();
    if (is_gone()) planner.SendResult(planner.requests().messages().back().request_id, failed);
  };
  EXPECT_TRUE(driver.Run(Never, end_server));
  EXPECT_THAT(ToldBy(logger.sessions().messages().back(), kRobotWarning), ElementsAre("is odd"));
}

}  // namespace
}  // namespace planbench
