#include "benchmark_driver/resume.h"

#include <fmt/format.h>

#include <string>

#include "common/error.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"

namespace planbench {
namespace {

std::filesystem::path EventLogOf(const std::filesystem::path& session_folder) {
  try {
    return FindEventLog(session_folder);
  } catch (const InputError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
}

}  // namespace

EarlierSession ReadEarlierSession(const std::filesystem::path& session_folder) {
  RecordedSession recorded = ReadRecords(EventLogOf(session_folder));
  if (recorded.sessions.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no session");
  }
  const std::string run_id = recorded.sessions.back().run_id;
  std::erase_if(recorded.sessions, [&](const auto& session) { return session.run_id != run_id; });
  std::erase_if(recorded.runs, [&](const auto& run) { return run.run_id != run_id; });
  return {std::move(recorded.sessions), std::move(recorded.runs)};
}

void RequireSameConditions(const SessionMessage& before, const SessionMessage& now) {
  const auto difference = FindConditionDifference(before, now);
  if (!difference) return;
  throw InputError(fmt::format("--resume: {} was {} when the session was begun and is {} now",
                               difference->field, difference->first, difference->second));
}

}  // namespace planbench
