#include "logger/results_database.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "common/error.h"
#include "logger/results_schema.h"
#include "logger/run_columns.h"
#include "logger/session_json.h"
#include "logger/utc_time.h"
#include "messaging/session_conditions.h"
#include "planning/asked_request.h"
#include "planning/told_edges.h"
#include "results/database_version.h"
#include "results/stored_session.h"

namespace planbench {
namespace {

SqliteConnection Open(const std::filesystem::path& file) {
  SqliteConnection connection(file, SqliteConnection::Mode::kReadWriteCreate);
  const auto not_ours = [&](const std::string& why) {
    return InputError(file.string() + " is no results database of this program: " + why);
  };
  SqliteValue tables;
  try {
    // A killed process leaves the file whole, a reader never blocks the writer, and a commit costs
    // no wait for the disk.
    connection.Execute(
        "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA foreign_keys = ON;");
    tables = connection.QueryValue("SELECT count(*) FROM sqlite_master");
  } catch (const SqliteError& error) {
    if (error.kind() == SqliteError::Kind::kBusy) throw;
    throw not_ours(error.what());
  }
  if (tables == SqliteValue(std::int64_t{0})) {
    SqliteTransaction transaction(&connection);
    connection.Execute(ResultsSchema());
    transaction.Commit();
  }
  const SqliteValue version = connection.QueryValue("PRAGMA user_version");
  if (version != SqliteValue(std::int64_t{kResultsSchemaVersion})) {
    throw not_ours(fmt::format("its user_version is {}, not {}", std::get<std::int64_t>(version),
                               kResultsSchemaVersion));
  }
  KeepEveryProgressEntry(&connection);
  return connection;
}

std::string InsertRunSql() {
  std::string names = "experimentid, plannerid";
  std::string values = "?, ?";
  for (const RunColumn& column : RunColumns()) {
    names += std::string(", ") + column.name;
    values += ", ?";
  }
  return fmt::format("INSERT INTO runs ({}) VALUES ({})", names, values);
}

/// Its parameters: the id, the values of the columns, the request's edge resolution.
std::string FindEqualRunSql() {
  std::string sql = "SELECT id FROM runs WHERE id = ?1";
  const std::size_t request_step = RunColumns().size() + 2;
  int parameter = 1;
  for (const RunColumn& column : RunColumns()) {
    sql += fmt::format(" AND ({} IS ?{}", column.name, ++parameter);
    // Of planners that sample edges by a rule of their own (planning/told_edges.h), databases of
    // before hold the request's.
    if (column.name == "edge_resolution") {
      sql += fmt::format(" OR {} IS ?{}", column.name, request_step);
    }
    sql += ')';
  }
  return sql;
}

std::string AsLines(const std::map<std::string, std::string>& settings) {
  std::string text;
  for (const auto& [key, value] : settings) text += fmt::format("{} = {}\n", key, value);
  return text;
}

/// What samples the edges: `edge_resolution` of plannerConfigs.settings.
std::string EdgeSampling(const ToldSampling& sampling) {
  std::vector<std::string> edges;
  if (sampling.resolution_m) edges.push_back(fmt::format("{}", *sampling.resolution_m));
  if (!sampling.own.empty()) edges.push_back("own sampling: " + sampling.own);
  if (edges.empty()) edges.emplace_back("the robot's");
  return fmt::format("{}", fmt::join(edges, ", "));
}

/// What sets contestants of one name apart: `settings` of plannerConfigs.
std::string PlannerSettings(const RunRecordMessage& record, const ToldSampling& sampling) {
  // Parameters of the request hold over the planner's own settings.
  std::map<std::string, std::string> settings = record.request.parameters;
  settings.insert(record.settings.begin(), record.settings.end());
  const PlanRequest& request = record.request;
  return fmt::format(
             "algorithm = {}\nplanner_class = {}\ncollision_model = {}\nedge_check = {}\n"
             "edge_resolution = {}\n",
             record.algorithm, record.planner_class, EnumName(request.collision_model),
             request.edge_check ? EnumName(*request.edge_check) : "the robot's",
             EdgeSampling(sampling)) +
         AsLines(settings);
}

/// Whether such settings are one contestant's: parts of a session may spell numbers otherwise.
bool IsSamePlanner(const std::string& first, const std::string& second) {
  const auto of_first = ParseSettings(first);
  const auto of_second = ParseSettings(second);
  return std::equal(of_first.begin(), of_first.end(), of_second.begin(), of_second.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && IsSameSetting(a.second, b.second);
                    });
}

/// What Planner Arena compares over time; it shows the last word.
std::string ExperimentVersion(const SessionMessage& session) {
  std::string version = "planbench " + session.version;
  if (!session.commit.empty()) version += "+" + session.commit;
  return version;
}

}  // namespace

