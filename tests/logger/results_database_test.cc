#include "logger/results_database.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "results/stored_session.h"
#include "results_database_fixture.h"
#include "sample_messages.h"
#include "session_files.h"

namespace planbench {
namespace {

using Outcome = ResultsDatabase::Outcome;

constexpr char kProgressSchema[] =
    "SELECT group_concat(sql) FROM (SELECT sql FROM sqlite_master WHERE tbl_name = 'progress' "
    "ORDER BY name)";

TEST_F(ResultsDatabaseTest, KeepsEveryFieldOfARun) {
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kStored);
  const std::vector<std::pair<std::string, SqliteValue>> expected = {
      {"time", 0.25},
      {"memory", 123.5},
      {"solved", Int(1)},
      {"status", Int(0)},
      {"message", kNull},
      {"direction", "backward"},
      {"problem_set", "shelf"},
      {"problem_index", Int(7)},
      {"trial", Int(2)},
      {"seed", "9223372036854775809"},
      {"request_id", "request-1"},
      {"run_id", "session-1"},
      {"scene_id", "scene-hash"},
      {"start_time", "2024-05-06T07:08:10.000001Z"},
      {"collision_model", "voxels"},
      {"edge_resolution", 0.05},
      {"time_limit", 30.0},
      {"anytime", Int(1)},
      {"roundtrip_time", 0.875},
      {"total_time", 0.75},
      {"setup_time", 0.01},
      {"collision_time", 0.02},
      {"guidance_time", 0.03},
      {"search_time", 0.04},
      {"simplification_time", 0.05},
      {"num_waypoints", Int(3)},
      {"num_waypoints_simplified", Int(2)},
      {"referee_valid", Int(1)},
      {"referee_reason", kNull},
      {"referee_engine", "fcl"},
      {"referee_step", 0.001},
      {"simplified_valid", Int(1)},
      {"simplified_reason", kNull},
      {"mesh_valid", Int(0)},
      {"mesh_reason", "elbow hits board at segment 1"},
      {"mesh_depth", 0.0125},
      {"mesh_valid_simplified", Int(1)},
      {"mesh_reason_simplified", kNull},
      {"mesh_depth_simplified", kNull},
      {"epsilon", 1.5},
      {"cost", 2500.0},
      {"edges_checked", Int(11)},
      {"configurations_checked", Int(22)},
      {"iterations", Int(33)},
      {"expansions", Int(44)},
      {"states", Int(55)},
      // OMPL's names
      {"solution_segments", Int(2)},
      {"correct_solution", Int(1)},
      {"simplified_solution_segments", Int(1)},
  };
  for (const auto& [column, value] : expected) EXPECT_EQ(Run(column), value) << column;
}

TEST_F(ResultsDatabaseTest, KeepsEveryMeasure) {
  database_.Store(SampleRecord());
  double value = 0;
  for (const PathMeasure& measure : PathMeasures()) {
    value += 1;
    const std::string name = measure.name;
    EXPECT_EQ(Run(name), SqliteValue(value)) << name;
    EXPECT_EQ(Run(name + "_simplified"), SqliteValue(value / 2)) << name;
  }
  // OMPL's names.
  for (const auto& [theirs, ours] :
       std::map<std::string, std::string>{{"solution_length", "path_length"},
                                          {"solution_clearance", "clearance"},
                                          {"solution_smoothness", "smoothness"}}) {
    EXPECT_EQ(Run(theirs), Run(ours)) << theirs;
    EXPECT_EQ(Run("simplified_" + theirs), Run(ours + "_simplified")) << theirs;
  }
}

TEST_F(ResultsDatabaseTest, KeepsPathsProgressAndCounters) {
  database_.Store(SampleRecord());
  EXPECT_EQ(Query("SELECT count(*) FROM paths WHERE kind = 'raw'"), Int(6));
  EXPECT_EQ(Query("SELECT count(*) FROM paths WHERE kind = 'simplified'"), Int(4));
  EXPECT_EQ(Query("SELECT position FROM paths WHERE kind = 'raw' AND waypoint = 1 "
                  "AND joint = 'pan'"),
            SqliteValue(0.9));
  EXPECT_EQ(Query("SELECT position FROM paths WHERE kind = 'simplified' AND waypoint = 1 "
                  "AND joint = 'lift'"),
            SqliteValue(0.3));
  EXPECT_EQ(Count("progress"), Int(2));
  EXPECT_EQ(Query("SELECT epsilon FROM progress WHERE time = 0.25"), SqliteValue(5.0));
  EXPECT_EQ(Query("SELECT cost FROM progress WHERE time = 0.5"), SqliteValue(2500.0));
  EXPECT_EQ(Query("SELECT best_cost FROM progress WHERE time = 0.5"), SqliteValue(2500.0));
  EXPECT_EQ(Query("SELECT expansions FROM progress WHERE time = 0.5"), Int(900));
  EXPECT_EQ(Count("counters"), Int(6));
  EXPECT_EQ(Query("SELECT value FROM counters WHERE name = 'goal_tries'"), SqliteValue(66.5));
}

TEST_F(ResultsDatabaseTest, ImprovementsAtOneTimeAreAllKeptInOrder) {
  RunRecordMessage record = SampleRecord();
  record.result.result.progress = {
      {0.25, 5, 3000, 100}, {0.25, 0, 4000, 200}, {0.25, 5, 3000, 100}};
  database_.Store(record);
  EXPECT_EQ(Count("progress"), Int(3));
  EXPECT_EQ(Query("SELECT epsilon FROM progress WHERE cost = 4000"), kNull);  // no bound
  const StoredRun run = ReadSessions(file_).sessions.at(0).runs.at(0);
  EXPECT_EQ(run.progress, record.result.result.progress);
}

TEST_F(ResultsDatabaseTest, ADatabaseThatHadRoomForOneImprovementATimeGetsRoomForAll) {
  const auto file = folder_ / "old.sqlite";
  { ResultsDatabase(file).Store(SampleRecord("a")); }
  SqliteConnection(file, SqliteConnection::Mode::kReadWriteCreate)
      .Execute(
          "CREATE TABLE old (runid INTEGER, time REAL, epsilon REAL, cost REAL, expansions "
          "INTEGER, "
          "best_cost REAL, PRIMARY KEY (runid, time), "
          "FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE); "
          "INSERT INTO old SELECT * FROM progress; DROP TABLE progress; "
          "ALTER TABLE old RENAME TO progress; "
          "PRAGMA foreign_keys = OFF; "  // as in the shell of SQLite: a run that was deleted
          "INSERT INTO progress VALUES (99, 0.5, NULL, 1, 1, 1)");
  RunRecordMessage record = SampleRecord("b");
  record.result.result.progress = {{0.25, 5, 4000, 100}, {0.25, 0, 3000, 200}};
  { ResultsDatabase(file).Store(record); }
  const std::vector<StoredRun> runs = ReadSessions(file).sessions.at(0).runs;
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].progress, SampleRecord().result.result.progress);
  EXPECT_EQ(runs[1].progress, record.result.result.progress);
  SqliteConnection connection(file, SqliteConnection::Mode::kReadOnly);
  EXPECT_EQ(connection.QueryValue("SELECT count(*) FROM progress WHERE runid = 99"), Int(0));
  const SqliteValue schema_then = connection.QueryValue(kProgressSchema);
  EXPECT_EQ(schema_then, Query(kProgressSchema)) << "as of a new one";
}

