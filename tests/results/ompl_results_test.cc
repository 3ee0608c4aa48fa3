#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/sqlite.h"
#include "results/compared_sessions.h"
#include "results/comparison.h"
#include "results/imported_results.h"
#include "results/ompl_log.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

constexpr char kLog[] =
    "OMPL version 1.6.0\nExperiment lab/3\nRunning on host1\nStarting at 2024-05-01 10:00:00\n"
    "<<<|\na demo\n|>>>\n<<<|\na cpu\n|>>>\n7 is the random seed\n1.5 seconds per run\n"
    "1024 MB per run\n4 runs per planner\n0.5 seconds spent to collect the data\n1 enum type\n"
    "status|Unknown status|Invalid start|Invalid goal|Unrecognized goal type|Timeout|"
    "Approximate solution|Exact solution|Crash\n2 planners\n"
    "geometric_RRTstar\n1 common properties\nrange = 0.5\n6 properties for each run\ntime REAL\n"
    "solved BOOLEAN\nstatus ENUM\nsolution length REAL\nsimplified solution length REAL\n"
    "correct solution BOOLEAN\n4 runs\n"
    "0.01; 1; 6; 3.25; 3; 1; \n0.02; 1; 6; 3.5; inf; 0; \n1.5; 1; 5; 9; ; 1; \n"
    "1.5; 0; 4; ; ; ; \n"
    "2 progress properties for each run\ntime REAL\nbest cost REAL\n4 runs\n"
    "0.1,inf,;0.2,5,;0.3,5,;0.4,4,;\n0.2,6,;\n\n\n.\n"
    "geometric_PRM\n0 common properties\n1 properties for each run\nsolved BOOLEAN\n1 runs\n1; \n"
    ".\n";

constexpr char kExperiment[] = "(1, 'box', 5, 'host', 'OMPL 1.6', 'today')";

/// What is said of paths whose planner may be an anytime one.
auto TellsOfWholeSearches() { return testing::HasSubstr("no cost over time is told"); }

class OmplResultsTest : public testing::Test {
 protected:
  StoredSession Log(const std::string& text) {
    folder_.Write("own.log", text);
    return ImportResults(folder_ / "own.log", "OMPL", 60, &warnings_);
  }