ResultsDatabase::ResultsDatabase(const std::filesystem::path& file)
    : connection_(Open(file)),
      find_session_(connection_.Prepare(
          "SELECT start_utime, total_time, finished FROM sessions WHERE run_id = ?")),
      put_session_(connection_.Prepare(
          "INSERT OR REPLACE INTO sessions (run_id, start_utime, finished, total_time, num_runs, "
          "time_limit, version, hostname, cpuinfo, date, seed, setup, details) "
          "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")),
      update_experiments_(connection_.Prepare(
          "UPDATE experiments SET "
          "(totaltime, timelimit, version, hostname, cpuinfo, date, seed, setup) = "
          "(SELECT iif(finished, total_time, NULL), time_limit, version, hostname, cpuinfo, date, "
          "seed, setup FROM sessions WHERE run_id = ?1) "
          "WHERE id IN (SELECT experimentid FROM experiment_sessions WHERE run_id = ?1) "
          "AND EXISTS (SELECT 1 FROM sessions WHERE run_id = ?1)")),
      find_experiment_(connection_.Prepare("SELECT experimentid FROM experiment_sessions "
                                           "WHERE run_id = ? AND problem_set = ?")),
      insert_experiment_(connection_.Prepare(
          "INSERT INTO experiments (name, timelimit, memorylimit, runcount, version) "
          "VALUES (?, ?, 0, 0, 'planbench')")),
      insert_experiment_session_(
          connection_.Prepare("INSERT INTO experiment_sessions VALUES (?, ?, ?)")),
      count_run_(
          connection_.Prepare("UPDATE experiments SET runcount = max(runcount, ?2) WHERE id = ?1")),
      find_planner_(
          connection_.Prepare("SELECT id FROM plannerConfigs WHERE name = ? AND settings = ?")),
      find_planners_(connection_.Prepare(
          "SELECT id, settings FROM plannerConfigs WHERE name = ? ORDER BY id")),
      insert_planner_(
          connection_.Prepare("INSERT INTO plannerConfigs (name, settings) VALUES (?, ?)")),
      // The start as a number again, in us since the Unix epoch (IsoTime).
      find_run_(connection_.Prepare(
          "SELECT id, status, scene_id, roundtrip_time, "
          "strftime('%s', substr(start_time, 1, 19)) * 1000000 + substr(start_time, 21, 6), "
          "disturbed, repeats, experimentid, plannerid FROM runs "
          "WHERE run_id = ? AND request_id = ?")),
      find_equal_run_(connection_.Prepare(FindEqualRunSql())),
      delete_run_(connection_.Prepare("DELETE FROM runs WHERE id = ?")),
      insert_run_(connection_.Prepare(InsertRunSql())),
      insert_progress_(connection_.Prepare(
          "INSERT INTO progress (runid, time, epsilon, cost, expansions, best_cost) "
          "VALUES (?1, ?2, ?3, ?4, ?5, ?4)")),
      insert_counter_(connection_.Prepare("INSERT INTO counters VALUES (?, ?, ?)")),
      insert_position_(connection_.Prepare("INSERT INTO paths VALUES (?, ?, ?, ?, ?)")) {
  SqliteStatement count = connection_.Prepare(
      "SELECT experimentid, plannerid, count(*) FROM runs GROUP BY experimentid, plannerid");
  while (count.Step()) num_runs_[{count.Int(0), count.Int(1)}] = count.Int(2);
}

