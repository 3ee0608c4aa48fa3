#include "common/write_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "common/error.h"

namespace planbench {

namespace fs = std::filesystem;

void WriteFile(const fs::path& file, std::string_view text) {
  std::error_code error;
  const fs::file_status before = fs::status(file, error);
  const bool is_new = !fs::exists(before);
  const fs::path place = is_new ? file : fs::canonical(file, error);
  const bool is_replaced = is_new || (fs::is_regular_file(before) && !place.empty());
  const fs::path written = is_replaced ? fs::path(place.string() + ".part") : file;
  errno = 0;
  std::ofstream stream(written, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  error.assign(stream ? 0 : errno, std::generic_category());
  if (stream && is_replaced) {
    if (!is_new) fs::permissions(written, before.permissions(), error);
    fs::rename(written, place, error);
  }
  if (stream && !error) return;
  std::error_code ignored;
  if (is_replaced) fs::remove(written, ignored);
  const std::string why = error ? fmt::format(": {}", error.message()) : "";
  throw InputError(fmt::format("cannot write {}{}", file.string(), why));
}

}  // namespace planbench
