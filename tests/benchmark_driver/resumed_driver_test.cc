#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

/// Of problems 1 and 2, of which the second goes bad before its first run.
HeldSession SessionWithoutProblem2(Bus* bus, const DriverOptions& options, FakeSceneServer* server,
                                   FakeLogger* logger) {
  Driver driver(bus, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  server->RefuseProblem(2, "scene0002.yaml: is missing");
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.num_runs(), 2);
  EXPECT_EQ(driver.num_not_asked(), 1);
  return {logger->sessions().messages(), logger->records().messages()};
}

TEST_F(DriverTest, ResumedSessionMakesOnlyWhatIsLeft) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  HeldSession earlier;
  {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    MakeAll(&driver);
    earlier = {logger.sessions().messages(), logger.records().messages()};
  }
  const std::set<std::string> recorded_before = Ids(logger.records());
  options.problem_indices = {1};  // no longer 2
  options.directions = Directions::kBoth;
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&driver);
  std::set<std::string> recorded = Ids(logger.records());
  for (const std::string& id : recorded_before) recorded.erase(id);
  EXPECT_EQ(recorded, std::set<std::string>{"run/cans/1/arm/backward/1"});
  EXPECT_EQ(driver.runs().size(), 3u);
  EXPECT_EQ(logger.sessions().messages().back().num_runs, 3);
  EXPECT_EQ(logger.sessions().messages().back().start_utime, earlier.sessions[0].start_utime);
  EXPECT_GT(logger.sessions().messages().back().total_time_s, earlier.sessions.back().total_time_s);

  options.conditions.request.time_limit_s = 7;
  Driver other(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  ExpectInputError([&] { other.Discover(true, Idle); }, {"--resume", "time_limit_s", "60", "7"});
  planner.status.settings["step"] = "6";
  Reannounce(&planner);
  Driver another(&bus_, Options(), LineUp({"arm"}), {}, earlier.Earlier());
  ExpectInputError([&] { another.Discover(true, Idle); },
                   {"--resume", "node[arm].setting[step]", "\"5\"", "\"6\""});
}

TEST_F(DriverTest, WhatAPlannerThatWasGivenUpWasNotAskedIsMadeByTheResumedSession) {
  std::atomic<bool> dead = false;
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kAuto;
  options.problem_indices = {1, 2, 3};
  HeldSession earlier;
  std::map<std::string, RunRecordMessage> before;
  {
    // It dies of problem 2.
    planner.OnRequest([&](const PlanRequest& request) {
      if (request.request_id.find("/cans/2/") == std::string::npos) return planner.Solve(request);
      planner.FallSilent();
      dead = true;
    });
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    driver.Discover(true, Idle);
    EXPECT_TRUE(driver.Run(Never, [&] {
      if (dead) driver.GiveUp("arm", "it died");
    }));
    // Whether problem 3 needs the backward search is not known.
    EXPECT_EQ(driver.num_runs(), 4);
    EXPECT_EQ(driver.num_not_asked(), 2);
    for (const RunRecordMessage& record : logger.records().messages()) {
      if (before.emplace(record.request_id, record).second) earlier.runs.push_back(record);
    }
    earlier.sessions = logger.sessions().messages();
  }
  ASSERT_EQ(before.size(), 4u);
  EXPECT_GT(before.at("run/cans/2/arm/forward/1").roundtrip_time_s, 0);
  EXPECT_EQ(before.at("run/cans/2/arm/backward/1").message, "given up: it died");
  EXPECT_EQ(before.at("run/cans/3/arm/forward/1").message, "given up: it died");

  planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
  Reannounce(&planner);
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&driver);
  std::set<std::string> made;
  for (const RunRecordMessage& record : logger.records().messages()) {
    if (before.at(record.request_id) == record) continue;
    made.insert(record.request_id);
    EXPECT_EQ(record.status, PlanStatus::kSolved);
  }
  EXPECT_EQ(made, (std::set<std::string>{"run/cans/2/arm/backward/1", "run/cans/3/arm/forward/1"}));
  EXPECT_EQ(driver.runs().size(), 4u);
  EXPECT_EQ(driver.num_runs(), 4);
  EXPECT_EQ(driver.num_not_asked(), 0);
}

TEST_F(DriverTest, AProblemThatWentBadMidwayDoesNotEndTheResumedSession) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  const HeldSession earlier = SessionWithoutProblem2(&bus_, options, &server, &logger);
  options.problem_indices = {1, 2, 3};
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&driver);
  EXPECT_EQ(driver.runs().size(), 3u);
  EXPECT_EQ(driver.num_not_asked(), 1);
  std::set<std::string> made;
  for (const RunRecordMessage& record : logger.records().messages()) {
    if (std::find(earlier.runs.begin(), earlier.runs.end(), record) != earlier.runs.end()) continue;
    made.insert(record.request_id);
    if (record.problem_index != 2) continue;
    EXPECT_EQ(record.status, PlanStatus::kInvalidRequest);
    EXPECT_EQ(record.message, "no problem: scene0002.yaml: is missing");
  }
  EXPECT_EQ(made, (std::set<std::string>{"run/cans/2/arm/forward/1", "run/cans/3/arm/forward/1"}));

  // One that the session did not have yet is another matter.
  server.RefuseProblem(3, "request0003.yaml: is missing");
  Driver with_another(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  ExpectInputError([&] { with_another.Discover(true, Idle); }, {"1 of 2 problems are bad"});
  options.skip_bad_problems = true;
  Driver without(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&without);
  ASSERT_EQ(without.left_out().size(), 1u);
  EXPECT_EQ(without.left_out().begin()->first, "cans 3");
  // As in the log, problem 2 is among the runs.
  EXPECT_EQ(without.runs().size(), 2u);
  EXPECT_EQ(without.num_runs(), 2);
  EXPECT_EQ(without.num_not_asked(), 1);

  options.problem_indices = {1};
  Driver of_others(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&of_others);
  EXPECT_EQ(of_others.runs().size(), 2u) << "tables tell why it is missing";
  EXPECT_EQ(of_others.num_runs(), 2);
  EXPECT_EQ(of_others.num_not_asked(), 0) << "the same flags would not make it";
  EXPECT_EQ(of_others.num_owed(), 1);
  EXPECT_FALSE(logger.sessions().messages().back().finished);
}

