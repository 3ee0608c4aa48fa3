#pragma once

#include <filesystem>
#include <string_view>

namespace planbench {

/// Replaces a file; throws InputError that says why if it cannot be written.
void WriteFile(const std::filesystem::path& file, std::string_view text);

}  // namespace planbench
