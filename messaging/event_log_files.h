#pragma once

#include <filesystem>
#include <vector>

namespace planbench {

/// An event log that is split by size is several files, numbered as lcm-logger does: FILE, FILE.01,
/// FILE.02, ... This is the one of that number; 0: FILE itself.
std::filesystem::path EventLogFile(const std::filesystem::path& event_log, int number);

/// All files of an event log, in order, the first as given: FILE, or FILE.00 as lcm-logger begins.
/// One that is numbered otherwise, or that does not exist, stands for itself. Throws InputError
/// naming the first that is missing between them, or at their end: of the one log of a session
/// folder, run.json tells how many there are.
std::vector<std::filesystem::path> EventLogFiles(const std::filesystem::path& event_log);

}  // namespace planbench
