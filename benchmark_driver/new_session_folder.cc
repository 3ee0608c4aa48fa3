#include "benchmark_driver/new_session_folder.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <system_error>

#include "benchmark_driver/log_folder.h"
#include "benchmark_driver/logger_lock.h"
#include "common/error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> EntriesOf(const fs::path& folder, std::error_code* error) {
  std::set<fs::path> entries;
  fs::directory_iterator entry(folder, *error);
  for (; !*error && entry != fs::directory_iterator(); entry.increment(*error)) {
    entries.insert(entry->path());
  }
  return entries;
}

InputError HoldsSession(const fs::path& folder, const std::string& what) {
  return InputError("session folder " + folder.string() + " holds " + what +
                    " already; choose another folder (--out), or go on with that session "
                    "(--resume)");
}

void RemoveAll(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) spdlog::warn("{}: cannot be removed: {}", path.string(), error.message());
}

}  // namespace

NewSessionFolder::NewSessionFolder(const fs::path& folder) : folder_(folder) {
  std::error_code error;
  for (fs::path part = folder; part.has_relative_path() && !fs::exists(part, error);
       part = part.parent_path()) {
    made_.push_back(part);
  }
  try {
    Claim();
  } catch (...) {
    RemoveFolders();
    throw;
  }
}

NewSessionFolder::~NewSessionFolder() {
  if (keep_) return;
  if (const std::optional<std::string> pid = LoggerWritingTo(folder_)) {
    spdlog::warn("{} is left as it is: the logger with pid {} writes to it", folder_.string(),
                 *pid);
    return;
  }
  std::error_code ignored;  // a folder that has gone need not be removed
  for (const fs::path& entry : EntriesOf(folder_, &ignored)) {
    if (!before_.contains(entry)) RemoveAll(entry);
  }
  RemoveFolders();
}

void NewSessionFolder::Claim() {
  claimed_ = MakeLogFolder(folder_);
  if (!claimed_) throw HoldsSession(folder_, "logs");
  std::error_code error;
  before_ = EntriesOf(folder_, &error);
  if (error) {
    throw InputError("session folder " + folder_.string() + " cannot be read: " + error.message());
  }
  for (const fs::path& entry : before_) {
    if (entry.extension() == ".lcmlog" || entry.filename() == "results.sqlite") {
      throw HoldsSession(folder_, entry.filename().string());
    }
  }
  RequireWritableLogs(folder_);
}

void NewSessionFolder::RemoveFolders() {
  // Last of what the folder holds: from then on it is another driver's who makes it.
  if (claimed_) RemoveAll(folder_ / "logs");
  for (const fs::path& folder : made_) rmdir(folder.c_str());  // not those that others use
}

}  // namespace planbench
