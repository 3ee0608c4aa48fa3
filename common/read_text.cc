#include "common/read_text.h"

#include <fstream>
#include <iterator>

#include "common/error.h"
#include "common/file_kind.h"

namespace planbench {
namespace {

/// What a shell makes of <(command), or of a pipe that a program is given as its input: unlike that
/// of a pipe with a name, its writer is there.
bool IsPipeOfShell(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::string name = file.string();
  return (name.starts_with("/dev/") || name.starts_with("/proc/")) &&
         std::filesystem::is_fifo(file, ignored);
}

}  // namespace

std::string ReadText(const std::filesystem::path& file) {
  if (IsFolder(file)) throw InputError(file.string() + ": is a folder");
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !IsFile(file) && !IsPipeOfShell(file)) {
    throw InputError(file.string() + ": is no file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw InputError(file.string() + ": cannot be read");
  return text;
}

}  // namespace planbench