ResultsDatabase::~ResultsDatabase() {
  try {
    connection_.Execute("PRAGMA journal_mode = DELETE");
  } catch (const SqliteError& error) {
    // Another program still reads; SQLite keeps the log beside the file, and any reader finds it
    // there.
    spdlog::info("the write-ahead log stays: {}", error.what());
  }
}

void ResultsDatabase::Store(const SessionMessage& session) {
  SqliteTransaction transaction(&connection_);
  find_session_.BindAll(session.run_id);
  if (find_session_.Step()) {
    const auto known =
        std::make_tuple(find_session_.Int(0), find_session_.Double(1), find_session_.Int(2) != 0);
    find_session_.Reset();
    if (SessionOrder(session) < known) return;
  }
  const std::string setup = fmt::format("run_id = {}\nrobot = {} ({})\n", session.run_id,
                                        session.robot_name, session.conditions.request.robot_id) +
                            AsLines(session.settings);
  // Named, because texts must live until the statement has run.
  const std::string version = ExperimentVersion(session);
  const std::string date = IsoTime(session.start_utime);
  const std::string seed = std::to_string(session.conditions.request.seed);
  const std::string details = SessionJson(session);
  put_session_
      .BindAll(session.run_id, session.start_utime, session.finished ? 1 : 0, session.total_time_s,
               session.num_runs, session.conditions.request.time_limit_s, version, session.host,
               session.cpu, date, seed, setup, details)
      .Run();
  update_experiments_.BindAll(session.run_id).Run();
  transaction.Commit();
}

ResultsDatabase::Outcome ResultsDatabase::Store(const RunRecordMessage& record) {
  SqliteTransaction transaction(&connection_);
  std::vector<SqliteValue> values;  // until the statement has run
  for (const RunColumn& column : RunColumns()) values.push_back(column.value(record));
  const auto bind_columns = [&](SqliteStatement* statement, int parameter) {
    for (const SqliteValue& value : values) statement->Bind(++parameter, value);
  };
  const auto known = FindRun(record);
  if (known) {
    bind_columns(&find_equal_run_.BindAll(known->id), 1);
    const auto& request_step_m = record.request.edge_resolution_m;
    find_equal_run_.Bind(static_cast<int>(values.size()) + 2,
                         request_step_m ? SqliteValue(*request_step_m) : SqliteValue());
    if (find_equal_run_.First()) return Outcome::kAlreadyStored;
    const RunStanding standing = StandingOf(record);
    if (!Replaces(standing, known->standing)) {
      return Contradicts(standing, known->standing) ? Outcome::kContradicts
                                                    : Outcome::kAlreadyStored;
    }
    delete_run_.BindAll(known->id).Run();
  }
  const std::int64_t experiment = ExperimentId(record);
  const std::int64_t planner = PlannerId(record);
  bind_columns(&insert_run_.BindAll(experiment, planner), 2);
  insert_run_.Run();
  const std::int64_t run = connection_.LastInsertId();
  const RunGroup group(experiment, planner);
  const bool stays_in_group = known && known->group == group;
  const std::int64_t num_runs = num_runs_[group] + (stays_in_group ? 0 : 1);
  count_run_.BindAll(experiment, num_runs).Run();

  const PlanResult& result = record.result.result;
  InsertProgress(run, result);
  InsertCounters(run, result);
  InsertPath(run, "raw", result.path, record.result.joint_names);
  InsertPath(run, "simplified", result.simplified_path, record.result.joint_names);
  transaction.Commit();
  if (known) --num_runs_[known->group];
  ++num_runs_[group];
  return known ? Outcome::kReplaced : Outcome::kStored;
}

std::optional<ResultsDatabase::KnownRun> ResultsDatabase::FindRun(const RunRecordMessage& record) {
  find_run_.BindAll(record.run_id, record.request_id);
  if (!find_run_.Step()) return std::nullopt;
  const auto status = static_cast<PlanStatus>(find_run_.Int(1));
  const bool was_asked = TellsOfRequest(find_run_.Double(3), status, !find_run_.Text(2).empty());
  const KnownRun known = {
      find_run_.Int(0),
      {find_run_.Int(7), find_run_.Int(8)},
      {was_asked, find_run_.Int(4), find_run_.Int(5) != 0, static_cast<int>(find_run_.Int(6))}};
  find_run_.Reset();
  return known;
}

