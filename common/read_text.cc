#include "common/read_text.h"

#include <fstream>
#include <iterator>

#include "common/error.h"
#include "common/file_kind.h"

namespace planbench {

std::string ReadText(const std::filesystem::path& file) {
  if (IsFolder(file)) throw InputError(file.string() + ": is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw InputError(file.string() + ": cannot be read");
  return text;
}

}  // namespace planbench
