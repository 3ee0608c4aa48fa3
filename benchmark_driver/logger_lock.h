#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace planbench {

/// The pid of the logger that has the session folder at this moment, "unknown" if it does not say;
/// nothing if none has it.
std::optional<std::string> LoggerWritingTo(const std::filesystem::path& session_folder);

}  // namespace planbench
