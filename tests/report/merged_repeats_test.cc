#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "results/stored_session.h"
#include "tests/report/merge_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(MergeSessionsTest, ARepeatStandsInThePlaceOfTheAttemptOfItsOwnSessionAlone) {
  const MadeRun disturbed = {.contestant = "A", .time_s = 2, .counters = {{"disturbed", 1}}};
  const MadeRun repeat = {.contestant = "A", .counters = {{"repeats", 1}}};
  const MadeRun other = {.contestant = "A", .problem = 2};
  const SessionMessage later = Session("later", 2'000'000, 1);
  Write("early", Session("early", 1'000'000, 1), {other});
  Write("begun", later, {disturbed});
  Write("resumed", later, {repeat});
  Write("stranger", Session("stranger", 3'000'000, 1), {repeat});
  ASSERT_EQ(MergeTo("both", {"early", "begun"}), kExitOk) << errors_;
  int number = 0;
  for (const std::vector<std::string>& folders : std::vector<std::vector<std::string>>{
           {"begun", "resumed"}, {"resumed", "begun"}, {"both", "resumed"}, {"resumed", "both"}}) {
    const std::string whole = fmt::format("whole{}", ++number);
    ASSERT_EQ(MergeTo(whole, folders), kExitOk) << errors_;
    for (const StoredRun& run : ReadSessions(folder_ / whole).sessions.front().runs) {
      EXPECT_EQ(run.repeats, run.problem_index == 1 ? 1 : 0) << whole;
    }
  }
  for (const char* folder : {"begun", "both"}) {
    ExpectRefused({folder, "stranger"}, "tell differently of A, shelf 1, forward, trial 1");
    ExpectRefused({"stranger", folder}, "tell differently of A, shelf 1, forward, trial 1");
  }
}

TEST_F(MergeSessionsTest, RepeatsThatPartsOweAreOwedByTheWhole) {
  // Two shards, the run of each disturbed after so many repeats.
  const auto is_finished = [this](const std::string& whole, const std::string& flag,
                                  std::array<double, 2> repeats) {
    std::vector<std::string> folders;
    for (const int shard : {1, 2}) {
      SessionMessage part = PartOf(shard, 2);
      part.settings["repeat-disturbed"] = flag;
      MadeRun run = {.contestant = "A", .problem = shard};
      run.counters = {{"disturbed", 1},
                      {"repeats", repeats.at(static_cast<std::size_t>(shard - 1))}};
      folders.push_back(fmt::format("{}{}", whole, shard));
      Write(folders.back(), part, {run});
    }
    EXPECT_EQ(MergeTo(whole, folders), kExitOk) << errors_;
    const StoredSession session = ReadSessions(folder_ / whole).sessions.front();
    EXPECT_EQ(session.num_runs, 2);
    return session.finished;
  };
  EXPECT_FALSE(is_finished("owing", "true", {2, 1}));
  EXPECT_THAT(output_, HasSubstr("; disturbed and still to be made again (--resume): 1"));
  EXPECT_TRUE(is_finished("repeated", "true", {2, 2})) << "no run is made a third time";
  EXPECT_THAT(output_, Not(HasSubstr("--resume")));
  EXPECT_TRUE(is_finished("as-they-are", "false", {0, 0}));
}

}  // namespace
}  // namespace planbench
