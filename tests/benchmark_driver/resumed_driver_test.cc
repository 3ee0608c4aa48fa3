#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "messaging/asked_runs.h"
#include "results/reproduce.h"
#include "results/session_plan.h"
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

/// Flags as they are recorded, of Options() with trials.
std::map<std::string, std::string> FlagsFor(const std::string& planners, int trials) {
  return {{"sets", ""},  {"problems-range", "1-2"}, {"directions", "auto"},
          {"shard", ""}, {"planners", planners},    {"trials", std::to_string(trials)}};
}

/// A session of two contestants, made and resumed with one or both. Of two problems the arm needs
/// three runs and the leg two.
class OtherFlagsTest : public DriverTest {
 protected:
  OtherFlagsTest() {
    leg_.status.algorithm = "Leg*";
    Reannounce(&leg_);
    SolveSecondBackwardOnly(&arm_);
  }

  std::unique_ptr<Driver> Resume(const std::vector<std::string>& planners, int trials) {
    DriverOptions options = Options();
    options.directions = Directions::kAuto;
    options.trials = trials;
    options.problem_indices = problems_;
    options.skip_bad_problems = skips_bad_problems_;
    auto flags = FlagsFor(fmt::format("{}", fmt::join(planners, ",")), trials);
    if (shard_.count > 1) {
      options.shard = shard_;
      flags["shard"] = fmt::format("{}/{}", shard_.index, shard_.count);
    }
    if (problems_.size() == 1) flags["problems-range"] = std::to_string(problems_.front());
    std::vector<LineUpEntry> line_up = LineUp(planners);
    line_up.front().directions = first_directions_;
    line_up.front().contestant.about = first_about_;
    return std::make_unique<Driver>(&bus_, options, line_up, flags, earlier_.Earlier());
  }

  /// A call for both.
  static PlannedCall Call(const std::vector<PlannedSet>& sets, int trials, Shard shard = {}) {
    return {sets, {{"arm", Directions::kAuto, trials}, {"leg", Directions::kAuto, trials}}, shard};
  }

  /// Makes what `planners` lack of the session, and keeps what is told and recorded of it.
  void Make(const std::vector<std::string>& planners, int trials, int num_owed) {
    FakeLogger logger(&bus_);
    const auto driver = Resume(planners, trials);
    MakeAll(driver.get());
    EXPECT_EQ(driver->num_owed(), num_owed);
    told_.run_id = "all that was told has been heard";
    bus_.Publish(channel::kSession, told_);
    ASSERT_TRUE(logger.sessions().WaitForOne(
        [&](const SessionMessage& session) { return session.run_id == told_.run_id; }));
    for (const SessionMessage& session : logger.sessions().messages()) {
      if (session.run_id == "run") earlier_.sessions.push_back(session);
    }
    for (const RunRecordMessage& record : logger.records().messages()) {
      const auto known =
          std::find_if(earlier_.runs.begin(), earlier_.runs.end(),
                       [&](const auto& one) { return one.request_id == record.request_id; });
      if (known == earlier_.runs.end()) {
        earlier_.runs.push_back(record);
      } else if (Replaces(StandingOf(record), StandingOf(*known))) {
        *known = record;
      }
    }
    told_ = earlier_.sessions.back();
    EXPECT_EQ(told_.finished, num_owed == 0 && driver->awaited_shards().empty());
    const auto num_made = std::count_if(earlier_.runs.begin(), earlier_.runs.end(), WasAsked);
    EXPECT_EQ(told_.num_runs, static_cast<int>(num_made) + num_owed);
    EXPECT_EQ(driver->runs().size(), earlier_.runs.size());
    EXPECT_EQ(told_.conditions.contestants.size(), 2u);
    EXPECT_EQ(std::count_if(told_.nodes.begin(), told_.nodes.end(),
                            [](const auto& node) { return node.kind == NodeKind::kPlanner; }),
              2);
    command_ = ReproducingCommand(told_.settings);
  }

  /// As if the driver had been killed when the arm had made its first run.
  void Kill() {
    earlier_.sessions.resize(1);
    std::erase_if(earlier_.runs, [](const auto& record) {
      return record.request_id != "run/cans/1/arm/forward/1";
    });
    ASSERT_EQ(earlier_.runs.size(), 1u);
  }

  static std::string Command(const std::string& planners, int trials) {
    return fmt::format(
        "benchmark_driver --directions auto --planners {} --problems-range 1-2 --trials {}",
        planners, trials);
  }

  FakePlanner arm_{&bus_, "arm"};
  FakePlanner leg_{&bus_, "leg"};
  FakeSceneServer server_{&bus_};
  HeldSession earlier_;
  // Of the next call:
  std::vector<int> problems_ = {1, 2};
  bool skips_bad_problems_ = false;
  Shard shard_;
  std::optional<Directions> first_directions_;  ///< Of its first contestant.
  std::string first_about_;
  SessionMessage told_;  // last
  std::string command_;
};

