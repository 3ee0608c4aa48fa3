#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

#include "messaging/messages.h"
#include "messaging/record_log.h"

namespace planbench {

/// What a session folder holds of the session to go on with.
struct EarlierSession {
  std::vector<SessionMessage> sessions;  ///< Of each time it was begun or resumed.
  EachRun each_run = [](const VisitRun&) {};
};

/// Waits for the logger that still writes to the folder to end: that of a driver that was killed
/// stores what it has received. Throws InputError if it does not within `patience`.
void AwaitLoggersEnd(const std::filesystem::path& session_folder,
                     std::chrono::milliseconds patience = std::chrono::seconds(5));

/// Reads the last session of a folder's only .lcmlog; nothing if the folder is a session's whose
/// driver was killed before it had told of the session. Throws InputError if it is none, if there
/// are several logs, or if results.sqlite holds sessions or runs that the log lacks. The log must
/// stay as long as its runs are visited.
EarlierSession ReadEarlierSession(const std::filesystem::path& session_folder);

/// A session can be given more sets, problems, planners or trials when it is resumed, but nothing
/// else that can change a result (messaging/session_conditions.h): its tables would compare what is
/// not alike; nor, unless it was merged (of parts, be it one), another shard, as its parts would
/// not be the whole's, or planners that are pinned where they were not, or the reverse. Throws
/// InputError with the first field that differs, before and now.
void RequireSameConditions(const SessionMessage& before, const SessionMessage& now);

}  // namespace planbench
