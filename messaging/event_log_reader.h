#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "messaging/packet_reader.h"

namespace planbench {

using VisitMessage = std::function<void(const ReceivedMessage& message)>;

/// Reads the events of an LCM event log in order, all its files (EventLogFiles) if it was split;
/// `utime` of a message is its event's. A torn last event (of a logger that was killed) is no
/// error: returns a line for each file whose end was not read, saying how much that is. Throws
/// InputError if a file cannot be read.
std::vector<std::string> ReadEventLog(const std::filesystem::path& event_log,
                                      const VisitMessage& visit);

/// How far a file of an event log could be read.
struct EventLogExtent {
  std::int64_t next_number = 0;  ///< Of the event that comes next.
  std::uintmax_t bytes = 0;      ///< Up to the end of the last whole event.
};
/// Reads the events of that file alone, as above.
EventLogExtent ReadEventLogFile(const std::filesystem::path& file, const VisitMessage& visit);

}  // namespace planbench
