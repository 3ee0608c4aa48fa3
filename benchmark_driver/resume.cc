#include "benchmark_driver/resume.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "benchmark_driver/logger_lock.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/sqlite.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"
#include "results/reproduce.h"
#include "results/session_plan.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

std::filesystem::path EventLogOf(const std::filesystem::path& session_folder) {
  try {
    return FindEventLog(session_folder);
  } catch (const InputError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
}

/// Whether it is a launched session's folder in which the logger has not begun.
bool HoldsNoLogYet(const std::filesystem::path& folder) {
  return std::filesystem::is_directory(folder / "logs") && EventLogsIn(folder).empty();
}

/// Ids of what the results database of a session folder holds.
struct StoredIds {
  std::vector<std::string> sessions;
  std::vector<std::string> runs;  ///< Request ids.

  bool empty() const { return sessions.empty() && runs.empty(); }
  /// E.g. "3 runs, the first of them run/box/1/ara/forward/1"; of sessions where it has no runs.
  std::string Text() const {
    if (runs.empty()) return "the session " + sessions.front();
    if (runs.size() == 1) return "1 run, " + runs.front();
    return fmt::format("{} runs, the first of them {}", runs.size(), runs.front());
  }
};

/// Nothing if there is no database, or no table in it yet. Throws InputError if it cannot be read.
StoredIds ReadStoredIds(const std::filesystem::path& database) {
  StoredIds stored;
  if (!IsFile(database)) return stored;
  try {
    SqliteConnection connection(database, SqliteConnection::Mode::kReadOnly);
    const auto read = [&](const char* sql, std::vector<std::string>* ids) {
      SqliteStatement select = connection.Prepare(sql);
      while (select.Step()) ids->push_back(select.Text(0));
    };
    std::vector<std::string> tables;
    read("SELECT name FROM sqlite_master WHERE name IN ('runs', 'sessions')", &tables);
    if (tables.size() < 2) return stored;
    read("SELECT run_id FROM sessions ORDER BY start_utime, run_id", &stored.sessions);
    // Those that other programs appended have no session.
    read("SELECT request_id FROM runs WHERE run_id IS NOT NULL ORDER BY id", &stored.runs);
  } catch (const SqliteError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
  return stored;
}

/// Throws InputError if the database holds what the event log lacks (damaged, or cut off): it would
/// be made again, and the two would tell differently of it.
void RequireLogged(StoredIds stored, const RecordedSession& logged,
                   const std::filesystem::path& session_folder,
                   const std::filesystem::path& event_log) {
  std::set<std::string> sessions, runs;
  for (const SessionMessage& session : logged.sessions) sessions.insert(session.run_id);
  for (const RunRecordMessage& run : logged.runs) runs.insert(run.request_id);
  std::erase_if(stored.sessions, [&](const std::string& id) { return sessions.contains(id); });
  std::erase_if(stored.runs, [&](const std::string& id) { return runs.contains(id); });
  if (stored.empty()) return;
  const std::filesystem::path folder = (session_folder.lexically_normal() / "").parent_path();
  throw InputError(fmt::format(
      "--resume: results.sqlite in {} holds what its event log lacks: {}; to go on with what the "
      "log holds, resume the folder that this makes: logger --from {} --out {}",
      folder.string(), stored.Text(), ShellQuoted(event_log.string()),
      ShellQuoted(folder.string() + "-rebuilt")));
}

std::string ShardText(const SessionMessage& session) {
  const std::string& shard = session.settings.at(kShardFlag);
  return shard.empty() ? "no --shard" : "--shard " + shard;
}

}  // namespace

void AwaitLoggersEnd(const std::filesystem::path& session_folder,
                     std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  std::optional<std::string> pid = LoggerWritingTo(session_folder);
  while (pid && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    pid = LoggerWritingTo(session_folder);
  }
  if (!pid) return;
  throw InputError("--resume: " + session_folder.string() + " is in use by the logger with pid " +
                   *pid);
}

EarlierSession ReadEarlierSession(const std::filesystem::path& session_folder) {
  // Before the log, to which a logger that lives may add meanwhile.
  StoredIds stored = ReadStoredIds(session_folder / "results.sqlite");
  if (HoldsNoLogYet(session_folder)) {
    if (stored.empty()) return {};
    throw InputError(
        fmt::format("--resume: results.sqlite in {} holds {}, but there is no event "
                    "log (.lcmlog), without which nothing goes on",
                    session_folder.string(), stored.Text()));
  }
  const std::filesystem::path event_log = EventLogOf(session_folder);
  RecordedSession recorded = ReadRecords(event_log);
  for (const std::string& line : recorded.passed_over) spdlog::warn("--resume: {}", line);
  RequireLogged(std::move(stored), recorded, session_folder, event_log);
  if (recorded.sessions.empty() && recorded.runs.empty()) return {};
  if (recorded.sessions.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no session");
  }
  const std::string run_id = recorded.sessions.back().run_id;
  std::erase_if(recorded.sessions, [&](const auto& session) { return session.run_id != run_id; });
  std::erase_if(recorded.runs, [&](const auto& run) { return run.run_id != run_id; });
  return {std::move(recorded.sessions), std::move(recorded.runs)};
}

void RequireSameConditions(const SessionMessage& before, const SessionMessage& now) {
  const bool both_tell = before.settings.contains(kShardFlag) && now.settings.contains(kShardFlag);
  const bool is_merged = before.settings.contains(kMergedCommands);
  if (both_tell && !is_merged && ShardText(before) != ShardText(now)) {
    throw InputError(fmt::format("--resume: the session was begun with {} and goes on with {} now",
                                 ShardText(before), ShardText(now)));
  }
  const auto difference = FindConditionDifference(before, now);
  if (!difference) return;
  throw InputError(fmt::format("--resume: {} was {} when the session was begun and is {} now",
                               difference->field, difference->first, difference->second));
}

}  // namespace planbench
