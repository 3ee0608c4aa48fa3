#pragma once

#include <filesystem>
#include <string_view>

namespace planbench {

/// Replaces a file, or what a link leads to, once all of the text is written, beside it until then
/// as FILE.ID.part, where ID is random. What is no file, such as a pipe, and a file that cannot be
/// replaced, be it for its folder, is written to. Throws InputError that says why if it cannot be
/// written: then the file is what it was, if it could be replaced.
void WriteFile(const std::filesystem::path& file, std::string_view text);

}  // namespace planbench
