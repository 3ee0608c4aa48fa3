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
/// `utime` of a message is its event's. Damage is no error, nor is a torn last event (of a logger
/// that was killed): every whole event is read. Returns what was passed over, a line for each file
/// that is damaged and one for each whose end was not read: how many bytes, and where. Throws
/// InputError if a file cannot be read.
std::vector<std::string> ReadEventLog(const std::filesystem::path& event_log,
                                      const VisitMessage& visit);

/// Whether there is a whole event in an event log, in any of its files: one that has none may be
/// anything. Throws like ReadEventLog.
bool HoldsEvent(const std::filesystem::path& event_log);

/// What could be read of a file of an event log. Offsets and sizes are in bytes.
struct EventLogExtent {
  std::int64_t next_number = 0;  ///< Of the event that comes next.
  std::uintmax_t bytes = 0;      ///< Up to the end of the last whole event.
  int num_damaged = 0;           ///< Places before that where there is no whole event.
  std::uintmax_t first_damaged = 0;
  std::uintmax_t damaged_bytes = 0;  ///< Of all these places.
};
/// Reads the events of that file alone, as above.
EventLogExtent ReadEventLogFile(const std::filesystem::path& file, const VisitMessage& visit);

}  // namespace planbench