TEST_F(OtherFlagsTest, ASessionIsFinishedWhenAllIsMadeThatWasEverPlanned) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  Make({"arm"}, 1, 4);  // the leg's, backward ones included, which may not be needed
  EXPECT_EQ(earlier_.runs.size(), 3u);
  EXPECT_EQ(command_, Command("arm,leg", 1));
  Make({"leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 5u);
  EXPECT_EQ(command_, Command("arm,leg", 1));
}

TEST_F(OtherFlagsTest, AFinishedOneResumedWithFewerContestantsIsWhatItWas) {
  Make({"arm", "leg"}, 1, 0);
  Make({"arm"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 5u);
  EXPECT_EQ(command_, Command("arm,leg", 1));
}

TEST_F(OtherFlagsTest, ARunThatWasNotAskedForIsOwedUntilItsPlannerTakesPart) {
  Make({"arm", "leg"}, 1, 0);
  // As if the leg had been given up before problem 2.
  for (RunRecordMessage& record : earlier_.runs) {
    if (record.request_id != "run/cans/2/leg/forward/1") continue;
    record.status = PlanStatus::kNoAnswer;
    record.roundtrip_time_s = 0;
    record.result = {};
    record.message = "given up: it died";
  }
  ASSERT_EQ(std::count_if(earlier_.runs.begin(), earlier_.runs.end(), WasAsked), 4);
  for (const bool plan_is_known : {true, false}) {
    if (!plan_is_known) {
      for (SessionMessage& session : earlier_.sessions) session.settings.erase(kPlanSetting);
    }
    Make({"arm"}, 1, 1);  // the backward one may not be needed
    EXPECT_FALSE(told_.finished);
  }
  Make({"leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 5u);
  EXPECT_TRUE(told_.finished);
}

TEST_F(OtherFlagsTest, AProblemThatIsMendedIsOwedByThoseThatDoNotTakePart) {
  server_.RefuseProblem(2, "scene0002.yaml: is missing");
  skips_bad_problems_ = true;
  Make({"arm", "leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 2u);
  // Fewer problems are not all that was planned, though all that was made.
  problems_ = {1};
  Make({"arm", "leg"}, 1, 0);
  EXPECT_EQ(command_, Command("arm,leg", 1));
  problems_ = {1, 2};
  server_.ServeProblem(2);
  Make({"arm"}, 1, 2);  // the backward one may not be needed
  EXPECT_TRUE(told_.left_out.empty());
  EXPECT_EQ(earlier_.runs.size(), 4u);
  EXPECT_EQ(command_, Command("arm,leg", 1));
  Make({"leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 5u);
}

TEST_F(OtherFlagsTest, AProblemThatIsLeftOutIsOwedByNobody) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  server_.RefuseProblem(2, "scene0002.yaml: is missing");
  skips_bad_problems_ = true;
  Make({"arm"}, 1, 2);  // the leg's, on problem 1
  EXPECT_EQ(told_.left_out.size(), 1u);
  server_.ServeProblem(2);
  Make({"arm", "leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 5u);
}

TEST_F(OtherFlagsTest, OneThatWasMadeInSeveralWaysTellsOfAll) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  Make({"arm"}, 2, 4);
  EXPECT_EQ(earlier_.runs.size(), 6u);
  EXPECT_EQ(command_, Command("arm,leg", 1) + " && " + Command("arm", 2));
  Make({"leg"}, 1, 0);
  EXPECT_EQ(earlier_.runs.size(), 8u);
  // Until one call would make all of it.
  Make({"arm", "leg"}, 2, 0);
  EXPECT_EQ(earlier_.runs.size(), 10u);
  EXPECT_EQ(command_, Command("arm,leg", 2));
}

TEST_F(OtherFlagsTest, OfAPlanThatIsNotKnownTheNumberCounts) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  earlier_.sessions.front().settings.erase(kPlanSetting);
  for (int time = 1; time <= 2; ++time) {
    Make({"arm"}, 1, 5);  // the leg's, and one that had become needless
    EXPECT_FALSE(told_.settings.contains(kPlanSetting)) << "that of one call is not all";
  }
  Make({"leg"}, 1, 1);
  EXPECT_EQ(earlier_.runs.size(), 5u);
  Make({"arm", "leg"}, 1, 0);  // a call that may be for all
  EXPECT_EQ(earlier_.runs.size(), 5u);
}

TEST_F(OtherFlagsTest, WhatIsNotServedAnyMoreIsStillOwed) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  SessionMessage& session = earlier_.sessions.front();
  session.conditions.problem_sets["other"] = "other-1";
  const SessionPlan plan = {Call({{"cans", {1, 2}}, {"other", {1, 2}}}, 1)};
  session.settings[kPlanSetting] = PlanText(plan);
  for (int time = 1; time <= 2; ++time) {
    Make({"arm", "leg"}, 1, 8);
    EXPECT_EQ(earlier_.runs.size(), 5u);
    EXPECT_EQ(command_, Command("arm,leg", 1));
    EXPECT_TRUE(told_.conditions.problem_sets.contains("other"));
    EXPECT_EQ(ReadPlan(told_.settings)->front(), plan.front());
  }
}

TEST_F(OtherFlagsTest, ThePlanIsThatOfAllCallsEachOnce) {
  const PlannedCall both = Call({{"cans", {1, 2}}}, 1);
  PlannedCall legs = both;
  legs.planners.erase(legs.planners.begin());
  Make({"arm", "leg"}, 1, 0);
  EXPECT_EQ(ReadPlan(told_.settings), SessionPlan{both});
  Kill();
  for (int time = 1; time <= 2; ++time) {
    Make({"leg"}, 1, 2);  // the arm's, on problem 2
    EXPECT_EQ(ReadPlan(told_.settings), (SessionPlan{both, legs}));
  }
}

TEST_F(OtherFlagsTest, DirectionsOfAContestantMayNotChangeButWhatIsSaidOfItMay) {
  Make({"arm", "leg"}, 1, 0);
  first_directions_ = Directions::kForward;
  ExpectInputError(
      [&] {
        Resume({"arm", "leg"}, 1)->Discover(false, Idle);
      },
      {"--resume", "'arm'", "auto", "forward"});
  first_directions_ = Directions::kAuto;
  first_about_ = "worded otherwise";
  Make({"arm", "leg"}, 1, 0);
}

TEST_F(OtherFlagsTest, APlanThatCannotBeReadIsNamed) {
  Make({"arm", "leg"}, 1, 0);
  earlier_.sessions.back().settings[kPlanSetting] = "[5]";
  ExpectInputError([&] { Resume({"arm"}, 1)->Discover(false, Idle); },
                   {"--resume", "the setting plan"});
}

TEST_F(OtherFlagsTest, WhatTheSessionCannotHaveBeenToMakeDoesNotCountForIt) {
  Make({"arm", "leg"}, 1, 0);
  Kill();
  earlier_.runs.clear();
  SessionMessage& session = earlier_.sessions.front();  // the leg's
  std::erase_if(session.conditions.contestants, [](const auto& c) { return c.planner == "arm"; });
  session.num_runs = 4;
  session.settings.erase(kPlanSetting);
  Make({"arm"}, 1, 4);
}

TEST_F(OtherFlagsTest, AMergedSessionIsGivenShardsUntilItHasAll) {
  // As if it had been merged of shards 1/4 and 2/4, the first trials of both problems.
  Make({"arm", "leg"}, 2, 0);
  const auto is_second_trial = [](const auto& record) { return record.trial == 2; };
  std::erase_if(earlier_.runs, is_second_trial);
  const std::vector<PlannedSet> sets = {{"cans", {1, 2}}};
  told_.settings[kPlanSetting] = PlanText({Call(sets, 2, {1, 4}), Call(sets, 2, {2, 4})});
  told_.settings[kMergedCommands] = "one && two";
  told_.settings[kMergedParts] = R"({"part": {"total_time_s": 1, "bus": ""}})";
  told_.finished = false;
  told_.num_runs = 5;
  earlier_.sessions = {told_};

  shard_ = {3, 4};
  const std::string call =
      "benchmark_driver --directions auto --planners arm,leg "
      "--problems-range 1-2 --shard 3/4 --trials 2";
  for (int time = 1; time <= 2; ++time) {
    Make({"arm", "leg"}, 2, 0);
    EXPECT_EQ(earlier_.runs.size(), 7u);
    EXPECT_FALSE(told_.finished);
    EXPECT_EQ(ReadPlan(told_.settings)->size(), 3u);
    EXPECT_EQ(command_, "one && two && " + call);
    EXPECT_FALSE(told_.settings.contains(kMergedParts));
    EXPECT_THAT(told_.settings[kHeldParts], testing::HasSubstr("part"));
    std::erase_if(earlier_.runs, is_second_trial);  // as if it had been interrupted
  }
  // Nothing is known of what was to be made, but that it has shards.
  std::vector<SessionMessage> known = earlier_.sessions;
  for (SessionMessage& session : earlier_.sessions) session.settings.erase(kPlanSetting);
  Make({"arm", "leg"}, 2, 0);
  EXPECT_FALSE(told_.finished);

  earlier_.sessions = std::move(known);
  shard_ = {4, 4};
  Make({"arm", "leg"}, 2, 0);
  EXPECT_EQ(earlier_.runs.size(), 10u);
  EXPECT_TRUE(told_.finished);
}

TEST_F(OtherFlagsTest, NoContestantTakesTheNameOfAnother) {
  Make({"arm", "leg"}, 1, 0);
  for (SessionMessage& session : earlier_.sessions) {
    std::erase_if(session.conditions.contestants, [](const auto& c) { return c.planner == "arm"; });
  }
  earlier_.sessions.front().conditions.contestants.front().planner = "another";
  earlier_.sessions.front().conditions.contestants.front().name = arm_.status.algorithm;
  ExpectInputError([&] { Resume({"arm"}, 1)->Discover(false, Idle); },
                   {"--resume", "'arm'", "'another'", "'Fake*'"});
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