TEST_F(ResultsDatabaseTest, ARunWithoutAnswerHasNoTimes) {
  database_.Store(UnansweredRecord());
  for (const char* column :
       {"time", "total_time", "setup_time", "simplification_time", "memory", "roundtrip_time",
        "path_length", "clearance", "referee_valid", "referee_reason", "mesh_valid",
        "simplified_valid", "cost", "epsilon", "edges_checked", "num_waypoints"}) {
    EXPECT_EQ(Run(column, "request-2"), kNull) << column;
  }
  EXPECT_EQ(Run("solved", "request-2"), Int(0));
  EXPECT_EQ(Run("status", "request-2"), Int(static_cast<int>(PlanStatus::kNoAnswer)));
  EXPECT_EQ(Run("message", "request-2"), SqliteValue("rrtc fell silent"));
  EXPECT_EQ(Run("time_limit", "request-2"), SqliteValue(30.0));
  EXPECT_EQ(Count("paths"), Int(0));
}

TEST_F(ResultsDatabaseTest, ACostOfNothingIsOneWhereItIsProven) {
  RunRecordMessage record = SampleRecord();
  record.result.result.cost = 0;
  record.result.result.epsilon = 1;
  database_.Store(record);
  EXPECT_EQ(Run("cost"), SqliteValue(0.0));
  EXPECT_EQ(Run("epsilon"), SqliteValue(1.0));
  record = SampleRecord("request-2");
  record.result.result.cost = record.result.result.epsilon = 0;
  database_.Store(record);
  EXPECT_EQ(Run("cost", "request-2"), kNull);
}

