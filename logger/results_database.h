#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sqlite.h"
#include "messaging/asked_runs.h"
#include "messaging/messages.h"

namespace planbench {

/// A session of which not all runs have come that it has by its last words.
struct IncompleteSession {
  std::string run_id;
  bool finished = false;
  std::int64_t num_runs = 0;
  std::int64_t num_recorded = 0;
};

/// results.sqlite, built from messages alone: equal messages in equal order give equal contents,
/// whether they come live or from a replay. docs/database.md describes the tables.
///
/// A call has either stored everything of its message or nothing, also if the process is killed
/// within it. Throws SqliteError where the database fails. Not thread-safe.
class ResultsDatabase {
 public:
  /// Opens the file or creates it. Throws InputError if it is no results database of this version.
  explicit ResultsDatabase(const std::filesystem::path& file);
  /// Leaves one plain file: what is in the write-ahead log is moved into it.
  ~ResultsDatabase();
  ResultsDatabase(const ResultsDatabase&) = delete;
  ResultsDatabase& operator=(const ResultsDatabase&) = delete;

  /// Stores a session or its later state, by SessionOrder: a late repetition changes nothing.
  void Store(const SessionMessage& session);

  enum class Outcome { kStored, kReplaced, kAlreadyStored, kContradicts };
  /// Stores a run, maybe in the place of another record of it. Of records with the same run_id and
  /// request_id the first that tells of a request counts, or, if none does, the one of the last
  /// attempt, and of a disturbed attempt and its repeats the last (asked_runs.h); others repeat or
  /// contradict it. Throws InputError for a record that contradicts itself.
  Outcome Store(const RunRecordMessage& record);

  /// SessionJson of every session, oldest first.
  std::vector<std::string> Sessions();
  std::vector<IncompleteSession> IncompleteSessions();

 private:
  /// Ids of an experiment and a planner.
  using RunGroup = std::pair<std::int64_t, std::int64_t>;
  struct KnownRun {
    std::int64_t id = 0;
    RunGroup group;
    RunStanding standing;
  };
  /// The run that is stored of the record's ids.
  std::optional<KnownRun> FindRun(const RunRecordMessage& record);
  std::int64_t ExperimentId(const RunRecordMessage& record);
  std::int64_t PlannerId(const RunRecordMessage& record);
  void InsertProgress(std::int64_t run, const PlanResult& result);
  void InsertCounters(std::int64_t run, const PlanResult& result);
  void InsertPath(std::int64_t run, const char* kind, const Path& path,
                  const std::vector<std::string>& joint_names);

  SqliteConnection connection_;
  SqliteStatement find_session_;
  SqliteStatement put_session_;
  SqliteStatement update_experiments_;
  SqliteStatement find_experiment_;
  SqliteStatement insert_experiment_;
  SqliteStatement insert_experiment_session_;
  SqliteStatement count_run_;
  SqliteStatement find_planner_;
  SqliteStatement find_planners_;
  SqliteStatement insert_planner_;
  SqliteStatement find_run_;
  SqliteStatement find_equal_run_;
  SqliteStatement delete_run_;
  SqliteStatement insert_run_;
  SqliteStatement insert_progress_;
  SqliteStatement insert_counter_;
  SqliteStatement insert_position_;
  /// Runs that are stored of each: to count them anew would take longer the more there are.
  std::map<RunGroup, std::int64_t> num_runs_;
};

}  // namespace planbench
