#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/asked_runs.h"
#include "results/reproduce.h"
#include "results/session_plan.h"
#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

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
    line_up.front().contestant.name = first_name_;
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
  std::string first_about_, first_name_;
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
  earlier_.sessions.front().conditions.contestants.front().name = "Taken*";
  first_name_ = "Taken*";
  ExpectInputError([&] { Resume({"arm"}, 1)->Discover(false, Idle); },
                   {"--resume", "'arm'", "'another'", "'Taken*'"});
}

TEST_F(OtherFlagsTest, NamesThatTellOneAlgorithmsPlannersApartStayWhoeverIsAskedFor) {
  leg_.status.algorithm = arm_.status.algorithm;
  Reannounce(&leg_);
  const auto expect_names = [this](const std::string& of_arm, const std::string& of_leg) {
    std::map<std::string, std::string> names;
    for (const Contestant& one : told_.conditions.contestants) names[one.planner] = one.name;
    EXPECT_EQ(names, (std::map<std::string, std::string>{{"arm", of_arm}, {"leg", of_leg}}));
    std::map<std::string, std::string> recorded;
    for (const RunRecordMessage& record : earlier_.runs) {
      EXPECT_EQ(names[record.planner], record.contestant);
    }
  };
  Make({"arm", "leg"}, 1, 0);
  expect_names("Fake* [arm]", "Fake* [leg]");
  Kill();
  Make({"arm"}, 1, 4);
  Make({"leg", "arm"}, 1, 0);
  expect_names("Fake* [arm]", "Fake* [leg]");

  // As if the leg had been alone at first.
  Kill();
  SessionMessage& begun = earlier_.sessions.front();
  std::erase_if(begun.conditions.contestants, [](const auto& c) { return c.planner == "arm"; });
  begun.conditions.contestants.front().name = "Fake*";
  begun.settings.erase(kPlanSetting);
  earlier_.runs.clear();
  begun.num_runs = 0;
  Make({"arm", "leg"}, 1, 0);
  expect_names("Fake* [arm]", "Fake*");
}

}  // namespace
}  // namespace planbench
