#include "benchmark_driver/log_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "common/error.h"

namespace planbench {

namespace fs = std::filesystem;

bool MakeLogFolder(const fs::path& session_folder) {
  std::error_code error;
  bool made = false;
  // Drivers whose sessions do not begin may take parents away that are empty yet.
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    made = fs::create_directories(session_folder / "logs", error);
    if (error != std::errc::no_such_file_or_directory) break;
  }
  if (error) {
    throw InputError("session folder " + session_folder.string() +
                     ": logs cannot be made in it: " + error.message());
  }
  return made;
}

void RequireWritableLogs(const fs::path& session_folder) {
  const fs::path file = session_folder / "logs" / "probe";
  std::ofstream stream(file);
  stream << std::string(65536, ' ');
  stream.close();
  const int why = errno;
  std::error_code ignored;
  fs::remove(file, ignored);
  if (!stream) {
    throw InputError("session folder " + session_folder.string() +
                     " cannot be written: " + std::strerror(why));
  }
}

}  // namespace planbench
