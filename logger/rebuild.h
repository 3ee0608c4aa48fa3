#pragma once

#include <filesystem>

#include "logger/logger_node.h"

namespace planbench {

/// Records the messages of an LCM event log as LoggerNode does those of a bus, as fast as they can
/// be written: the same messages make the same database. True if every run record could be stored.
/// Logs what of the log is passed over. Throws InputError if the log cannot be read or holds no
/// event, both before the folder is made, or if the folder cannot be used.
bool RebuildSession(const std::filesystem::path& event_log, const LoggerOptions& options);

}  // namespace planbench
