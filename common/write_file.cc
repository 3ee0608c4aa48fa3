#include "common/write_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <string>
#include <system_error>

#include "common/error.h"
#include "common/random_id.h"

namespace planbench {

namespace fs = std::filesystem;

namespace {

/// Why not all of it is in the file now, if it is not.
std::error_code Write(const fs::path& file, std::string_view text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (stream) return {};
  return {errno == 0 ? EIO : errno, std::generic_category()};
}

/// Beside the file, of a name that no other writer has, and none too long whatever the file's is.
fs::path NewFileBeside(const fs::path& file) {
  constexpr std::size_t kMostKept = 100;  // bytes
  const std::string begin = file.filename().string().substr(0, kMostKept);
  return file.parent_path() / fmt::format("{}.{}.part", begin, RandomId());
}

/// Whether another file may come in its place: in a folder that takes none it is written to, and
/// one that may not be written is not replaced either.
bool IsReplaceable(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && access(file.c_str(), W_OK) == 0 &&
         access(file.parent_path().c_str(), W_OK) == 0;
}

}  // namespace

void WriteFile(const fs::path& file, std::string_view text) {
  std::error_code error, ignored;
  const bool is_new = !fs::exists(fs::symlink_status(file, error));
  const fs::path place = is_new ? file : fs::canonical(file, error);  // "" of links to nothing
  if (is_new || IsReplaceable(place)) {
    const fs::path unfinished = NewFileBeside(place);
    error = Write(unfinished, text);
    const bool is_whole = !error;
    if (is_whole) {
      if (!is_new) fs::permissions(unfinished, fs::status(place, error).permissions(), error);
      fs::rename(unfinished, place, error);
    }
    if (error) fs::remove(unfinished, ignored);
    // Files that are mounted by themselves, as into containers, keep their place.
    if (error && is_whole) error = Write(place, text);
  } else {
    error = Write(file, text);
  }
  if (error) throw InputError(fmt::format("cannot write {}: {}", file.string(), error.message()));
}

}  // namespace planbench
