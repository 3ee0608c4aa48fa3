#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "common/scratch_folder.h"

namespace planbench {

/// A folder of its own for a test.
class TemporaryFolder : public ScratchFolder {
 public:
  TemporaryFolder() : ScratchFolder(std::filesystem::temp_directory_path() / "planbench_test_") {}

  std::filesystem::path operator/(const std::string& name) const { return path() / name; }

  /// Writes a file below the folder, with the folders it needs; returns its path.
  std::filesystem::path Write(const std::string& name, std::string_view content) const {
    const std::filesystem::path file = path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream << content;
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
    return file;
  }
};

}  // namespace planbench