std::int64_t ResultsDatabase::ExperimentId(const RunRecordMessage& record) {
  if (const auto id = find_experiment_.BindAll(record.run_id, record.problem_set).First()) {
    return std::get<std::int64_t>(*id);
  }
  insert_experiment_.BindAll(record.problem_set, record.request.time_limit_s).Run();
  const std::int64_t id = connection_.LastInsertId();
  insert_experiment_session_.BindAll(id, record.run_id, record.problem_set).Run();
  update_experiments_.BindAll(record.run_id).Run();
  return id;
}

std::int64_t ResultsDatabase::PlannerId(const RunRecordMessage& record) {
  const PlanRequest& request = record.request;
  const std::string settings = PlannerSettings(
      record, SamplingOf(request.edge_check, request.edge_resolution_m, record.settings));
  if (const auto id = find_planner_.BindAll(record.contestant, settings).First()) {
    return std::get<std::int64_t>(*id);
  }
  // As databases of before have it, whatever samples its edges.
  const std::string settings_then = PlannerSettings(record, {request.edge_resolution_m, ""});
  find_planners_.BindAll(record.contestant);
  while (find_planners_.Step()) {
    const std::string known = find_planners_.Text(1);
    if (!IsSamePlanner(known, settings) && !IsSamePlanner(known, settings_then)) continue;
    const std::int64_t id = find_planners_.Int(0);
    find_planners_.Reset();
    return id;
  }
  insert_planner_.BindAll(record.contestant, settings).Run();
  return connection_.LastInsertId();
}

void ResultsDatabase::InsertProgress(std::int64_t run, const PlanResult& result) {
  for (const PlanProgress& progress : result.progress) {
    const SqliteValue epsilon =
        progress.epsilon == 0 ? SqliteValue() : SqliteValue(progress.epsilon);
    insert_progress_.BindAll(run, progress.elapsed_s, epsilon, progress.cost, progress.expansions)
        .Run();
  }
}

void ResultsDatabase::InsertCounters(std::int64_t run, const PlanResult& result) {
  for (const auto& [name, value] : result.counters) {
    insert_counter_.BindAll(run, name, value).Run();
  }
}

void ResultsDatabase::InsertPath(std::int64_t run, const char* kind, const Path& path,
                                 const std::vector<std::string>& joint_names) {
  for (std::size_t waypoint = 0; waypoint < path.size(); ++waypoint) {
    const Configuration& q = path[waypoint];
    if (q.size() != joint_names.size()) {
      throw InputError(fmt::format("waypoint {} of the {} path has {} positions for {} joint names",
                                   waypoint, kind, q.size(), joint_names.size()));
    }
    for (std::size_t joint = 0; joint < q.size(); ++joint) {
      insert_position_
          .BindAll(run, kind, static_cast<std::int64_t>(waypoint), joint_names[joint], q[joint])
          .Run();
    }
  }
}

std::vector<std::string> ResultsDatabase::Sessions() {
  std::vector<std::string> sessions;
  SqliteStatement statement =
      connection_.Prepare("SELECT details FROM sessions ORDER BY start_utime, run_id");
  while (statement.Step()) sessions.push_back(statement.Text(0));
  return sessions;
}

std::vector<IncompleteSession> ResultsDatabase::IncompleteSessions() {
  std::vector<IncompleteSession> sessions;
  SqliteStatement statement = connection_.Prepare(
      "SELECT run_id, finished, num_runs, (SELECT count(*) FROM runs WHERE runs.run_id = "
      "sessions.run_id) AS recorded FROM sessions WHERE recorded < num_runs ORDER BY start_utime, "
      "run_id");
  while (statement.Step()) {
    sessions.push_back(
        {statement.Text(0), statement.Int(1) != 0, statement.Int(2), statement.Int(3)});
  }
  return sessions;
}

}  // namespace planbench
