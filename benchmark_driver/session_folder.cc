#include "benchmark_driver/session_folder.h"

#include "common/error.h"

namespace planbench {

std::filesystem::path EventLogOf(const std::filesystem::path& session_folder) {
  if (!std::filesystem::is_directory(session_folder)) {
    throw InputError("--resume: " + session_folder.string() + " is no folder");
  }
  std::filesystem::path log;
  for (const auto& entry : std::filesystem::directory_iterator(session_folder)) {
    if (entry.path().extension() != ".lcmlog") continue;
    if (!log.empty()) {
      throw InputError("--resume: " + session_folder.string() + " holds several .lcmlog files");
    }
    log = entry.path();
  }
  if (log.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no .lcmlog file");
  }
  return log;
}

}  // namespace planbench
