#include "benchmark_driver/new_session_folder.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "common/error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Throws InputError unless a little can be written there: what a full disk does to the processes
/// that write there could not be told from their logs.
void RequireWritable(const fs::path& folder) {
  const fs::path file = folder / "probe";
  std::ofstream stream(file);
  stream << std::string(65536, ' ');
  stream.close();
  const int why = errno;
  std::error_code ignored;
  fs::remove(file, ignored);
  if (!stream) {
    throw InputError("session folder " + folder.parent_path().string() +
                     " cannot be written: " + std::strerror(why));
  }
}

}  // namespace

NewSessionFolder::NewSessionFolder(const fs::path& folder) : folder_(folder) {
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      before_.insert(entry.path());
      if (entry.path().extension() == ".lcmlog" || entry.path().filename() == "results.sqlite") {
        throw InputError("session folder " + folder.string() + " holds " +
                         entry.path().filename().string() +
                         " already; choose another folder (--out), or go on with that session "
                         "(--resume)");
      }
    }
  }
  for (fs::path part = folder; !fs::exists(part); part = part.parent_path()) made_ = part;
  try {
    std::error_code error;
    fs::create_directories(folder / "logs", error);
    if (error) {
      throw InputError("session folder " + folder.string() + " cannot be made: " + error.message());
    }
    RequireWritable(folder / "logs");
  } catch (...) {
    Remove();
    throw;
  }
}

NewSessionFolder::~NewSessionFolder() {
  if (!keep_) Remove();
}

void NewSessionFolder::Remove() {
  std::error_code error;
  if (!made_.empty()) {
    fs::remove_all(made_, error);
  } else {
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder_, error)) entries.push_back(entry);
    for (const fs::path& entry : entries) {
      if (!before_.contains(entry)) fs::remove_all(entry, error);
    }
  }
  if (error) spdlog::warn("{}: cannot be removed: {}", folder_.string(), error.message());
}

}  // namespace planbench