TEST_F(ResultsDatabaseTest, ARejectedPathIsNoSuccessButKept) {
  RunRecordMessage record = SampleRecord();
  record.status = PlanStatus::kInvalidPath;
  record.path_check.verdict->valid = false;
  record.path_check.verdict->reason = "gripper hits can";
  database_.Store(record);
  EXPECT_EQ(Run("solved"), Int(0));
  EXPECT_EQ(Run("referee_valid"), Int(0));
  EXPECT_EQ(Run("referee_reason"), SqliteValue("gripper hits can"));
  EXPECT_EQ(Run("time"), SqliteValue(0.25));
  EXPECT_EQ(Query("SELECT count(*) FROM paths WHERE kind = 'raw'"), Int(6));
}

TEST_F(ResultsDatabaseTest, WhatWasNotJudgedIsNull) {
  RunRecordMessage record = SampleRecord();
  record.path_check = {};
  record.path_check.message = "no scene";
  record.simplified_check.mesh_verdict.reset();
  database_.Store(record);
  EXPECT_EQ(Run("referee_valid"), kNull);
  EXPECT_EQ(Run("referee_reason"), SqliteValue("no scene"));
  EXPECT_EQ(Run("path_length"), kNull);
  EXPECT_EQ(Run("mesh_valid_simplified"), kNull);
}

TEST_F(ResultsDatabaseTest, WhatThePlannerDoesNotTellIsNull) {
  RunRecordMessage record = SampleRecord();
  record.result.result.phases = {};
  record.result.result.counters.clear();
  database_.Store(record);
  for (const char* column : {"setup_time", "collision_time", "guidance_time", "search_time",
                             "simplification_time", "edges_checked", "configurations_checked"}) {
    EXPECT_EQ(Run(column), kNull) << column;
  }
  EXPECT_EQ(Run("total_time"), SqliteValue(0.75));

  record = SampleRecord("without guidance");
  record.result.result.phases = {.search_s = 0.75};
  record.result.result.counters = {{"edges_checked", 0}};
  database_.Store(record);
  EXPECT_EQ(Run("guidance_time", "without guidance"), SqliteValue(0.0));
  EXPECT_EQ(Run("search_time", "without guidance"), SqliteValue(0.75));
  EXPECT_EQ(Run("simplification_time", "without guidance"), kNull);
  EXPECT_EQ(Run("edges_checked", "without guidance"), Int(0));
}

TEST_F(ResultsDatabaseTest, MeasuresAreNullIfInfiniteOrNotTaken) {
  RunRecordMessage record = SampleRecord();
  record.path_check.verdict->measures["clearance"] = std::numeric_limits<double>::infinity();
  record.simplified_check.verdict->measures.erase("clearance");
  database_.Store(record);
  EXPECT_EQ(Run("clearance"), kNull);
  EXPECT_EQ(Run("clearance_simplified"), kNull);
}

TEST_F(ResultsDatabaseTest, ARepeatedRecordIsStoredOnce) {
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kStored);
  const std::string before = DumpDatabase(file_);
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kAlreadyStored);
  EXPECT_EQ(DumpDatabase(file_), before);
  RunRecordMessage other_session = SampleRecord();
  other_session.run_id = "session-2";
  EXPECT_EQ(database_.Store(other_session), Outcome::kStored);
}

TEST_F(ResultsDatabaseTest, ARunThatWasNotAskedGivesWayToOneThatWas) {
  RunRecordMessage not_asked = UnansweredRecord("request-1");
  not_asked.message = "given up: it died";
  database_.Store(not_asked);
  RunRecordMessage not_asked_again = not_asked;
  not_asked_again.start_utime += 1;
  not_asked_again.message = "given up: it died again";
  EXPECT_EQ(database_.Store(not_asked_again), Outcome::kReplaced) << "the session was resumed";
  for (const RunRecordMessage& record : {not_asked, not_asked_again}) {
    EXPECT_EQ(database_.Store(record), Outcome::kAlreadyStored) << "as when a log is read anew";
    EXPECT_EQ(Run("message"), SqliteValue(not_asked_again.message));
  }
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kReplaced);
  EXPECT_EQ(Count("runs"), Int(1));
  EXPECT_EQ(Run("solved"), Int(1));
  EXPECT_EQ(Count("progress"), Int(2));
  const std::string before = DumpDatabase(file_);
  EXPECT_EQ(database_.Store(not_asked), Outcome::kAlreadyStored) << "as when a log is read anew";
  EXPECT_EQ(DumpDatabase(file_), before);
  RunRecordMessage crashed = not_asked;
  crashed.roundtrip_time_s = 0.5;
  EXPECT_EQ(database_.Store(crashed), Outcome::kContradicts);
}

