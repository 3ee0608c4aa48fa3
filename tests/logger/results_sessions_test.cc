#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "results_database_fixture.h"
#include "sample_messages.h"
#include "session_files.h"

namespace planbench {
namespace {

using Outcome = ResultsDatabase::Outcome;

TEST_F(ResultsDatabaseTest, OneExperimentForEachSessionAndSet) {
  database_.Store(SampleSession());
  database_.Store(SampleRecord("a"));
  database_.Store(UnansweredRecord("b"));
  RunRecordMessage other_set = SampleRecord("c");
  other_set.problem_set = "table";
  database_.Store(other_set);
  RunRecordMessage other_session = SampleRecord("d");
  other_session.run_id = "session-2";
  database_.Store(other_session);
  EXPECT_EQ(Count("experiments"), Int(3));
  EXPECT_EQ(Query("SELECT count(DISTINCT experimentid) FROM runs WHERE request_id IN ('a','b')"),
            Int(1));
  EXPECT_EQ(Query("SELECT group_concat(name) FROM experiments"), SqliteValue("shelf,table,shelf"));
}

TEST_F(ResultsDatabaseTest, ExperimentsCarryTheFactsOfTheirSession) {
  database_.Store(SampleSession());
  database_.Store(SampleRecord("a"));
  database_.Store(SampleRecord("b"));
  database_.Store(UnansweredRecord("c"));
  EXPECT_EQ(Query("SELECT totaltime FROM experiments"), kNull);
  database_.Store(FinishedSession());
  const std::vector<std::pair<std::string, SqliteValue>> expected = {
      {"name", "shelf"},
      {"totaltime", 321.5},
      {"timelimit", 60.0},
      {"memorylimit", 0.0},
      {"runcount", Int(2)},  // of the planner with the most
      {"version", "planbench 0.1.0+abc123"},
      {"hostname", "bench-host"},
      {"cpuinfo", "Fast CPU"},
      {"date", "2024-05-06T07:08:09.123456Z"},
      {"seed", "18446744073709551615"},
      {"setup", "run_id = session-1\nrobot = fetch (f00d)\nplanners = ara,rrtc\nsets = shelf\n"},
  };
  for (const auto& [column, value] : expected) {
    EXPECT_EQ(Query("SELECT " + column + " FROM experiments"), value) << column;
  }
}

TEST_F(ResultsDatabaseTest, RunsAreCountedThroughReplacementsErrorsAndReopening) {
  const auto file = folder_ / "counted.sqlite";
  const auto expect_count = [&](std::int64_t expected) {
    SqliteConnection connection(file, SqliteConnection::Mode::kReadOnly);
    EXPECT_EQ(connection.QueryValue("SELECT runcount FROM experiments"), Int(expected));
  };
  {
    ResultsDatabase database(file);
    database.Store(UnansweredRecord("a"));
    database.Store(UnansweredRecord("b"));
    expect_count(2);
    EXPECT_EQ(database.Store(SampleRecord("a")), Outcome::kReplaced) << "by another planner's";
    database.Store(UnansweredRecord("c"));
    expect_count(2);
  }
  ResultsDatabase database(file);
  RunRecordMessage bad = SampleRecord("d");
  bad.result.joint_names = {"pan", "pan"};
  EXPECT_THROW(database.Store(bad), SqliteError);
  RunRecordMessage later = UnansweredRecord("c");
  later.start_utime += 1;
  EXPECT_EQ(database.Store(later), Outcome::kReplaced);
  database.Store(SampleRecord("d"));
  expect_count(2);
  database.Store(SampleRecord("e"));
  expect_count(3);
}

TEST_F(ResultsDatabaseTest, ASessionHeardAfterItsRunsStillDescribesThem) {
  database_.Store(SampleRecord());
  EXPECT_EQ(Query("SELECT timelimit FROM experiments"), SqliteValue(30.0));
  EXPECT_EQ(Query("SELECT hostname FROM experiments"), kNull);
  database_.Store(FinishedSession());
  EXPECT_EQ(Query("SELECT timelimit FROM experiments"), SqliteValue(60.0));
  EXPECT_EQ(Query("SELECT hostname FROM experiments"), SqliteValue("bench-host"));
}

TEST_F(ResultsDatabaseTest, ALateRepetitionOfASessionsBeginChangesNothing) {
  database_.Store(FinishedSession());
  const std::string before = DumpDatabase(file_);
  database_.Store(SampleSession());
  EXPECT_EQ(DumpDatabase(file_), before);
}

TEST_F(ResultsDatabaseTest, ASessionThatIsResumedAfterItsEndIsNotFinished) {
  database_.Store(FinishedSession());
  SessionMessage resumed = FinishedSession();
  resumed.finished = false;
  resumed.total_time_s += 1;
  resumed.num_runs += 5;
  database_.Store(resumed);
  EXPECT_EQ(Query("SELECT finished FROM sessions"), Int(0));
  EXPECT_EQ(Query("SELECT num_runs FROM sessions"), Int(resumed.num_runs));
}

TEST_F(ResultsDatabaseTest, ListsSessionsOldestFirst) {
  SessionMessage later = SampleSession();
  later.run_id = "session-0";
  later.start_utime += 1;
  database_.Store(later);
  database_.Store(SampleSession());
  const std::vector<std::string> sessions = database_.Sessions();
  ASSERT_EQ(sessions.size(), 2);
  EXPECT_NE(sessions[0].find("\"session-1\""), std::string::npos);
  EXPECT_NE(sessions[1].find("\"session-0\""), std::string::npos);
}

TEST_F(ResultsDatabaseTest, NamesSessionsThatLackRuns) {
  SessionMessage session = FinishedSession();
  session.num_runs = 2;
  database_.Store(SampleSession());
  database_.Store(SampleRecord());
  // Of its end nothing may come, of a log that was cut off, say.
  std::vector<IncompleteSession> incomplete = database_.IncompleteSessions();
  ASSERT_EQ(incomplete.size(), 1u);
  EXPECT_FALSE(incomplete[0].finished);
  EXPECT_EQ(incomplete[0].num_runs, SampleSession().num_runs);
  EXPECT_EQ(incomplete[0].num_recorded, 1);
  database_.Store(session);
  incomplete = database_.IncompleteSessions();
  ASSERT_EQ(incomplete.size(), 1u);
  EXPECT_TRUE(incomplete[0].finished);
  EXPECT_EQ(incomplete[0].run_id, session.run_id);
  EXPECT_EQ(incomplete[0].num_runs, 2);
  EXPECT_EQ(incomplete[0].num_recorded, 1);
  database_.Store(UnansweredRecord());
  EXPECT_TRUE(database_.IncompleteSessions().empty());
}

}  // namespace
}  // namespace planbench
