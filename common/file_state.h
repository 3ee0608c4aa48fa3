#pragma once

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

namespace planbench {

/// Another text once a file has been written to or replaced, also where its time of modification
/// was kept: the time of its last change cannot be set. "" if there is none.
inline std::string FileState(const std::filesystem::path& file) {
  struct stat status = {};
  if (stat(file.c_str(), &status) != 0) return "";
  return fmt::format("{} {} {} {}.{:09}", status.st_dev, status.st_ino, status.st_size,
                     status.st_ctim.tv_sec, status.st_ctim.tv_nsec);
}

}  // namespace planbench