TEST_F(ResultsDatabaseTest, ADisturbedRunGivesWayToItsRepeat) {
  std::vector<RunRecordMessage> attempts;
  for (int repeats = 0; repeats < 3; ++repeats) {
    RunRecordMessage record = SampleRecord();
    record.result.result.counters["disturbed"] = repeats < 2 ? 1 : 0;
    record.result.result.counters["repeats"] = repeats;
    attempts.push_back(record);
    EXPECT_EQ(database_.Store(record), repeats == 0 ? Outcome::kStored : Outcome::kReplaced);
    EXPECT_EQ(Count("runs"), Int(1));
    EXPECT_EQ(Count("progress"), Int(2));
  }
  for (const RunRecordMessage& record : attempts) {
    EXPECT_EQ(database_.Store(record), Outcome::kAlreadyStored) << "as when a log is read anew";
  }
  EXPECT_EQ(Run("repeats"), Int(2));
  RunRecordMessage other = attempts.back();
  other.result.result.planning_time_s /= 2;
  EXPECT_EQ(database_.Store(other), Outcome::kContradicts);
  other.result.result.counters["repeats"] = 3;
  EXPECT_EQ(database_.Store(other), Outcome::kContradicts) << "the last was not disturbed";
}

TEST_F(ResultsDatabaseTest, ADisturbedRunGivesWayToARepeatThatKilledThePlanner) {
  RunRecordMessage disturbed = SampleRecord();
  disturbed.result.result.counters["disturbed"] = 1;
  RunRecordMessage crashed = UnansweredRecord("request-1");
  crashed.roundtrip_time_s = 0.5;
  crashed.result.result.counters["repeats"] = 1;
  database_.Store(disturbed);
  EXPECT_EQ(database_.Store(crashed), Outcome::kReplaced);
  EXPECT_EQ(Run("solved"), Int(0));
}

TEST_F(ResultsDatabaseTest, ARunInWhichThePlannerCrashedStands) {
  RunRecordMessage crashed = UnansweredRecord("request-1");
  crashed.roundtrip_time_s = 0.5;
  database_.Store(crashed);
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kContradicts);
  EXPECT_EQ(Run("solved"), Int(0));
}

TEST_F(ResultsDatabaseTest, ARecordThatContradictsItselfLeavesNoTrace) {
  const std::string before = DumpDatabase(file_);
  RunRecordMessage record = SampleRecord();
  record.result.result.path[1].push_back(0.5);
  EXPECT_THROW(database_.Store(record), InputError);
  record = SampleRecord();
  record.result.joint_names = {"pan", "pan"};
  EXPECT_THROW(database_.Store(record), SqliteError);
  EXPECT_EQ(DumpDatabase(file_), before);
  EXPECT_EQ(database_.Store(SampleRecord()), Outcome::kStored);
}

TEST_F(ResultsDatabaseTest, PlannersAreToldApartByNameAndSettings) {
  RunRecordMessage record = SampleRecord("a");
  database_.Store(record);
  record = SampleRecord("b");
  database_.Store(record);
  EXPECT_EQ(Count("plannerConfigs"), Int(1));
  EXPECT_EQ(Query("SELECT settings FROM plannerConfigs"),
            SqliteValue("algorithm = ARA*\nplanner_class = search-and-sample\n"
                        "collision_model = voxels\nedge_check = certified\nedge_resolution = 0.05\n"
                        "epsilon = 5\nimprove = true\n"));
  record = SampleRecord("c");
  record.settings["improve"] = "false";
  database_.Store(record);
  record = SampleRecord("d");
  record.contestant = "ARA* (two-way)";
  database_.Store(record);
  record = SampleRecord("e");
  record.request.parameters = {};
  database_.Store(record);
  record = SampleRecord("f");
  record.request.edge_resolution_m = 0.02;
  database_.Store(record);
  EXPECT_EQ(Count("plannerConfigs"), Int(5));
  EXPECT_EQ(Query("SELECT name FROM plannerConfigs p JOIN runs r ON r.plannerid = p.id "
                  "WHERE request_id = 'd'"),
            SqliteValue("ARA* (two-way)"));
}

