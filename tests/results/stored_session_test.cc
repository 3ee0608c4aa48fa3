#include "results/stored_session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/sqlite.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class ReadSessionsTest : public testing::Test {
 protected:
  TemporaryFolder folder_;

  std::filesystem::path database() const { return folder_ / "one" / "results.sqlite"; }
  void Execute(const std::string& sql) {
    SqliteConnection(database(), SqliteConnection::Mode::kReadWriteCreate).Execute(sql);
  }
};

TEST_F(ReadSessionsTest, ReadsWhatTheLoggerWrote) {
  SessionMessage message;
  message.version = "1.2";
  message.commit = "abc";
  message.host = "bench";
  message.robot_name = "fetch";
  message.conditions.request.seed = 18'446'744'073'709'551'615u;
  message.settings = {{"time", "10"}, {"launch", "true"}};
  WriteSession(
      folder_ / "one",
      {{.contestant = "A", .problem = 7, .trial = 2, .time_s = 0.25},
       {.contestant = "B", .status = PlanStatus::kInvalidPath, .reason = "hits board"},
       {.contestant = "A", .status = PlanStatus::kNoAnswer, .time_s = 3},
       {.contestant = "C", .status = PlanStatus::kNoAnswer, .reason = "given up", .asked = false}},
      message);
  const StoredSessions stored = ReadSessions(folder_ / "one");
  ASSERT_EQ(stored.sessions.size(), 1u);
  const StoredSession& session = stored.sessions.front();
  EXPECT_EQ(session.run_id, "one");
  EXPECT_TRUE(session.described);
  EXPECT_TRUE(session.finished);
  EXPECT_EQ(session.num_runs, 4);
  EXPECT_EQ(session.commit, "abc");
  EXPECT_EQ(session.seed, "18446744073709551615");
  EXPECT_EQ(session.flags.at("time"), "10");
  ASSERT_EQ(session.contestants.size(), 3u);
  ASSERT_EQ(session.runs.size(), 3u);
  EXPECT_EQ(session.num_not_asked, 1);
  EXPECT_EQ(session.why_not_asked.Summary(), "mostly: given up");

  const StoredRun& solved = session.runs[0];
  EXPECT_EQ(session.contestants[solved.contestant].name, "A");
  EXPECT_EQ(solved.problem_set, "shelf");
  EXPECT_EQ(solved.problem_index, 7);
  EXPECT_EQ(solved.trial, 2);
  EXPECT_TRUE(solved.confirmed());
  EXPECT_TRUE(solved.claimed);
  EXPECT_EQ(solved.time_s, 0.25);
  EXPECT_EQ(solved.total_time_s, 0.25);
  EXPECT_EQ(solved.time_limit_s, 10);
  EXPECT_EQ(solved.phases.collision_s, 0.125);
  EXPECT_EQ(solved.phases.simplification_s, 0.25);
  EXPECT_EQ(solved.measures, (MeasuredValues{{"path_length", 2}}));
  EXPECT_EQ(solved.measures_simple, (MeasuredValues{{"path_length", 1}}));
  EXPECT_FALSE(solved.mesh_valid);

  const StoredRun& rejected = session.runs[1];
  EXPECT_TRUE(rejected.claimed);
  EXPECT_FALSE(rejected.confirmed());
  EXPECT_EQ(rejected.message, "hits board");

  const StoredRun& silent = session.runs[2];
  EXPECT_EQ(silent.contestant, solved.contestant);
  EXPECT_FALSE(silent.time_s);
  EXPECT_EQ(silent.roundtrip_time_s, 3.5);
}

