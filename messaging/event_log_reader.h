#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "messaging/packet_reader.h"

namespace planbench {

/// Where the bytes of a message are in an event log.
struct EventPlace {
  std::shared_ptr<const std::filesystem::path> file;
  std::uint64_t offset = 0;
  std::size_t bytes = 0;
};

/// A message of an event log; `utime` is its event's.
struct LoggedMessage : ReceivedMessage {
  EventPlace place;
};

using VisitMessage = std::function<void(const LoggedMessage& message)>;

/// Reads the events of an LCM event log in order, all its files (EventLogFiles) if it was split.
/// Damage is no error, nor is a torn last event (of a logger
/// that was killed): every whole event is read. Returns what was passed over, a line for each file
/// that is damaged and one for each whose end was not read: how many bytes, and where. Throws
/// InputError if a file cannot be read.
std::vector<std::string> ReadEventLog(const std::filesystem::path& event_log,
                                      const VisitMessage& visit);

/// The bytes of a message that was there when the log was read; a log only grows. Throws InputError
/// if the file cannot be read, or has been shortened.
std::vector<std::uint8_t> ReadEventBytes(const EventPlace& place);

/// Whether there is a whole event in an event log, in any of its files: one that has none may be
/// anything. Throws like ReadEventLog.
bool HoldsEvent(const std::filesystem::path& event_log);

/// Whether a file begins as an event log does, be it cut off within its first event.
bool BeginsAsEventLog(const std::filesystem::path& file);

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
