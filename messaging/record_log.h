#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "messaging/asked_runs.h"
#include "messaging/event_log_reader.h"
#include "messaging/messages.h"

namespace planbench {

/// A run of an event log. Its record, most of which is paths, stays there.
struct RecordedRun {
  std::string run_id;
  std::string request_id;
  RunStanding standing;
  EventPlace place;  ///< Of the record.
};

/// What a session's LCM event log holds of results.
struct RecordedSession {
  std::vector<SessionMessage> sessions;  ///< In order.
  std::vector<RecordedRun> runs;         ///< In order, one for each request_id (asked_runs.h).
  /// What was passed over: ReadEventLog's lines, and one for each channel of which messages could
  /// not be decoded: how many, and what is wrong with the first.
  std::vector<std::string> passed_over;
};

/// Reads which RUN_RECORD and SESSION messages an LCM event log holds. What is damaged, a torn last
/// event (of a logger that was killed) and messages that cannot be decoded are passed over, as the
/// logger passes over them. Throws InputError if the file cannot be read, or if no message of a
/// channel can be decoded: they are of another version.
RecordedSession ReadRecords(const std::filesystem::path& event_log);

/// The record there. Throws InputError if the log is no longer what it was.
RunRecordMessage ReadRecord(const EventPlace& place);

using VisitRun = std::function<void(const RunRecordMessage& run)>;
/// Has each of some runs visited, one after the other, so that none has to be held.
using EachRun = std::function<void(const VisitRun& visit)>;

/// What it tells last of the session of that run id; of one that it does not tell of, nothing.
SessionMessage LastTold(const RecordedSession& recorded, const std::string& run_id);

/// The scenes that an LCM event log holds, by content id. Adds to `passed_over` a line if
/// any could not be decoded; errors as above.
std::map<std::string, Scene> ReadScenes(const std::filesystem::path& event_log,
                                        std::vector<std::string>* passed_over);

/// The event logs that a folder holds.
std::vector<std::filesystem::path> EventLogsIn(const std::filesystem::path& folder);

/// The event log of a session folder; throws InputError if there is none, or several.
std::filesystem::path FindEventLog(const std::filesystem::path& session_folder);

}  // namespace planbench