TEST_F(ResultsDatabaseTest, APlannerThatSamplesEdgesByItsOwnRuleHasNoResolutionOfTheRequest) {
  RunRecordMessage record = SampleRecord("a");
  record.request.edge_check = EdgeCheck::kFixed;
  record.settings["longest_valid_segment_fraction"] = "0.005";
  database_.Store(record);
  EXPECT_EQ(Run("edge_check", "a"), SqliteValue("fixed"));
  EXPECT_EQ(Run("edge_resolution", "a"), kNull);
  EXPECT_NE(std::get<std::string>(Query("SELECT settings FROM plannerConfigs"))
                .find("\nedge_resolution = own sampling: longest_valid_segment_fraction 0.005\n"),
            std::string::npos);
}

TEST_F(ResultsDatabaseTest, OnesWhoseResolutionAnOlderVersionStoredContradictsNothing) {
  RunRecordMessage record = SampleRecord();
  record.request.edge_check = EdgeCheck::kFixed;
  record.settings["longest_valid_segment_fraction"] = "0.005";
  database_.Store(record);
  SqliteConnection(file_, SqliteConnection::Mode::kReadWriteCreate)
      .Execute("UPDATE runs SET edge_resolution = 0.05");
  EXPECT_EQ(database_.Store(record), Outcome::kAlreadyStored);
  RunRecordMessage other = record;
  other.roundtrip_time_s += 1;
  EXPECT_EQ(database_.Store(other), Outcome::kContradicts);
  other = record;
  other.settings.erase("longest_valid_segment_fraction");
  other.request.edge_resolution_m = 0.02;
  EXPECT_EQ(database_.Store(other), Outcome::kContradicts);
  other.request.edge_resolution_m.reset();
  EXPECT_EQ(database_.Store(other), Outcome::kContradicts) << "no resolution is not any";
}

TEST_F(ResultsDatabaseTest, OneOfWhichAnOlderVersionStoredTheRequestsResolutionIsOnePlanner) {
  RunRecordMessage record = SampleRecord("a");
  record.request.edge_check = EdgeCheck::kFixed;
  record.settings["longest_valid_segment_fraction"] = "0.005";
  database_.Store(record);
  SqliteConnection(file_, SqliteConnection::Mode::kReadWriteCreate)
      .Execute(
          "UPDATE plannerConfigs SET settings = replace(settings, "
          "'own sampling: longest_valid_segment_fraction 0.005', '0.05')");
  record.request_id = "b";
  database_.Store(record);
  EXPECT_EQ(Count("plannerConfigs"), Int(1));
  record.request_id = "c";
  record.settings["longest_valid_segment_fraction"] = "0.01";
  database_.Store(record);
  EXPECT_EQ(Count("plannerConfigs"), Int(2));
}

TEST_F(ResultsDatabaseTest, SettingsThatAreOneNumberAreOnePlanners) {
  int number = 0;
  for (const char* epsilon : {"5", "5.0", "6"}) {
    RunRecordMessage record = SampleRecord(std::to_string(++number));
    record.request.parameters["epsilon"] = epsilon;
    database_.Store(record);
  }
  EXPECT_EQ(Query("SELECT group_concat(plannerid) FROM runs"), SqliteValue("1,1,2"));
}

TEST_F(ResultsDatabaseTest, OpenedAgainItKeepsWhatItHas) {
  const auto file = folder_ / "again.sqlite";
  {
    ResultsDatabase database(file);
    database.Store(SampleSession());
    database.Store(SampleRecord("a"));
  }
  EXPECT_FALSE(std::filesystem::exists(file.string() + "-wal"));  // one plain file
  ResultsDatabase database(file);
  EXPECT_EQ(database.Store(SampleRecord("a")), Outcome::kAlreadyStored);
  EXPECT_EQ(database.Store(SampleRecord("b")), Outcome::kStored);
  SqliteConnection reader(file, SqliteConnection::Mode::kReadOnly);
  EXPECT_EQ(reader.QueryValue("SELECT count(*) FROM runs"), Int(2));
  EXPECT_EQ(reader.QueryValue("SELECT count(*) FROM experiments"), Int(1));
}

TEST_F(ResultsDatabaseTest, EqualMessagesGiveEqualDatabases) {
  std::string dumps[2];
  for (std::string& dump : dumps) {
    const auto file = folder_ / ("equal" + std::to_string(&dump - dumps) + ".sqlite");
    {
      ResultsDatabase database(file);
      database.Store(SampleSession());
      database.Store(SampleRecord("a"));
      database.Store(UnansweredRecord("b"));
      database.Store(SampleRecord("a"));
      database.Store(FinishedSession());
    }
    dump = DumpDatabase(file);
  }
  EXPECT_EQ(dumps[0], dumps[1]);
  EXPECT_NE(dumps[0].find("RRT-Connect"), std::string::npos);  // not both empty
}

}  // namespace
}  // namespace planbench
