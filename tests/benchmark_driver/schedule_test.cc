#include "benchmark_driver/schedule.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

ProblemSetsMessage Served() {
  ProblemSetsMessage served;
  served.sets = {{"box", {1, 2, 3}, "box-1"}, {"cage", {2, 5}, "cage-1"}};
  return served;
}

DriverOptions Options() {
  DriverOptions options;
  options.planners = {"ara", "rrtc"};
  options.conditions.request.run_id = "run";
  return options;
}

std::vector<std::string> Ids(const std::vector<ScheduledRun>& schedule) {
  std::vector<std::string> ids;
  for (const ScheduledRun& run : schedule) ids.push_back(run.request_id);
  return ids;
}

TEST(ScheduleTest, GoesProblemByProblemThenPlannerTrialDirection) {
  DriverOptions options = Options();
  options.sets = {"cage"};
  options.problem_indices = {2};
  options.trials = 2;
  EXPECT_EQ(Ids(MakeSchedule(options, Served())),
            (std::vector<std::string>{"run/cage/2/ara/forward/1", "run/cage/2/ara/backward/1",
                                      "run/cage/2/ara/forward/2", "run/cage/2/ara/backward/2",
                                      "run/cage/2/rrtc/forward/1", "run/cage/2/rrtc/backward/1",
                                      "run/cage/2/rrtc/forward/2", "run/cage/2/rrtc/backward/2"}));
}

TEST(ScheduleTest, RunsCarryWhatTheirIdSays) {
  DriverOptions options = Options();
  options.sets = {"cage"};
  options.problem_indices = {5};
  options.planners = {"rrtc"};
  options.directions = {Direction::kBackward};
  options.trials = 3;
  options.conditions.request.seed = 10;
  const std::vector<ScheduledRun> schedule = MakeSchedule(options, Served());
  ASSERT_EQ(schedule.size(), 3u);
  EXPECT_EQ(schedule[2].planner, "rrtc");
  EXPECT_EQ(schedule[2].problem_set, "cage");
  EXPECT_EQ(schedule[2].problem_index, 5);
  EXPECT_EQ(schedule[2].direction, Direction::kBackward);
  EXPECT_EQ(schedule[2].trial, 3);
  EXPECT_EQ(schedule[0].seed, 10u);
  EXPECT_EQ(schedule[2].seed, 12u);
}

TEST(ScheduleTest, EverythingServedIsTheDefault) {
  const std::vector<ScheduledRun> schedule = MakeSchedule(Options(), Served());
  EXPECT_EQ(schedule.size(), 5u * 2 * 2);
  const std::vector<std::string> ids = Ids(schedule);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_EQ(schedule.front().problem_set, "box");
  EXPECT_EQ(schedule.back().problem_set, "cage");
  EXPECT_EQ(schedule.back().problem_index, 5);
}

TEST(ScheduleTest, SetsComeInTheOrderAsked) {
  DriverOptions options = Options();
  options.sets = {"cage", "box"};
  EXPECT_EQ(MakeSchedule(options, Served()).front().problem_set, "cage");
}

TEST(ScheduleTest, RangeSelectsWhatASetHas) {
  DriverOptions options = Options();
  options.planners = {"ara"};
  options.directions = {Direction::kForward};
  options.problem_indices = {2, 3, 4, 5};
  EXPECT_EQ(Ids(MakeSchedule(options, Served())),
            (std::vector<std::string>{"run/box/2/ara/forward/1", "run/box/3/ara/forward/1",
                                      "run/cage/2/ara/forward/1", "run/cage/5/ara/forward/1"}));
}

TEST(ScheduleTest, WhatIsNotServedIsNamed) {
  DriverOptions options = Options();
  options.sets = {"kitchen"};
  ExpectInputError([&] { MakeSchedule(options, Served()); }, {"--sets", "'kitchen'", "box, cage"});
  options.sets = {"cage"};
  options.problem_indices = {3, 4};
  ExpectInputError([&] { MakeSchedule(options, Served()); },
                   {"--problems-range", "'cage'", "2 from 2 to 5"});
  ProblemSetsMessage served;
  served.sets = {{"void", {}, "void-1"}};
  ExpectInputError([&] { MakeSchedule(Options(), served); }, {"'void'", "empty"});
}

}  // namespace
}  // namespace planbench
