#include "benchmark_driver/logger_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

namespace planbench {

std::optional<std::string> LoggerWritingTo(const std::filesystem::path& session_folder) {
  const std::string file = (session_folder / "logger.lock").string();
  const int lock = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (lock < 0) return std::nullopt;
  // Shared: over NFS an exclusive lock is for those who may write.
  const bool held = flock(lock, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(lock);
  if (!held) return std::nullopt;
  std::string pid = "unknown";
  std::ifstream(file) >> pid;
  return pid;
}

}  // namespace planbench