TEST_F(ReadSessionsTest, OneRunCanBeReadWithoutTheOthers) {
  WriteSession(folder_ / "one",
               {{.contestant = "A", .problem = 7},
                {.contestant = "B", .problem = 8, .progress = {{1, 2, 3, 4}}},
                {.contestant = "A", .status = PlanStatus::kNoAnswer, .asked = false}});
  const StoredSessions stored = ReadSessions(folder_ / "one", 2);
  ASSERT_EQ(stored.sessions.size(), 1u);
  const StoredSession& session = stored.sessions.front();
  EXPECT_TRUE(session.described);
  ASSERT_EQ(session.runs.size(), 1u);
  EXPECT_EQ(session.runs[0].id, 2);
  EXPECT_EQ(session.runs[0].problem_index, 8);
  EXPECT_EQ(session.runs[0].progress.size(), 1u);
  EXPECT_TRUE(ReadSessions(folder_ / "one", 3).sessions.front().runs.empty());
  EXPECT_TRUE(ReadSessions(folder_ / "one", 4).sessions.front().runs.empty());
}

TEST_F(ReadSessionsTest, OfTheOtherRunsNothingIsReadThen) {
  const std::string counter = kOddTimes[0].counter;
  WriteSession(folder_ / "one",
               {{.contestant = "A", .counters = {{counter, 3}}, .progress = {{1, 2, 3, 4}}},
                {.contestant = "A", .counters = {{counter, 5}}, .progress = {{1, 2, 3, 4}}}});
  // Who reads those of another run overflows.
  for (const auto& [table, columns] :
       {std::pair("progress", "rowid, *"), std::pair("counters", "*")}) {
    Execute(
        fmt::format("ALTER TABLE {0} RENAME TO all_{0}; CREATE VIEW {0} AS SELECT {1} FROM "
                    "all_{0} WHERE abs(CASE runid WHEN 2 THEN 0 ELSE -9223372036854775808 "
                    "END) = 0",
                    table, columns));
    ExpectInputError([&] { ReadSessions(folder_ / "one"); }, {"overflow"});
    const StoredRun run = ReadSessions(folder_ / "one", 2).sessions.front().runs.front();
    EXPECT_EQ(run.odd_times_s[0], 5);
    EXPECT_EQ(run.progress.size(), 1u);
  }
}

TEST_F(ReadSessionsTest, OfARejectedSimplifiedPathNothingCounts) {
  WriteSession(folder_ / "one",
               {{.contestant = "A", .simplified_valid = false, .mesh_valid_simplified = true},
                {.contestant = "A", .problem = 2},
                {.contestant = "A", .problem = 3}});
  Execute("UPDATE runs SET simplified_valid = NULL WHERE id = 3");
  const StoredSessions stored = ReadSessions(folder_ / "one");
  const std::vector<StoredRun>& runs = stored.sessions.front().runs;
  EXPECT_EQ(runs[0].simplified_valid, std::optional(false));
  EXPECT_EQ(runs[0].measures, (MeasuredValues{{"path_length", 2}}));
  EXPECT_TRUE(runs[0].measures_simple.empty());
  EXPECT_FALSE(runs[0].mesh_valid_simple.has_value());
  EXPECT_EQ(runs[1].simplified_valid, std::optional(true));
  EXPECT_EQ(runs[1].measures_simple, (MeasuredValues{{"path_length", 1}}));
  EXPECT_EQ(runs[2].simplified_valid, std::nullopt);
  EXPECT_EQ(runs[2].measures_simple, (MeasuredValues{{"path_length", 1}})) << "nobody judged it";
}

TEST_F(ReadSessionsTest, AFileWillDo) {
  WriteSession(folder_ / "one", {{.contestant = "A"}});
  EXPECT_EQ(ReadSessions(database()).sessions.size(), 1u);
}

TEST_F(ReadSessionsTest, RunsWhoseSessionSentNoMessageAreThere) {
  WriteSession(folder_ / "one", {{.contestant = "A"}});
  Execute("DELETE FROM sessions");
  const StoredSessions stored = ReadSessions(folder_ / "one");
  ASSERT_EQ(stored.sessions.size(), 1u);
  EXPECT_FALSE(stored.sessions.front().described);
  EXPECT_EQ(stored.sessions.front().runs.size(), 1u);
}

