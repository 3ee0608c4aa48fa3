#include "benchmark_driver/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

ProblemSetsMessage Served() {
  ProblemSetsMessage served;
  served.sets = {{"box", {1, 2, 3}, "box-1"}, {"cage", {2, 5}, "cage-1"}};
  return served;
}

/// One problem of one set.
DriverOptions OneProblem() {
  DriverOptions options;
  options.sets = {"cage"};
  options.problem_indices = {2};
  options.conditions.request.run_id = "run";
  return options;
}

/// Makes all trials, unless it is told otherwise.
PlannedPlanner Of(const std::string& planner, Directions directions = Directions::kForward,
                  int trials = 0) {
  return {planner, directions, trials};
}

std::vector<ScheduledRun> Schedule(const DriverOptions& options,
                                   std::vector<PlannedPlanner> planners,
                                   const ProblemSetsMessage& served = Served()) {
  for (PlannedPlanner& planner : planners) {
    if (planner.trials == 0) planner.trials = options.trials;
  }
  return MakeSchedule(PlanCall(options, planners, served), options.conditions.request);
}

std::vector<std::string> Ids(const std::vector<ScheduledRun>& schedule) {
  std::vector<std::string> ids;
  for (const ScheduledRun& run : schedule) ids.push_back(run.request_id);
  return ids;
}

TEST(ScheduleTest, EveryContestantMeetsEveryProblemInEveryTrial) {
  DriverOptions options;
  options.conditions.request.run_id = "run";
  options.trials = 2;
  const auto schedule = Schedule(options, {Of("ara"), Of("rrtc", Directions::kBoth)});
  const std::vector<std::string> ids = Ids(schedule);
  EXPECT_EQ(ids.size(), 5u * 2 * 3);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  // Problem by problem, trial by trial.
  EXPECT_TRUE(std::is_sorted(schedule.begin(), schedule.end(), [](const auto& a, const auto& b) {
    return std::tie(a.problem_set, a.problem_index, a.trial) <
           std::tie(b.problem_set, b.problem_index, b.trial);
  }));
}

TEST(PlanPlannerTest, IsWhatThePlannersSayOfThemselves) {
  using enum Directions;
  std::map<std::string, NodeStatusMessage> planners;
  for (const char* name : {"ara", "rrtc", "chomp"}) {
    planners[name].name = name;
    planners[name].can_backward = true;
  }
  planners["ara"].deterministic = planners["chomp"].deterministic = true;
  planners["rrtc"].bidirectional = true;
  const auto plan = [&](const char* name, Directions directions, const char* first_path_of = "") {
    Contestant contestant;
    contestant.planner = name;
    contestant.first_path_of = first_path_of;
    return PlanPlanner(contestant, directions, 5, planners);
  };
  EXPECT_EQ(plan("ara", kAuto), Of("ara", kAuto, 1));
  EXPECT_EQ(plan("rrtc", kAuto), Of("rrtc", kForward, 5));
  EXPECT_EQ(plan("rrtc", kBackward), Of("rrtc", kBackward, 5));
  EXPECT_EQ(plan("chomp", kAuto, "rrtc"), Of("chomp", kForward, 5));
  planners["chomp"].can_backward = false;
  EXPECT_EQ(plan("chomp", kAuto), Of("chomp", kForward, 1));
}

TEST(ScheduleTest, DirectionsAreThoseOfTheContestant) {
  using enum Directions;
  const auto ids = [](const PlannedPlanner& planner) {
    std::vector<std::string> made;
    for (const ScheduledRun& run : Schedule(OneProblem(), {planner})) {
      made.push_back(std::string(EnumName(run.direction)) +
                     (run.unless_solved ? " if failed" : "") + (run.is_one_of_two ? " too" : ""));
    }
    return made;
  };
  EXPECT_THAT(ids(Of("a", kForward)), ElementsAre("forward"));
  EXPECT_THAT(ids(Of("a", kBackward)), ElementsAre("backward"));
  EXPECT_THAT(ids(Of("a", kBoth)), ElementsAre("forward too", "backward too"));
  EXPECT_THAT(ids(Of("a", kAuto)), ElementsAre("forward", "backward if failed"));
}

TEST(ScheduleTest, TheSecondAttemptKnowsTheFirst) {
  const auto schedule = Schedule(OneProblem(), {Of("a", Directions::kAuto)});
  ASSERT_EQ(schedule.size(), 2u);
  EXPECT_EQ(schedule[0].unless_solved, std::nullopt);
  EXPECT_EQ(schedule[1].unless_solved, schedule[0].request_id);
}

TEST(ScheduleTest, DeterministicContestantsMakeOneTrial) {
  DriverOptions options = OneProblem();
  options.trials = 3;
  const PlannedPlanner deterministic = Of("a", Directions::kForward, 1);
  EXPECT_THAT(Ids(Schedule(options, {deterministic, Of("b")})),
              UnorderedElementsAre("run/cage/2/a/forward/1", "run/cage/2/b/forward/1",
                                   "run/cage/2/b/forward/2", "run/cage/2/b/forward/3"));
}

TEST(ScheduleTest, SeedsAreOfTheRunAndTheSameForAllContestants) {
  DriverOptions options;
  options.trials = 4;
  options.conditions.request.seed = 10;
  const auto schedule = Schedule(options, {Of("a", Directions::kBoth), Of("b", Directions::kBoth)});
  std::map<std::uint64_t, int> uses;
  for (const ScheduledRun& run : schedule) {
    EXPECT_EQ(run.seed, RunSeed(10, run.problem_set, run.problem_index, run.direction, run.trial));
    EXPECT_LT(run.seed, 1ull << 63);
    ++uses[run.seed];
  }
  EXPECT_EQ(uses.size(), 5u * 4 * 2);
  for (const auto& [seed, count] : uses) EXPECT_EQ(count, 2);  // both contestants
  EXPECT_NE(RunSeed(10, "box", 1, Direction::kForward, 1),
            RunSeed(11, "box", 1, Direction::kForward, 1));
}

