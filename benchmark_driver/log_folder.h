#pragma once

#include <filesystem>

namespace planbench {

/// Makes `logs` in a session folder, which takes what the launched processes say, and the folder
/// itself. True if it was not there: of drivers that want it at the same time one is told so.
/// Throws InputError naming the session folder if it cannot be made.
bool MakeLogFolder(const std::filesystem::path& session_folder);

/// Throws InputError naming the session folder unless a little can be written to its `logs`: what a
/// full disk does to the processes that write there could not be told from their logs.
void RequireWritableLogs(const std::filesystem::path& session_folder);

}  // namespace planbench
