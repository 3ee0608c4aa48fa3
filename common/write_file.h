#pragma once

#include <filesystem>
#include <string_view>

namespace planbench {

/// Replaces a file, or what a link leads to, once all of the text is on the disk, beside it until
/// then as FILE.part; what is no file, such as a pipe, is written to. Throws InputError that says
/// why if it cannot be written: then the file is what it was.
void WriteFile(const std::filesystem::path& file, std::string_view text);

}  // namespace planbench
