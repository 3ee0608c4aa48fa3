#pragma once

#include <filesystem>
#include <system_error>

namespace planbench {

/// Unlike the standard library's, these do not throw: what cannot be looked at, a name too long for
/// any file, say, is none.
inline bool IsFile(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}
inline bool IsFolder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

}  // namespace planbench