TEST_F(DriverTest, ASessionThatMadeNothingIsRefusedProblemsThatAreAllBad) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  HeldSession earlier = SessionWithoutProblem2(&bus_, options, &server, &logger);
  std::erase_if(earlier.runs, [](const auto& record) { return record.problem_index != 2; });
  server.RefuseProblem(3, "request0003.yaml: is missing");
  options.problem_indices = {3};
  options.skip_bad_problems = true;
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  ExpectInputError([&] { driver.Discover(true, Idle); }, {"all 1 problems are bad"});
}

TEST_F(DriverTest, AProblemAtWhichTheSceneServerFailsIsNotAskedForInAResumedSession) {
  std::atomic<int> num_failures = 0;
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  const HeldSession earlier = SessionWithoutProblem2(&bus_, options, &server, &logger);
  server.ServeProblem(2);
  server.BeforeAnswers([&](const ProblemRequestMessage& request) {
    if (request.problem_index != 2) return;
    num_failures += 2;
    server.problem_requests().WaitForOne(
        [](const ProblemRequestMessage& next) { return next.problem_index == 3; });
  });
  options.problem_indices = {1, 2, 3};
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  driver.Discover(true, Idle, CountedBy(num_failures));
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.num_not_asked(), 1);
  ASSERT_EQ(driver.runs().size(), 3u);
  for (const RunRow& run : driver.runs().rows()) {
    EXPECT_EQ(run.asked, run.problem_index != 2);
    if (!run.asked) {
      EXPECT_EQ(*run.message,
                "no problem: twice the scene server died or fell silent when it was asked for the "
                "problem cans 2");
    }
  }
}

TEST_F(DriverTest, AnAttemptWhoseProblemCouldNotBeHadLeavesTheOtherToTheResumedSession) {
  FakePlanner planner(&bus_);
  SolveSecondBackwardOnly(&planner);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kAuto;
  const HeldSession earlier = SessionWithoutProblem2(&bus_, options, &server, &logger);
  EXPECT_FALSE(Ids(logger.records()).contains("run/cans/2/arm/backward/1"));

  server.ServeProblem(2);
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&driver);
  EXPECT_EQ(driver.num_runs(), 3);
  EXPECT_EQ(driver.num_not_asked(), 0);
  EXPECT_EQ(Ids(logger.records()),
            (std::set<std::string>{"run/cans/1/arm/forward/1", "run/cans/2/arm/forward/1",
                                   "run/cans/2/arm/backward/1"}));
}

TEST_F(DriverTest, NoProblemIsAskedForOfWhichNothingIsLeftToDo) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kAuto;
  Driver first(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&first);
  const HeldSession earlier = {logger.sessions().messages(), logger.records().messages()};
  const std::set<std::string> requests = Ids(server.problem_requests());
  Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
  MakeAll(&driver);
  EXPECT_EQ(Ids(server.problem_requests()), requests);
  EXPECT_EQ(driver.num_runs(), 2);
  EXPECT_TRUE(logger.sessions().messages().back().finished);
}

TEST_F(DriverTest, AProblemThatIsAnotherThanInTheSessionsRunsEndsIt) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  Driver first(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&first);
  const HeldSession earlier = {logger.sessions().messages(), logger.records().messages()};
  options.trials = 2;
  const auto resume_with = [&](void (*alter)(ProblemMessage*)) {
    server.AlterProblems([alter](ProblemMessage* problem) {
      if (problem->problem_index == 2) alter(problem);
    });
    return std::make_unique<Driver>(&bus_, options, LineUp({"arm"}),
                                    std::map<std::string, std::string>(), earlier.Earlier());
  };
  const std::map<std::string, void (*)(ProblemMessage*)> alterations = {
      {"scene", [](ProblemMessage* problem) { problem->scene_id = "another"; }},
      {"group", [](ProblemMessage* problem) { problem->group = "another"; }},
      {"start", [](ProblemMessage* problem) { problem->start.positions[0] = 0.1; }},
      {"goal", [](ProblemMessage* problem) { problem->goal[1].tolerance_above = 0.1; }}};
  for (const auto& [part, alter] : alterations) {
    const auto driver = resume_with(alter);
    ExpectInputError([&] { driver->Discover(true, Idle); },
                     {"--resume", "the " + part + " of cans 2 is another"});
  }
  EXPECT_NO_THROW(resume_with([](ProblemMessage* problem) {
                    problem->time_limit_s = 1;
                  })->Discover(true, Idle));
}

}  // namespace
}  // namespace planbench