  /// A database's rows, and statements that add `more`: one experiment with one planner, if no
  /// others are given.
  struct Rows {
    std::string runs;
    std::string planners = "(1, 'PRM', '')";
    std::string experiments = kExperiment;
    std::string more = {};
  };
  /// Makes a database as OMPL's script would have, in the place of an earlier one.
  void Fill(const Rows& rows) {
    std::filesystem::remove(folder_ / "own.db");
    SqliteConnection database(folder_ / "own.db", SqliteConnection::Mode::kReadWriteCreate);
    database.Execute(
        "CREATE TABLE experiments (id INTEGER PRIMARY KEY, name, timelimit, hostname, version, "
        "date); CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY, name, settings);"
        "CREATE TABLE enums (name, value, description);"
        "CREATE TABLE runs (id INTEGER PRIMARY KEY, experimentid, plannerid, time REAL, solved, "
        "status, solution_length REAL, trial);");
    database.Execute(
        fmt::format("INSERT INTO experiments VALUES {}; INSERT INTO plannerConfigs VALUES {};"
                    "INSERT INTO runs VALUES {}; {}",
                    rows.experiments, rows.planners, rows.runs, rows.more));
  }
  StoredSession Database() { return ImportResults(folder_ / "own.db", "mine", 60, &warnings_); }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(OmplResultsTest, ALogsPlannersAreContestants) {
  const StoredSession session = Log(kLog);
  EXPECT_EQ(session.host, "host1");
  EXPECT_EQ(session.cpu, "a cpu");
  EXPECT_EQ(session.seed, "7");
  ASSERT_EQ(session.contestants.size(), 2u);
  EXPECT_EQ(session.contestants[0].name, "OMPL: geometric_RRTstar");
  EXPECT_EQ(session.contestants[0].settings, "planner = geometric_RRTstar\nrange = 0.5\n");
  ASSERT_EQ(session.runs.size(), 5u);
  const StoredRun& first = session.runs[0];
  EXPECT_EQ(first.problem_set, "lab");
  EXPECT_EQ(first.problem_index, 3);
  EXPECT_EQ(first.time_s, 0.01);
  EXPECT_EQ(first.time_limit_s, 1.5);
  EXPECT_EQ(first.status, PlanStatus::kSolved);
  EXPECT_EQ(first.measures, (MeasuredValues{{"path_length", 3.25}}));
  EXPECT_EQ(first.measures_simple, (MeasuredValues{{"path_length", 3}}));
  // Improvements alone.
  ASSERT_EQ(first.progress.size(), 2u);
  EXPECT_EQ(first.progress[1].elapsed_s, 0.4);
  EXPECT_EQ(first.progress[1].cost, 4);
  EXPECT_EQ(session.runs[1].status, PlanStatus::kInvalidPath);
  EXPECT_TRUE(session.runs[1].claimed);
  EXPECT_EQ(session.runs[1].trial, 2);
  EXPECT_TRUE(session.runs[1].measures_simple.empty());
  EXPECT_EQ(session.runs[2].status, PlanStatus::kTimedOut);
  EXPECT_EQ(session.runs[2].message, "Approximate solution");
  EXPECT_EQ(session.runs[3].message, "Timeout");
  EXPECT_EQ(session.runs[4].contestant, 1u);
  EXPECT_TRUE(session.runs[4].claimed);
}

TEST_F(OmplResultsTest, APathIsInTimeIfItWasInHandWhenTheLimitCame) {
  std::string log = kLog;
  const auto replace = [&](const std::string& text, const std::string& by) {
    log.replace(log.find(text), text.size(), by);
  };
  replace("0.01; 1; 6", "1.6; 1; 6");  // with improvements from 0.2 s on
  replace("0.02; 1; 6; 3.5; inf; 0", "3; 1; 6; 3.5; inf; 1");
  replace("1.5; 1; 5; 9", "1.6; 1; 6; 9");
  replace("0.2,6,;\n\n", "0.2,6,;\n1.6,6,;\n");
  const StoredSession session = Log(log);
  const std::vector<StoredRun>& runs = session.runs;
  EXPECT_EQ(runs[0].status, PlanStatus::kSolved);
  EXPECT_EQ(runs[0].time_s, 0.2) << "to the first solution, as of our own planners";
  EXPECT_FALSE(OwesToOverrun(runs[0].odd_times_s));
  EXPECT_EQ(runs[1].status, PlanStatus::kSolved);
  EXPECT_EQ(runs[1].time_s, 0.2);
  EXPECT_TRUE(OwesToOverrun(runs[1].odd_times_s)) << "by 1.5 s";
  EXPECT_EQ(runs[2].status, PlanStatus::kTimedOut);
  EXPECT_TRUE(runs[2].claimed);
  EXPECT_EQ(runs[2].message, "solved after 1.6 s, beyond the time limit of 1.5 s");
  EXPECT_EQ(runs[2].time_s, 1.6);
  // The planner after it tells no time: the limit is none that it took.
  EXPECT_EQ(runs[4].status, PlanStatus::kTimedOut);
  EXPECT_EQ(runs[4].message, "solved, but in a time that is not told");
  EXPECT_EQ(runs[4].time_s, std::nullopt);
  EXPECT_THAT(warnings_,
              testing::ElementsAre(
                  testing::HasSubstr("own.log: 1 solved run took longer than its time limit and "
                                     "counts as TIMED_OUT"),
                  testing::HasSubstr("own.log: 1 solved run has no time and counts as TIMED_OUT")));
  // The limit of the session, and none that is known.
  replace("1.5 seconds per run", "inf seconds per run");
  EXPECT_EQ(Log(log).runs[2].status, PlanStatus::kSolved);
  EXPECT_EQ(ImportResults(folder_ / "own.log", "OMPL", 1, &warnings_).runs[2].status,
            PlanStatus::kTimedOut);
  EXPECT_EQ(ImportResults(folder_ / "own.log", "OMPL", 0, &warnings_).runs[2].status,
            PlanStatus::kSolved);
}

TEST_F(OmplResultsTest, PlanningEndsWithTheFirstSolutionIfProgressTellsIt) {
  std::string log = kLog;
  const auto replace = [&](const std::string& text, const std::string& by) {
    log.replace(log.find(text), text.size(), by);
  };
  replace("0.01; 1; 6", "1.4; 1; 6");
  replace("0.02; 1; 6; 3.5; inf; 0", "0.15; 1; 6; 3.5; inf; 1");
  replace("1.5; 1; 5; 9", "1.4; 1; 6; 9");  // without progress
  replace("1.5; 0; 4; ", "1.5; 0; 5; ");
  replace("0.2,6,;\n\n\n", "0.2,6,;\n\n0.3,7,;\n");
  const std::vector<StoredRun> runs = Log(log).runs;
  EXPECT_EQ(runs[0].time_s, 0.2) << "the first sample with a finite cost";
  EXPECT_EQ(runs[0].total_time_s, 1.4);
  EXPECT_EQ(runs[1].time_s, 0.15) << "it ended before the sample";
  EXPECT_EQ(runs[2].time_s, 1.4);
  EXPECT_EQ(runs[3].time_s, 1.5) << "no path came of it";
  EXPECT_THAT(warnings_,
              testing::ElementsAre(testing::HasSubstr("own.log: of 1 of its paths no cost"),
                                   testing::HasSubstr("1 solved run has no time")));
  // Who tells a total time as well, as we do, tells in `time` when planning ended.
  warnings_.clear();
  replace("solution length REAL", "total time REAL");
  EXPECT_EQ(Log(log).runs[0].time_s, 1.4);
  EXPECT_EQ(Log(log).runs[0].total_time_s, 3.25);
  EXPECT_TRUE(OwesToOverrun(Log(log).runs[0].odd_times_s)) << "by 1.75 s";
}

TEST_F(OmplResultsTest, ADamagedLogIsRefusedByLine) {
  std::string text = kLog;
  ExpectInputError([&] { Log(text.substr(0, text.find("4 runs\n0.01"))); }, {"own.log:28"});
  ExpectInputError([&] { Log(text.replace(text.find("0.02; "), 6, "x; ")); },
                   {"own.log:31", "time: 'x' is no number"});
  ExpectInputError([&] { Log(text.replace(text.find("x; "), 3, "")); }, {"own.log:31", "5 values"});
}

TEST_F(OmplResultsTest, TimesAndLengthsBelowZeroAreRefused) {
  const auto refused = [&](const std::string& text, const std::string& spoilt,
                           const std::vector<std::string>& parts) {
    SCOPED_TRACE(spoilt);
    std::string log = kLog;
    log.replace(log.find(text), text.size(), spoilt);
    ExpectInputError([&] { Log(log); }, parts);
  };
  refused("1.5 seconds per run", "-5 seconds per run", {"own.log:12: time limit: -5 is negative"});
  refused("0.02; 1", "-0.05; 1", {"own.log:31: time: -0.05 is negative"});
  refused("6; 3.5;", "6; -4;", {"own.log:31: solution_length: -4 is negative"});
  refused("0.2,6,;", "-0.2,6,;", {"own.log:39: time: -0.2 is negative"});
  std::string log = kLog;
  log.replace(log.find("solution length"), 15, "solution clearance");
  log.replace(log.find("6; 3.5;"), 7, "6; -4;");
  EXPECT_EQ(Log(log).runs[1].measures, (MeasuredValues{{"clearance", -4}}));

  const auto fill = [&](const std::string& limit, const std::string& run) {
    Fill({.runs = fmt::format("(7, 2, 1, {}, NULL)", run),
          .experiments = fmt::format("(2, 'box', {}, 'host', 'OMPL 1.6', 'today')", limit)});
  };
  fill("5", "-0.05, 1, 6, 4");
  ExpectInputError([&] { Database(); }, {"own.db: run 7 of experiment 2: time: -0.05 is negative"});
  fill("5", "0.05, 1, 6, -4");
  ExpectInputError([&] { Database(); }, {"run 7 of experiment 2: solution_length: -4 is negative"});
  fill("-5", "0.05, 1, 6, 4");
  ExpectInputError([&] { Database(); }, {"run 7 of experiment 2: timelimit: -5 is negative"});
}

TEST_F(OmplResultsTest, ADatabaseIsReadLikeItsLog) {
  Fill({.runs = "(1, 1, 4, 0.25, 1, 1, 3, NULL), (2, 1, 4, 5, 0, 0, NULL, NULL)",
        .planners = "(4, 'PRM', 'k = 5')",
        .more = "INSERT INTO enums VALUES ('status', 0, 'Timeout'), "
                "('status', 1, 'Exact solution');"});
  const StoredSession session = Database();
  ASSERT_EQ(session.contestants.size(), 1u);
  EXPECT_EQ(session.contestants[0].name, "mine");
  ASSERT_EQ(session.runs.size(), 2u);
  EXPECT_TRUE(session.runs[0].confirmed());
  EXPECT_EQ(session.runs[0].time_s, 0.25);
  EXPECT_EQ(session.runs[0].problem_set, "box");
  EXPECT_EQ(session.runs[0].problem_index, 1);
  EXPECT_EQ(session.runs[1].status, PlanStatus::kTimedOut);
  EXPECT_EQ(session.runs[1].trial, 2);
  EXPECT_EQ(session.runs[1].time_limit_s, 5);
  EXPECT_TRUE(session.runs[0].progress.empty());
  folder_.Write("other.db", std::string("SQLite format 3\0", 16) + std::string(600, 'x'));
  ExpectInputError([&] { ImportResults(folder_ / "other.db", "x", 1, &warnings_); }, {"other.db"});
}

TEST_F(OmplResultsTest, ADatabasesProgressIsThatOfItsLog) {
  Fill({.runs = "(3, 1, 1, 5.01, 1, 6, 4, NULL), (4, 1, 2, 1, 1, 6, 3, NULL)",
        .planners = "(1, 'RRTstar', ''), (2, 'PRM', '')",
        .more = "CREATE TABLE progress (runid INTEGER, time REAL, best_cost REAL, "
                "iterations INTEGER, PRIMARY KEY (runid, time));"
                "INSERT INTO progress VALUES (3, 0.4, 4, 9), (3, 0.1, NULL, 1), (3, 0.2, 5, 2), "
                "(3, 0.3, 5, 3), (8, 0.1, 1, 1);"});
  const StoredSession session = Database();
  ASSERT_EQ(session.runs.size(), 2u);
  const std::vector<PlanProgress>& progress = session.runs[0].progress;
  ASSERT_EQ(progress.size(), 2u) << "improvements alone";
  EXPECT_EQ(progress[0].elapsed_s, 0.2);
  EXPECT_EQ(progress[0].cost, 5);
  EXPECT_EQ(progress[1].elapsed_s, 0.4);
  EXPECT_EQ(progress[1].cost, 4);
  EXPECT_TRUE(session.runs[0].confirmed()) << "in hand when the limit came";
  EXPECT_EQ(session.runs[0].time_s, 0.2);
  EXPECT_EQ(session.runs[0].total_time_s, 5.01);
  EXPECT_TRUE(session.runs[1].progress.empty());
  EXPECT_EQ(session.runs[1].time_s, 1);
  EXPECT_THAT(warnings_,
              testing::ElementsAre(testing::HasSubstr("own.db: of 1 of its paths no cost")));
  SqliteConnection(folder_ / "own.db", SqliteConnection::Mode::kReadWriteCreate)
      .Execute("UPDATE progress SET time = -1 WHERE iterations = 9");
  ExpectInputError([&] { Database(); }, {"own.db: run 3 of experiment 1: time: -1 is negative"});
}

TEST_F(OmplResultsTest, AStatusIsOfTheListOfTheProgramThatWroteIt) {
  for (const std::string list :
       {"('status', 0, 'Unknown status'), ('status', 5, 'Approximate solution'), "
        "('status', 6, 'Exact solution')",
        "('status', 0, 'SOLVED'), ('status', 2, 'EXHAUSTED')"}) {
    SCOPED_TRACE(list);
    Fill({.runs = "(1, 1, 1, 0.25, 1, 6, 3, NULL), (2, 1, 1, 5, 1, 5, NULL, NULL), "
                  "(3, 2, 2, 0.5, 1, 0, 3, 1), (4, 2, 2, 5, 0, 2, NULL, 2)",
          .planners = "(1, 'PRM', ''), (2, 'ours', '')",
          .experiments =
              std::string(kExperiment) + ", (2, 'box', 5, 'host', 'planbench 0.2.0', 'today')",
          .more = "INSERT INTO enums VALUES " + list + ";"});
    const StoredSession session = Database();
    ASSERT_EQ(session.runs.size(), 4u);
    EXPECT_EQ(session.runs[0].status, PlanStatus::kSolved);
    EXPECT_EQ(session.runs[1].message, "Approximate solution");
    EXPECT_EQ(session.runs[2].status, PlanStatus::kSolved);
    EXPECT_EQ(session.runs[3].status, PlanStatus::kExhausted);
    EXPECT_THAT(warnings_, testing::Each(TellsOfWholeSearches()));
  }
}

TEST_F(OmplResultsTest, WhatSolvedSaysCountsWhereTheStatusContradictsIt) {
  Fill({.runs = "(1, 1, 1, 1, 1, 4, 3, NULL), (2, 1, 1, 1, 0, 6, 3, NULL), "
                "(3, 1, 1, 1, 1, 77, 3, NULL), (4, 1, 1, 1, 0, 77, 3, NULL)"});
  const StoredSession session = Database();
  ASSERT_EQ(session.runs.size(), 4u);
  EXPECT_EQ(session.runs[0].status, PlanStatus::kSolved);
  EXPECT_EQ(session.runs[1].status, PlanStatus::kTimedOut);
  EXPECT_EQ(session.runs[1].message, "not solved, though its status is 'Exact solution'");
  EXPECT_EQ(session.runs[2].status, PlanStatus::kSolved);
  EXPECT_EQ(session.runs[3].status, PlanStatus::kTimedOut);
  EXPECT_EQ(session.runs[3].message, "status 77, which no list names");
  EXPECT_THAT(warnings_, testing::ElementsAre(testing::HasSubstr("contradict each other in 2 runs"),
                                              testing::HasSubstr("2 runs have a status that no"),
                                              TellsOfWholeSearches()));
}

TEST_F(OmplResultsTest, APlannerWithTwoSettingsIsTwoContestants) {
  std::string text = kLog;
  text.replace(text.find("geometric_PRM"), 13, "geometric_RRTstar");
  StoredSession session = Log(text);
  ASSERT_EQ(session.contestants.size(), 2u);
  EXPECT_EQ(session.contestants[0].name, "OMPL: geometric_RRTstar #1");
  EXPECT_EQ(session.contestants[1].name, "OMPL: geometric_RRTstar #2");
  // Their trials are not each other's.
  EXPECT_EQ(JoinImports({"OMPL"}, {session}).front().runs.size(), 5u);
}

TEST_F(OmplResultsTest, TrialsOfSeveralExperimentsAreAllKept) {
  // A second experiment of that day, and runs beside those of the first.
  const auto fill = [&](const std::string& day, const std::string& runs) {
    Fill({.runs = "(1, 1, 1, 1, 1, 6, 3, 1), (2, 1, 1, 2, 1, 6, 3, 2), " + runs,
          .experiments =
              fmt::format("{}, (2, 'box', 5, 'host', 'OMPL 1.6', '{}')", kExperiment, day)});
  };
  fill("tomorrow", "(3, 2, 1, 3, 1, 6, 3, 1), (4, 2, 1, 4, 1, 6, 3, 2)");
  const StoredSession session = Database();
  ASSERT_EQ(session.runs.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(session.runs[static_cast<std::size_t>(i)].trial, i + 1);
  EXPECT_THAT(warnings_, testing::ElementsAre(TellsOfWholeSearches()));
  warnings_.clear();
  // A log that was added twice.
  fill("today", "(3, 2, 1, 1, 1, 6, 3, 1), (4, 2, 1, 2, 1, 6, 3, 2)");
  EXPECT_EQ(Database().runs.size(), 2u);
  EXPECT_THAT(warnings_, testing::ElementsAre(testing::HasSubstr("1 of its experiments repeat"),
                                              TellsOfWholeSearches()));
  // What cannot be told apart.
  fill("tomorrow", "(3, 1, 1, 3, 1, 6, 3, 2)");
  ExpectInputError([&] { Database(); }, {"own.db: run 3 of experiment 1: trial: 'PRM' has trial 2 "
                                         "of problem 1 of 'box'",
                                         "twice"});
}

/// Two contestants with a failure, a rejected path, a rejected simplified path and a second trial.
std::vector<MadeRun> SomeRuns() {
  return {{.contestant = "A; \"one\"", .problem = 1, .time_s = 0.1},
          {.contestant = "A; \"one\"",
           .problem = 1,
           .trial = 2,
           .time_s = 0.3,
           .simplified_valid = false},
          {.contestant = "A; \"one\"", .problem = 2, .status = PlanStatus::kTimedOut},
          {.contestant = "B", .problem = 1, .status = PlanStatus::kInvalidPath},
          {.contestant = "B", .problem = 2, .direction = Direction::kBackward, .length = 7}};
}

TEST_F(OmplResultsTest, ALogOfOursComesBackAsItWas) {
  WriteSession(folder_ / "example", SomeRuns());
  std::vector<StoredSession> own = ReadSessions(folder_ / "example").sessions;
  folder_.Write("own.log", OmplLog(own.front(), "shelf"));
  StoredSession imported = ImportResults(folder_ / "own.log", "again", 60, &warnings_);
  ASSERT_EQ(imported.runs.size(), own.front().runs.size());
  // By contestant, as a log has them, which is the order of the example too.
  for (std::size_t i = 0; i < imported.runs.size(); ++i) {
    const StoredRun& before = own.front().runs[i];
    const StoredRun& after = imported.runs[i];
    EXPECT_EQ(after.problem_set, before.problem_set);
    EXPECT_EQ(after.problem_index, before.problem_index);
    EXPECT_EQ(after.trial, before.trial);
    EXPECT_EQ(after.direction, before.direction);
    EXPECT_EQ(after.status, before.status);
    EXPECT_EQ(after.claimed, before.claimed);
    EXPECT_EQ(after.time_s, before.time_s);
    EXPECT_EQ(after.total_time_s, before.total_time_s);
    EXPECT_EQ(after.measures, before.measures);
    EXPECT_EQ(after.measures_simple, before.measures_simple);
    EXPECT_EQ(after.simplified_valid, before.simplified_valid);
    EXPECT_EQ(after.time_limit_s, before.time_limit_s);
  }
  EXPECT_EQ(imported.contestants[0].name, "again: A; \"one\"");
  warnings_.clear();  // of the log itself, if any
  KeepProblems(ProblemsOf(own), &imported, &warnings_);
  EXPECT_EQ(imported.runs.size(), 5u);
  EXPECT_TRUE(warnings_.empty());
  std::erase_if(own.front().runs, [](const StoredRun& run) { return run.problem_index == 2; });
  KeepProblems(ProblemsOf(own), &imported, &warnings_);
  EXPECT_EQ(imported.runs.size(), 3u);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("own.log: problem 2 of 'shelf' is none of the session's; 2 of 5"),
            std::string::npos)
      << warnings_[0];
  own.front().runs[0].problem_set = "other";
  own.front().runs.resize(1);
  ExpectInputError([&] { KeepProblems(ProblemsOf(own), &imported, &warnings_); },
                   {"own.log", "shelf", "other"});
}

TEST_F(OmplResultsTest, ALogHasNoTimesThatAreNotTold) {
  WriteSession(folder_ / "example", {{.contestant = "A"}});
  StoredSession session = ReadSessions(folder_ / "example").sessions.front();
  EXPECT_NE(OmplLog(session, "shelf").find("; 0.125; 0.5; 0.25; 0.125; 0.25; \n"),
            std::string::npos);
  session.runs.front().phases = {};
  EXPECT_NE(OmplLog(session, "shelf").find("; ; ; ; ; ; \n"), std::string::npos);
}

TEST_F(OmplResultsTest, OfImprovementsAtOneTimeALogHasTheLast) {
  WriteSession(
      folder_ / "example",
      {{.contestant = "A", .progress = {{0.5, 0, 30, 1}, {0.5, 0, 20, 2}, {1, 0, 10, 3}}}});
  const std::string log = OmplLog(ReadSessions(folder_ / "example").sessions.front(), "shelf");
  EXPECT_NE(log.find("\n0.5,20,;1,10,;\n"), std::string::npos) << log;
}

TEST_F(OmplResultsTest, OmplsOwnReaderTakesALogOfOurs) {
  if (std::system("command -v ompl_benchmark_statistics >/dev/null") != 0) {
    GTEST_SKIP() << "no reader of OMPL's here: apt-get install ompl-demos";
  }
  WriteSession(folder_ / "example", SomeRuns());
  const StoredSession own = ReadSessions(folder_ / "example").sessions.front();
  folder_.Write("own.log", OmplLog(own, "shelf"));
  // Into a database of its own, and appended to ours.
  for (const char* database : {"fresh.db", "example/results.sqlite"}) {
    const std::string path = (folder_ / database).string();
    ASSERT_EQ(std::system(fmt::format("cd {} && ompl_benchmark_statistics -a -d {} {} >/dev/null",
                                      folder_.path().string(), path, (folder_ / "own.log").string())
                              .c_str()),
              0);
    SqliteConnection connection(path, SqliteConnection::Mode::kReadOnly);
    const bool is_ours = std::string(database) != "fresh.db";
    EXPECT_EQ(connection.QueryValue("SELECT count(*) FROM runs"),
              SqliteValue(std::int64_t{is_ours ? 10 : 5}));
    EXPECT_EQ(connection.QueryValue("SELECT sum(solved) FROM runs"),
              SqliteValue(std::int64_t{is_ours ? 6 : 3}));
    EXPECT_EQ(connection.QueryValue("SELECT max(solution_length) FROM runs"), SqliteValue(7.0));
    EXPECT_EQ(ImportResults(path, "X", 1, &warnings_).runs.size(), 5u);
  }
}

}  // namespace
}  // namespace planbench
