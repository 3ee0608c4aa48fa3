#pragma once

#include <filesystem>
#include <string>

namespace planbench {

/// A folder of the test's own, removed at the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The whole text of a file; empty if there is none.
std::string ReadText(const std::filesystem::path& file);
void WriteText(const std::filesystem::path& file, const std::string& text);

/// The contents of every table of an SQLite database as text, to be compared.
std::string DumpDatabase(const std::filesystem::path& file);

}  // namespace planbench
