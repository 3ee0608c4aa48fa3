#include "common/write_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "common/error.h"

namespace planbench {

void WriteFile(const std::filesystem::path& file, std::string_view text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (stream) return;
  const int why = errno;
  throw InputError("cannot write " + file.string() +
                   (why == 0 ? "" : ": " + std::string(std::strerror(why))));
}

}  // namespace planbench
