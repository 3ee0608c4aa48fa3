#pragma once

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "common/error.h"
#include "common/file_kind.h"

namespace planbench {

/// The folder for what is temporary: $TMPDIR, else /tmp. Throws InputError naming it if it is none.
inline std::filesystem::path TemporaryFiles() {
  const char* told = std::getenv("TMPDIR");
  const std::filesystem::path folder = told == nullptr || *told == '\0' ? "/tmp" : told;
  if (IsFolder(folder)) return folder;
  throw InputError(
      fmt::format("TMPDIR: there is no folder '{}' for temporary files", folder.string()));
}

/// A new folder, removed with all it holds at the end.
class ScratchFolder {
 public:
  /// `beginning`: of its path, which characters that make it new follow; the folders it lies in are
  /// made. Throws InputError if it cannot be made.
  explicit ScratchFolder(const std::filesystem::path& beginning) {
    std::error_code error;
    std::filesystem::create_directories(beginning.parent_path(), error);
    std::string pattern = beginning.string() + "XXXXXX";
    if (error || mkdtemp(pattern.data()) == nullptr) {
      throw InputError(fmt::format("cannot make a folder {}...: {}", beginning.string(),
                                   error ? error.message() : std::strerror(errno)));
    }
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;  // what cannot be removed is left to the system's own clearing
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace planbench
