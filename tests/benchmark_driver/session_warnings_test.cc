#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
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

}  // namespace
}  // namespace planbench
