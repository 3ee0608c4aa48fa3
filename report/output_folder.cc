#include "report/output_folder.h"

#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "common/error.h"
#include "common/scratch_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Of the files of a folder those whose names are such.
std::vector<fs::path> FilesIn(const fs::path& folder,
                              const std::function<bool(const std::string& name)>& is_such) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const fs::path& file = entries->path();
    std::error_code unknown;
    if (is_such(file.filename().string()) && !fs::is_directory(file, unknown)) {
      files.push_back(file);
    }
  }
  if (error) throw InputError("cannot read the folder " + folder.string() + ": " + error.message());
  return files;
}

}  // namespace

void ReplaceFiles(const fs::path& folder,
                  const std::function<bool(const std::string& name)>& is_of_report,
                  const std::function<void(const fs::path& new_folder)>& write) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
  const ScratchFolder unfinished(folder / ".unfinished-");
  write(unfinished.path());
  std::set<std::string> put;
  for (const fs::path& file : FilesIn(unfinished.path(), [](const auto&) { return true; })) {
    const fs::path place = folder / file.filename();
    fs::rename(file, place, error);
    if (error) throw InputError("cannot write " + place.string() + ": " + error.message());
    put.insert(file.filename().string());
  }
  const auto is_left = [&](const std::string& name) {
    return is_of_report(name) && !put.contains(name);
  };
  for (const fs::path& file : FilesIn(folder, is_left)) {
    fs::remove(file, error);
    if (error) throw InputError("cannot remove " + file.string() + ": " + error.message());
  }
}

}  // namespace planbench
