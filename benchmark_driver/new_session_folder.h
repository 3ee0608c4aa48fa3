#pragma once

#include <filesystem>
#include <set>

namespace planbench {

/// The folder of a session that is to begin. What is made in it goes again, unless the session does
/// begin: the same command, mended, finds it as it was.
class NewSessionFolder {
 public:
  /// Makes the folder, and `logs` in it. Throws InputError naming it if it holds a session already,
  /// or cannot be made or written.
  explicit NewSessionFolder(const std::filesystem::path& folder);
  /// Removes what was not there before, unless Keep was called.
  ~NewSessionFolder();
  NewSessionFolder(const NewSessionFolder&) = delete;
  NewSessionFolder& operator=(const NewSessionFolder&) = delete;

  void Keep() { keep_ = true; }

 private:
  void Remove();

  std::filesystem::path folder_;
  std::filesystem::path made_;  // the outermost folder that was made, if one was
  std::set<std::filesystem::path> before_;
  bool keep_ = false;
};

}  // namespace planbench
