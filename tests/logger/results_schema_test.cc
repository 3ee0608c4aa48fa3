#include "logger/results_schema.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "logger/results_database.h"
#include "logger/run_columns.h"
#include "session_files.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Mode = SqliteConnection::Mode;

class ResultsSchemaTest : public testing::Test {
 protected:
  ResultsSchemaTest() : file_(folder_ / "results.sqlite") { ResultsDatabase database(file_); }

  /// "name TYPE" of every column that PRAGMA table_info shows.
  std::vector<std::string> Columns(const std::string& table) {
    SqliteConnection connection(file_, Mode::kReadOnly);
    SqliteStatement info = connection.Prepare("PRAGMA table_info(" + table + ")");
    std::vector<std::string> columns;
    while (info.Step()) columns.push_back(info.Text(1) + " " + info.Text(2));
    return columns;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_;
};

// What ompl_benchmark_statistics.py creates. Planner Arena takes further columns of `experiments`
// for parameters of the problem; the importer fills plannerConfigs and enums by position.
TEST_F(ResultsSchemaTest, TablesOfOmplAreAsOmplsToolsMakeThem) {
  EXPECT_THAT(Columns("experiments"),
              ElementsAre("id INTEGER", "name VARCHAR(512)", "totaltime REAL", "timelimit REAL",
                          "memorylimit REAL", "runcount INTEGER", "version VARCHAR(128)",
                          "hostname VARCHAR(1024)", "cpuinfo TEXT", "date DATETIME",
                          "seed VARCHAR(24)", "setup TEXT"));
  EXPECT_THAT(Columns("plannerConfigs"),
              ElementsAre("id INTEGER", "name VARCHAR(512)", "settings TEXT"));
  EXPECT_THAT(Columns("enums"),
              ElementsAre("name VARCHAR(512)", "value INTEGER", "description TEXT"));
  const std::vector<std::string> runs = Columns("runs");
  ASSERT_GT(runs.size(), 7);
  EXPECT_THAT(std::vector<std::string>(runs.begin(), runs.begin() + 7),
              ElementsAre("id INTEGER", "experimentid INTEGER", "plannerid INTEGER", "time REAL",
                          "memory REAL", "solved BOOLEAN", "status ENUM"));
  EXPECT_THAT(Columns("progress"),
              ElementsAre("runid INTEGER", "time REAL", "epsilon REAL", "cost REAL",
                          "expansions INTEGER", "best_cost REAL"));
}

TEST_F(ResultsSchemaTest, RowsOfOmplsImporterFitIn) {
  SqliteConnection connection(file_, Mode::kReadWriteCreate);
  connection.Execute("PRAGMA FOREIGN_KEYS = ON");
  connection.Execute("INSERT INTO experiments (name, totaltime) VALUES ('theirs', 1)");
  connection.Execute("INSERT INTO plannerConfigs VALUES (NULL, 'geometric_RRT', 'range = 1')");
  connection.Execute(
      "INSERT INTO runs (experimentid, plannerid, time, solved) VALUES (1, 1, 2, 1)");
  connection.Execute(
      "INSERT INTO runs (experimentid, plannerid, time, solved) VALUES (1, 1, 3, 1)");
  connection.Execute("INSERT INTO progress (runid, time, best_cost) VALUES (1, 0.5, 9)");
  connection.Execute("DELETE FROM experiments");
  EXPECT_EQ(connection.QueryValue("SELECT (SELECT count(*) FROM runs) + "
                                  "(SELECT count(*) FROM progress)"),
            SqliteValue(std::int64_t{0}));
}

// readBenchmarkLog of ompl_benchmark_statistics.py adds the columns that table_info does not show.
TEST_F(ResultsSchemaTest, NoColumnIsHiddenFromOmplsImporter) {
  SqliteConnection connection(file_, Mode::kReadOnly);
  for (const char* table : {"runs", "progress", "experiments", "plannerConfigs", "enums"}) {
    const auto count = [&](const char* pragma) {
      return connection.QueryValue(
          fmt::format("SELECT group_concat(name) FROM {}('{}')", pragma, table));
    };
    EXPECT_EQ(count("pragma_table_info"), count("pragma_table_xinfo")) << table;
  }
  for (const char* column : {"solution length", "solution segments", "correct solution",
                             "simplified solution clearance", "solution smoothness"}) {
    std::string name = column;
    std::replace(name.begin(), name.end(), ' ', '_');
    EXPECT_EQ(connection.QueryValue(
                  "SELECT count(*) FROM pragma_table_info('runs') WHERE name = '" + name + "'"),
              SqliteValue(std::int64_t{1}))
        << name;
  }
}

TEST_F(ResultsSchemaTest, StatusesAreNamedInEnums) {
  SqliteConnection connection(file_, Mode::kReadOnly);
  SqliteStatement rows =
      connection.Prepare("SELECT value, description FROM enums WHERE name = 'status'");
  int count = 0;
  for (; rows.Step(); ++count) {
    EXPECT_EQ(rows.Text(1), EnumName(static_cast<PlanStatus>(rows.Int(0))));
  }
  EXPECT_EQ(count, kNumEnumValues<PlanStatus>);
}

TEST_F(ResultsSchemaTest, EveryColumnIsDocumented) {
  const std::string docs =
      TextOf(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "docs" / "database.md");
  for (const RunColumn& column : RunColumns()) {
    EXPECT_THAT(docs, HasSubstr(std::string("`") + column.name + "`"));
  }
}

TEST_F(ResultsSchemaTest, RefusesAFileThatIsNoDatabase) {
  WriteText(folder_ / "text.sqlite", std::string(5000, 'x'));
  EXPECT_THROW(ResultsDatabase(folder_ / "text.sqlite"), InputError);
}

TEST_F(ResultsSchemaTest, RefusesADatabaseOfAnotherKindOrVersion) {
  {
    SqliteConnection other(folder_ / "other.sqlite", Mode::kReadWriteCreate);
    other.Execute("CREATE TABLE things (id INTEGER)");
  }
  EXPECT_THROW(ResultsDatabase(folder_ / "other.sqlite"), InputError);
  SqliteConnection(file_, Mode::kReadWriteCreate).Execute("PRAGMA user_version = 99");
  try {
    ResultsDatabase database(file_);
    FAIL() << "version 99 was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("results.sqlite"));
    EXPECT_THAT(error.what(), HasSubstr("99"));
  }
}

}  // namespace
}  // namespace planbench
