#pragma once

#include <filesystem>
#include <string>

namespace planbench {

/// All that a file holds; throws InputError naming it if it cannot be read.
std::string ReadText(const std::filesystem::path& file);

}  // namespace planbench
