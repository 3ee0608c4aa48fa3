#include "logger/results_schema.h"

#include <fmt/format.h>

#include <cstdint>

#include "logger/run_columns.h"
#include "planning/plan_status.h"
#include "results/database_version.h"

namespace planbench {
namespace {

// Planner Arena takes every column of `experiments` after the twelfth for a parameter of the
// problem, and OMPL's importer fills `plannerConfigs` and `enums` by position: our own facts stand
// in tables of their own. It also appends rows to `runs` that know nothing of our columns, so these
// may all be NULL, and adds the columns that PRAGMA table_info does not show, so that none may be
// generated.
constexpr char kOmplTables[] = R"sql(
CREATE TABLE experiments (
  id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512),
  totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER,
  version VARCHAR(128), hostname VARCHAR(1024), cpuinfo TEXT,
  date DATETIME, seed VARCHAR(24), setup TEXT);
CREATE TABLE plannerConfigs (
  id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL, settings TEXT);
CREATE TABLE enums (
  name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
)sql";

constexpr char kRunsKeys[] = R"sql(
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE,
  UNIQUE (run_id, request_id));
CREATE INDEX runs_by_experiment ON runs (experimentid, plannerid);
CREATE INDEX runs_by_problem ON runs (problem_set, problem_index);
)sql";

// Planner Arena cannot do without progress.best_cost, and draws every further column. There is no
// key: of several entries at one reading of the clock all are kept, in the order of their rowid.
constexpr char kProgressTable[] = R"sql(
CREATE TABLE progress (
  runid INTEGER, time REAL, epsilon REAL, cost REAL, expansions INTEGER,
  best_cost REAL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE INDEX progress_by_run ON progress (runid, time);
)sql";

constexpr char kOtherTables[] = R"sql(
CREATE TABLE counters (
  runid INTEGER, name TEXT, value REAL,
  PRIMARY KEY (runid, name),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE) WITHOUT ROWID;
CREATE TABLE paths (
  runid INTEGER, kind TEXT CHECK (kind IN ('raw', 'simplified')), waypoint INTEGER, joint TEXT,
  position REAL,
  PRIMARY KEY (runid, kind, waypoint, joint),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE) WITHOUT ROWID;
CREATE TABLE sessions (
  run_id TEXT PRIMARY KEY, start_utime INTEGER, finished BOOLEAN, total_time REAL,
  num_runs INTEGER, time_limit REAL, version TEXT, hostname TEXT, cpuinfo TEXT, date TEXT,
  seed TEXT, setup TEXT, details TEXT);
CREATE TABLE experiment_sessions (
  experimentid INTEGER PRIMARY KEY, run_id TEXT, problem_set TEXT,
  UNIQUE (run_id, problem_set),
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE);
)sql";

}  // namespace

std::string ResultsSchema() {
  std::string sql = kOmplTables;
  for (int i = 0; i < kNumEnumValues<PlanStatus>; ++i) {
    sql += fmt::format("INSERT INTO enums VALUES ('status', {}, '{}');\n", i,
                       EnumName(static_cast<PlanStatus>(i)));
  }
  sql +=
      "CREATE TABLE runs (\n"
      "  id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid INTEGER,\n";
  for (const RunColumn& column : RunColumns()) {
    sql += fmt::format("  {} {},\n", column.name, column.type);
  }
  sql += kRunsKeys;
  sql += kProgressTable;
  sql += kOtherTables;
  sql += fmt::format("PRAGMA user_version = {};\n", kResultsSchemaVersion);
  return sql;
}

void KeepEveryProgressEntry(SqliteConnection* connection) {
  if (connection->QueryValue("SELECT count(*) FROM pragma_table_info('progress') WHERE pk > 0") ==
      SqliteValue(std::int64_t{0})) {
    return;
  }
  SqliteTransaction transaction(connection);
  connection->Execute("ALTER TABLE progress RENAME TO progress_by_time");
  connection->Execute(kProgressTable);
  // Entries of runs that are gone, deleted by a program that minds no foreign keys, are no one's.
  connection->Execute(
      "INSERT INTO progress SELECT runid, time, epsilon, cost, expansions, best_cost "
      "FROM progress_by_time WHERE runid IN (SELECT id FROM runs) ORDER BY runid, time; "
      "DROP TABLE progress_by_time");
  transaction.Commit();
}

}  // namespace planbench
