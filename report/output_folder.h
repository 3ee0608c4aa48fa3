#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace planbench {

/// Makes a folder for several files of a report, and removes what an earlier report has left there,
/// which nobody could tell from what this one writes: the files of whose names `is_of_report` says
/// that a report can write them, and no others. Throws InputError.
void PrepareFolder(const std::filesystem::path& folder,
                   const std::function<bool(const std::string& name)>& is_of_report);

}  // namespace planbench
