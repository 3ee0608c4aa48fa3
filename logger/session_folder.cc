#include "logger/session_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "common/error.h"
#include "logger/lcm_type_files.h"
#include "messaging/record_log.h"

namespace planbench {

namespace fs = std::filesystem;

namespace {

constexpr char kLockFile[] = "logger.lock";

}  // namespace

fs::path SessionFolder::AbsolutePath(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

SessionFolder::SessionFolder(const fs::path& folder, bool resume) : path_(AbsolutePath(folder)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) {
    throw InputError("cannot create session folder " + path_.string() + ": " + error.message());
  }
  Lock();
  const std::string session = path_.filename().string();
  event_log_ = path_ / ((session.empty() ? "session" : session) + ".lcmlog");
  try {
    // The folder may have been renamed.
    if (resume && !EventLogsIn(path_).empty()) event_log_ = FindEventLog(path_);
    for (const fs::path& file : {results(), event_log()}) {
      if (resume || !fs::exists(file)) continue;
      throw InputError("session folder " + path_.string() + " holds " + file.filename().string() +
                       " already; choose another folder, or pass --resume to add to it");
    }
    WriteLcmTypes();
  } catch (...) {
    close(lock_);
    throw;
  }
}

SessionFolder::~SessionFolder() { close(lock_); }

void SessionFolder::RequireThere() const {
  struct stat locked = {};
  struct stat there = {};
  if (fstat(lock_, &locked) == 0 && stat((path_ / kLockFile).c_str(), &there) == 0 &&
      locked.st_ino == there.st_ino && locked.st_dev == there.st_dev) {
    return;
  }
  throw std::runtime_error("session folder " + path_.string() +
                           " was removed or moved while it was written");
}

void SessionFolder::Lock() {
  const fs::path file = path_ / kLockFile;
  lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) {
    throw InputError("cannot write to session folder " + path_.string() + ": " +
                     std::strerror(errno));
  }
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const int why = errno;
    close(lock_);
    if (why != EWOULDBLOCK) {
      throw InputError("cannot lock " + file.string() + ": " + std::strerror(why));
    }
    std::string pid = "unknown";
    std::ifstream(file) >> pid;
    throw InputError("session folder " + path_.string() + " is in use by the logger with pid " +
                     pid + "; choose another folder or stop that logger");
  }
  const std::string pid = std::to_string(getpid()) + "\n";
  if (ftruncate(lock_, 0) != 0 ||
      write(lock_, pid.data(), pid.size()) != static_cast<ssize_t>(pid.size())) {
    const int why = errno;
    close(lock_);
    throw InputError("cannot write " + file.string() + ": " + std::strerror(why));
  }
}

void SessionFolder::WriteLcmTypes() const {
  const fs::path folder = path_ / "lcmtypes";
  std::error_code error;
  fs::create_directories(folder, error);
  for (const EmbeddedFile& type : LcmTypeFiles()) {
    std::ofstream stream(folder / type.name, std::ios::trunc);
    stream << type.text;
    stream.close();
    if (!stream) {
      throw InputError("cannot write " + (folder / type.name).string() + ": " +
                       std::strerror(errno));
    }
  }
}

}  // namespace planbench
