#pragma once

#include <filesystem>
#include <functional>

#include "messaging/packet_reader.h"

namespace planbench {

/// Reads the events of an LCM event log in order, all its files (EventLogFiles) if it was split;
/// `utime` of a message is its event's. A torn last event (of a logger that was killed) is no
/// error. Throws InputError if a file cannot be read.
void ReadEventLog(const std::filesystem::path& event_log,
                  const std::function<void(const ReceivedMessage& message)>& visit);

}  // namespace planbench