TEST_F(ReadSessionsTest, ColumnsOfLaterVersionsMayBeMissing) {
  WriteSession(folder_ / "one",
               {{.contestant = "A"},
                {.contestant = "A", .problem = 2, .status = PlanStatus::kInvalidPath},
                {.contestant = "A", .problem = 3, .status = PlanStatus::kTimedOut}});
  Execute("ALTER TABLE runs DROP COLUMN claimed; PRAGMA user_version = 1");
  const StoredSessions stored = ReadSessions(folder_ / "one");
  const std::vector<StoredRun>& runs = stored.sessions.front().runs;
  EXPECT_TRUE(runs[0].claimed);
  EXPECT_TRUE(runs[1].claimed);
  EXPECT_FALSE(runs[2].claimed);
}

TEST_F(ReadSessionsTest, RunsOfOtherProgramsAreCountedAndLeftOut) {
  WriteSession(folder_ / "one", {{.contestant = "A"}});
  Execute("INSERT INTO runs (experimentid, plannerid, time) VALUES (1, 1, 0.5)");
  const StoredSessions stored = ReadSessions(folder_ / "one");
  EXPECT_EQ(stored.num_foreign_runs, 1);
  EXPECT_EQ(stored.sessions.front().runs.size(), 1u);
}

TEST_F(ReadSessionsTest, WhatIsNoResultsDatabaseIsRefusedInOneLine) {
  const auto expect_refused = [&](const std::string& reason) {
    ExpectInputError([&] { ReadSessions(folder_ / "one"); },
                     {database().filename().string(), reason});
  };
  ExpectInputError([&] { ReadSessions(folder_ / "none"); }, {"none", "does not exist"});
  ExpectInputError([&] { ReadSessions("/dev/null"); },
                   {"/dev/null is neither a session folder nor a file"});
  std::filesystem::create_directories(folder_ / "one");
  expect_refused("does not exist");
  folder_.Write("one/results.sqlite", "");
  expect_refused("is no results database of planbench");
  folder_.Write("one/results.sqlite", std::string(5000, 'x'));
  expect_refused("not a database");
  std::filesystem::remove(database());
  Execute("CREATE TABLE runs (id); CREATE TABLE plannerConfigs (id); CREATE TABLE enums (id)");
  expect_refused("was written by another program");
  std::filesystem::remove(database());
  WriteSession(folder_ / "one", {{.contestant = "A"}});
  Execute("PRAGMA user_version = 1000");
  expect_refused("later version");
  Execute("PRAGMA user_version = 2; UPDATE runs SET status = 99");
  expect_refused("99 is no status");
}

TEST_F(ReadSessionsTest, TimesThatCannotBeAreRefused) {
  WriteSession(folder_ / "one", {{.contestant = "A"}});
  for (const char* column : {"time", "roundtrip_time", "time_limit", "collision_time"}) {
    for (const char* value : {"-1.0", "9e999", "-9e999", "'NaN'"}) {
      Execute(fmt::format("UPDATE runs SET {} = {}", column, value));
      ExpectInputError([&] { ReadSessions(folder_ / "one"); },
                       {"results.sqlite: run 1: ", std::string(column) + ": "});
    }
    Execute(fmt::format("UPDATE runs SET {} = 1.0", column));
  }
  EXPECT_NO_THROW(ReadSessions(folder_ / "one"));
}

TEST_F(ReadSessionsTest, AFileThatWasCutShortIsRefused) {
  std::vector<MadeRun> runs;
  for (int i = 1; i <= 60; ++i) runs.push_back({.contestant = "A", .problem = i});
  WriteSession(folder_ / "one", runs);
  std::filesystem::resize_file(database(), std::filesystem::file_size(database()) / 2);
  ExpectInputError([&] { ReadSessions(folder_ / "one"); }, {"results.sqlite", "malformed"});
}

TEST(ParseSettingsTest, WhatTheSessionAskedForStandsWhateverAPlannerCallsItsSettings) {
  const auto settings =
      ParseSettings("collision_model = spheres\ncollision_model = meshes\na = b\n");
  EXPECT_EQ(settings.at("collision_model"), "spheres");
  EXPECT_EQ(settings.at("a"), "b");
}

}  // namespace
}  // namespace planbench
