#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "messaging/messages.h"

namespace planbench {

/// The event log of a session folder: its only .lcmlog. Throws InputError if there is none, or
/// several.
std::filesystem::path EventLogOf(const std::filesystem::path& session_folder);

/// A session can be given more sets, problems, planners, directions or trials when it is resumed,
/// but what bears on a single run must stay: its tables would compare what is not alike. Throws
/// InputError naming the first setting (see DriverFlags::AsSettings) that differs.
void RequireSameConditions(const SessionMessage& earlier,
                           const std::map<std::string, std::string>& settings);

}  // namespace planbench
