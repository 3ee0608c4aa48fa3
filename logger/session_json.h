#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "messaging/bus.h"
#include "messaging/messages.h"

namespace planbench {

/// A session as a JSON object: versions, commit, host, CPU, the driver's flags, seed, robot, and
/// the nodes that took part with their settings. Holds nothing that changes with the moment the
/// message was sent.
std::string SessionJson(const SessionMessage& session);

/// What was odd on the bus as a JSON object; empty if nothing was.
std::string BusJson(const Bus::Counters& counters,
                    const std::vector<Contradictions::Entry>& contradictions);

/// Writes {"sessions": [...], "event_log_files": N, "bus": ...} of such objects (WriteFile). Throws
/// std::runtime_error, no InputError, naming the file.
void WriteRunJson(const std::filesystem::path& file, const std::vector<std::string>& sessions,
                  int num_event_log_files, const std::string& bus = "");

}  // namespace planbench
