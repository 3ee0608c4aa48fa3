#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

TEST_F(DriverTest, WhatIsSaidOfSeveralProblemsOfASetIsSaidOnce) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  server.AlterProblems([](ProblemMessage* problem) {
    problem->message =
        fmt::format("scene{0}.yaml:{0}: matrix: is odd by 0.{0},", problem->problem_index);
    if (problem->problem_index == 3) problem->message += " (and 2 more)";
  });
  const FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.problem_indices = {1, 2, 3};
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  testing::internal::CaptureStdout();  // Where messages go.
  MakeAll(&driver);
  const std::string output = testing::internal::GetCapturedStdout();
  EXPECT_THAT(output, testing::HasSubstr("scene1.yaml:1: matrix: is odd by 0.1,\n"));
  EXPECT_THAT(output, testing::HasSubstr("scene3.yaml:3: matrix: is odd by 0.3, (and 2 more)\n"));
  EXPECT_THAT(output, testing::Not(testing::HasSubstr("scene2.yaml")));
}

TEST_F(DriverTest, BadProblemsEndTheSessionBeforeItsFirstRun) {
  FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  server.RefuseProblem(1, "scene0001.yaml:7: world: is odd");
  server.RefuseProblem(3, "request0003.yaml:2: group_name: is even");
  DriverOptions options = Options();
  options.problem_indices = {};
  testing::internal::CaptureStdout();  // Where messages go.
  ExpectNotDiscovered(options, {"2 of 3 problems are bad", "--skip-bad-problems"});
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::AllOf(testing::HasSubstr("cans 1: scene0001.yaml:7: world: is odd"),
                             testing::HasSubstr("cans 3: request0003.yaml:2: group_name: is even"),
                             testing::Not(testing::HasSubstr("cans 2"))));
  EXPECT_TRUE(planner.requests().messages().empty());
}

TEST_F(DriverTest, BadProblemsMayBeLeftOut) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  server.RefuseProblem(2, "scene0002.yaml:7: world: is odd");
  DriverOptions options = Options();
  options.problem_indices = {};
  options.directions = Directions::kForward;
  options.skip_bad_problems = true;
  testing::internal::CaptureStdout();  // Where messages go.
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("cans 2: scene0002.yaml:7: world: is odd"));
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(Ids(logger.records()),
            (std::set<std::string>{"run/cans/1/arm/forward/1", "run/cans/3/arm/forward/1"}));
  EXPECT_EQ(logger.sessions().messages().back().num_runs, 2);
  const std::map<std::string, std::string> left_out = {
      {"cans 2", "scene0002.yaml:7: world: is odd"}};
  EXPECT_EQ(logger.sessions().messages().back().left_out, left_out);
  EXPECT_EQ(driver.left_out(), left_out);
  // With nothing else to do, the session is as complete as it was.
  Driver again(&bus_, options, LineUp({"arm"}), {},
               {logger.sessions().messages(), Held(logger.records().messages())});
  MakeAll(&again);
  EXPECT_EQ(again.runs().size(), 2u);

  for (const int index : {1, 3}) server.RefuseProblem(index, "is odd");
  options.conditions.request.run_id = "another";  // What was asked before is answered as before.
  ExpectNotDiscovered(options, {"all 3 problems are bad"});
}

TEST_F(DriverTest, AProblemAtWhichTheSceneServerFailsTwiceIsBad) {
  std::atomic<int> num_failures = 5;  // at others
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  const FakeLogger logger(&bus_);
  server.BeforeAnswers([&](const ProblemRequestMessage& request) {
    if (request.problem_index == 1) ++num_failures;  // somebody killed it
    if (request.problem_index != 2) return;
    num_failures += 2;
    // As a process that has died would, it does not answer while it is waited for.
    server.problem_requests().WaitForOne(
        [](const ProblemRequestMessage& next) { return next.problem_index == 3; });
  });
  DriverOptions options = Options();
  options.problem_indices = {};
  options.skip_bad_problems = true;
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle, CountedBy(num_failures));
  EXPECT_EQ(driver.left_out(),
            (std::map<std::string, std::string>{
                {"cans 2",
                 "twice the scene server died or fell silent when it was asked for the "
                 "problem cans 2"}}));
}

TEST_F(DriverTest, ASceneServerThatFailsAtEveryProblemIsItselfAtFault) {
  std::atomic<int> num_failures = 0;
  std::atomic<bool> is_over = false;
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  const FakeLogger logger(&bus_);
  server.BeforeAnswers([&](const ProblemRequestMessage& request) {
    num_failures += 2;
    WaitUntil([&] {
      return is_over || server.problem_requests().Count([&](const ProblemRequestMessage& next) {
        return next.problem_index > request.problem_index;
      }) > 0;
    });
  });
  DriverOptions options = Options();
  options.problem_indices = {};
  options.skip_bad_problems = true;
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  EXPECT_THAT([&] { driver.Discover(true, Idle, CountedBy(num_failures)); },
              testing::ThrowsMessage<std::runtime_error>(
                  testing::HasSubstr("the scene server fails whatever it is asked for: at cans 1, "
                                     "cans 2, cans 3, and")));
  is_over = true;
}

}  // namespace
}  // namespace planbench
