#include "benchmark_driver/resume.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "benchmark_driver/logger_lock.h"
#include "common/error.h"
#include "common/lookup.h"
#include "messaging/session_conditions.h"
#include "results/reproduce.h"
#include "results/session_plan.h"
#include "results/shell_quoted.h"
#include "results/stored_ids.h"

namespace planbench {
namespace {

/// What reads something of the folder; its InputErrors tell for what.
template <typename Read>
auto ForResuming(const std::filesystem::path& session_folder, const Read& read) {
  try {
    return read(session_folder);
  } catch (const InputError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
}

/// Whether it is a launched session's folder in which the logger has not begun.
bool HoldsNoLogYet(const std::filesystem::path& folder) {
  return std::filesystem::is_directory(folder / "logs") && EventLogsIn(folder).empty();
}

/// Throws InputError if the database holds what the event log lacks (damaged, or cut off): it would
/// be made again, and the two would tell differently of it.
void RequireLogged(const StoredIds& stored, const RecordedSession& logged,
                   const std::filesystem::path& session_folder,
                   const std::filesystem::path& event_log) {
  const StoredIds lacking = stored.Without(logged.sessions, logged.runs);
  if (lacking.empty()) return;
  const std::filesystem::path folder =
      (std::filesystem::absolute(session_folder).lexically_normal() / "").parent_path();
  throw InputError(fmt::format(
      "--resume: results.sqlite in {} holds what its event log lacks: {}; to go on with what the "
      "log holds, resume the folder that this makes: logger --from {} --out {}",
      folder.string(), lacking.Text(), ShellQuoted((folder / event_log.filename()).string()),
      ShellQuoted(folder.string() + "-rebuilt")));
}

/// Throws InputError if both tell how the flag was given, and `is_same` of these is false.
template <typename IsSame>
void RequireSameFlag(const SessionMessage& before, const SessionMessage& now, const char* flag,
                     const IsSame& is_same) {
  const auto was = Lookup(before.settings, flag), is = Lookup(now.settings, flag);
  if (!was || !is || is_same(*was, *is)) return;
  const auto text = [flag](const std::string& value) {
    return value.empty() ? fmt::format("no --{}", flag) : fmt::format("--{} {}", flag, value);
  };
  throw InputError(fmt::format("--resume: the session was begun with {} and goes on with {} now",
                               text(*was), text(*is)));
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
  const StoredIds stored = ForResuming(session_folder, ReadStoredIds);
  if (HoldsNoLogYet(session_folder)) {
    if (stored.empty()) return {};
    throw InputError(
        fmt::format("--resume: results.sqlite in {} holds {}, but there is no event "
                    "log (.lcmlog), without which nothing goes on",
                    session_folder.string(), stored.Text()));
  }
  const std::filesystem::path event_log = ForResuming(session_folder, FindEventLog);
  RecordedSession recorded = ReadRecords(event_log);
  for (const std::string& line : recorded.passed_over) spdlog::warn("--resume: {}", line);
  RequireLogged(stored, recorded, session_folder, event_log);
  if (recorded.sessions.empty() && recorded.runs.empty()) return {};
  if (recorded.sessions.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no session");
  }
  const std::string run_id = recorded.sessions.back().run_id;
  std::erase_if(recorded.sessions, [&](const auto& session) { return session.run_id != run_id; });
  std::erase_if(recorded.runs, [&](const auto& run) { return run.run_id != run_id; });
  return {std::move(recorded.sessions), [runs = std::move(recorded.runs)](const VisitRun& visit) {
            for (const RecordedRun& run : runs) visit(ReadRecord(run.place));
          }};
}

void RequireSameConditions(const SessionMessage& before, const SessionMessage& now) {
  if (!IsMerged(before.settings)) {
    RequireSameFlag(before, now, kShardFlag, std::equal_to<>());
    // Which processors these are may be another machine's matter.
    RequireSameFlag(before, now, "pin", [](const std::string& was, const std::string& is) {
      return was.empty() == is.empty();
    });
  }
  const auto difference = FindConditionDifference(before, now);
  if (!difference) return;
  throw InputError(fmt::format("--resume: {} was {} when the session was begun and is {} now",
                               difference->field, difference->first, difference->second));
}

}  // namespace planbench
