#pragma once

#include <filesystem>
#include <string>

namespace planbench {

/// All that a file holds, or a pipe that a shell has made of <(command); throws InputError naming
/// it if it cannot be read, or is a folder, a device or a pipe with a name.
std::string ReadText(const std::filesystem::path& file);

}  // namespace planbench
