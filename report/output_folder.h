#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace planbench {

/// Puts all files that `write` writes, into the folder that it is given, into `folder`, which is
/// made if it is not there, in the place of an earlier report's, which nobody could tell from them:
/// files by whose names `is_of_report` says that a report can write them are removed, and no
/// others, once all that `write` wrote is in its place. Throws InputError if something cannot be
/// made, read, removed or put there.
void ReplaceFiles(const std::filesystem::path& folder,
                  const std::function<bool(const std::string& name)>& is_of_report,
                  const std::function<void(const std::filesystem::path& new_folder)>& write);

}  // namespace planbench
