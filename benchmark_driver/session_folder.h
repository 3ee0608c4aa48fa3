#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "messaging/record_log.h"

namespace planbench {

/// The event log of a session folder: its only .lcmlog. Throws InputError if there is none, or
/// several.
std::filesystem::path EventLogOf(const std::filesystem::path& session_folder);

}  // namespace planbench
