#include "common/write_file.h"

#include <fstream>

#include "common/error.h"

namespace planbench {

void WriteFile(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (!stream) throw InputError("cannot write " + file.string());
}

}  // namespace planbench
