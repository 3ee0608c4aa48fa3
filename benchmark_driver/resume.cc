#include "benchmark_driver/resume.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>
#include <string>
#include <thread>

#include "benchmark_driver/logger_lock.h"
#include "common/error.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"
#include "results/reproduce.h"
#include "results/shards.h"

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

std::string ShardText(const SessionMessage& session) {
  const auto shards = ShardsOf(session.settings);
  return shards.empty() ? "no --shard" : "--shard " + JoinShards(shards);
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
  if (HoldsNoLogYet(session_folder)) return {};
  RecordedSession recorded = ReadRecords(EventLogOf(session_folder));
  for (const std::string& line : recorded.passed_over) spdlog::warn("--resume: {}", line);
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
  if (both_tell && !is_merged && ShardsOf(before.settings) != ShardsOf(now.settings)) {
    throw InputError(fmt::format("--resume: the session was begun with {} and goes on with {} now",
                                 ShardText(before), ShardText(now)));
  }
  const auto difference = FindConditionDifference(before, now);
  if (!difference) return;
  throw InputError(fmt::format("--resume: {} was {} when the session was begun and is {} now",
                               difference->field, difference->first, difference->second));
}

}  // namespace planbench
