#pragma once

#include <filesystem>
#include <set>
#include <vector>

namespace planbench {

/// The folder of a session that is to begin, which is this driver's from now on: whoever makes
/// `logs` in it has it. What is made in it goes again, unless the session does begin: the same
/// command, mended, finds it as it was.
class NewSessionFolder {
 public:
  /// Makes the folder, and `logs` in it. Throws InputError naming it if it holds a session already,
  /// another driver's that begins at the same time included, or cannot be made or written.
  explicit NewSessionFolder(const std::filesystem::path& folder);
  /// Removes what was not there before, unless Keep was called. Parents that were made go if nobody
  /// else uses them; nothing goes while a logger writes to the folder.
  ~NewSessionFolder();
  NewSessionFolder(const NewSessionFolder&) = delete;
  NewSessionFolder& operator=(const NewSessionFolder&) = delete;

  void Keep() { keep_ = true; }

 private:
  void Claim();
  void RemoveFolders();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // those of the path that were missing, innermost first
  std::set<std::filesystem::path> before_;
  bool claimed_ = false;
  bool keep_ = false;
};

}  // namespace planbench