TEST(ScheduleTest, SeedsDoNotChangeFromVersionToVersion) {
  EXPECT_EQ(RunSeed(1, "box", 1, Direction::kForward, 1), 2910869325277425041u);
}

TEST(ScheduleTest, EveryContestantComesFirstAboutEquallyOften) {
  DriverOptions options = OneProblem();
  options.trials = 3000;
  const auto schedule = Schedule(options, {Of("a"), Of("b"), Of("c")});
  std::map<std::string, int> first;
  for (std::size_t i = 0; i < schedule.size(); i += 3) ++first[schedule[i].planner];
  // 1000 +- 26 each; six standard deviations.
  for (const auto& [planner, count] : first) EXPECT_NEAR(count, 1000, 156) << planner;
  options.conditions.request.seed = 2;
  EXPECT_NE(Ids(Schedule(options, {Of("a"), Of("b"), Of("c")})), Ids(schedule));
}

TEST(ScheduleTest, SetsComeInTheOrderAsked) {
  DriverOptions options;
  options.sets = {"cage", "box"};
  EXPECT_EQ(Schedule(options, {Of("a")}).front().problem_set, "cage");
}

TEST(ScheduleTest, RangeSelectsWhatASetHas) {
  DriverOptions options;
  options.conditions.request.run_id = "run";
  options.problem_indices = {2, 3, 4, 5};
  EXPECT_THAT(Ids(Schedule(options, {Of("ara")})),
              ElementsAre("run/box/2/ara/forward/1", "run/box/3/ara/forward/1",
                          "run/cage/2/ara/forward/1", "run/cage/5/ara/forward/1"));
}

TEST(ScheduleTest, ShardsAreDisjointAndTogetherTheWhole) {
  DriverOptions options;
  options.conditions.request.run_id = "run";
  options.trials = 3;
  const PlannedPlanner seedless = Of("ara", Directions::kForward, 1);
  const std::vector<PlannedPlanner> planners = {seedless, Of("rrtc")};
  const std::vector<std::string> whole = Ids(Schedule(options, planners));
  for (const int count : {1, 2, 4, 7}) {
    std::vector<std::string> united;
    std::size_t largest = 0;
    std::size_t smallest = whole.size();
    for (int index = 1; index <= count; ++index) {
      options.shard = {index, count};
      const std::vector<std::string> part = Ids(Schedule(options, planners));
      EXPECT_EQ(part, Ids(Schedule(options, planners))) << "deterministic";
      largest = std::max(largest, part.size());
      smallest = std::min(smallest, part.size());
      united.insert(united.end(), part.begin(), part.end());
    }
    EXPECT_THAT(united, testing::UnorderedElementsAreArray(whole)) << count;
    EXPECT_LE(largest, smallest + 2 * whole.size() / static_cast<std::size_t>(count));
  }
  options.shard = {99, 100};
  ExpectInputError([&] { Schedule(options, planners); }, {"--shard 99/100", "no more than"});
}

TEST(ScheduleTest, AShardIsThatOfTheSameProblemsWhoeverIsAsked) {
  DriverOptions options;
  options.conditions.request.run_id = "run";
  options.trials = 5;
  const PlannedPlanner seedless = Of("ara", Directions::kForward, 1);
  for (int index = 1; index <= 5; ++index) {
    options.shard = {index, 5};
    std::vector<std::string> of_both = Ids(Schedule(options, {seedless, Of("rrtc")}));
    std::erase_if(of_both, [](const auto& id) { return id.find("/ara/") == std::string::npos; });
    EXPECT_EQ(Ids(Schedule(options, {seedless})), of_both);
    EXPECT_EQ(of_both.size(), 1u) << "of five problems in five shards";
  }
  options.shard = {6, 6};
  ExpectInputError([&] { Schedule(options, {seedless}); }, {"--shard 6/6", "no more than 5 parts"});
}

TEST(ScheduleTest, SetsThatHaveLessThanTheRangeAreNamed) {
  DriverOptions options;
  EXPECT_THAT(ShortOfRange(options, PlanCall(options, {Of("a")}, Served())), testing::IsEmpty());
  options.problem_indices = {2, 3};
  EXPECT_THAT(ShortOfRange(options, PlanCall(options, {Of("a")}, Served())),
              ElementsAre("--problems-range: of the 2 problems of that range 'cage' has 1"));
}

TEST(ScheduleTest, WhatIsNotServedIsNamed) {
  DriverOptions options;
  options.sets = {"kitchen"};
  ExpectInputError([&] { Schedule(options, {Of("a")}); }, {"--sets", "'kitchen'", "box, cage"});
  options.sets = {"cage"};
  options.problem_indices = {3, 4};
  ExpectInputError([&] { Schedule(options, {Of("a")}); },
                   {"--problems-range", "'cage'", "2 from 2 to 5"});
  ProblemSetsMessage served;
  served.sets = {{"void", {}, "void-1"}};
  ExpectInputError([&] { Schedule(DriverOptions{}, {Of("a")}, served); }, {"'void'", "empty"});
}

}  // namespace
}  // namespace planbench
