#pragma once

#include <filesystem>
#include <string>

namespace planbench {

/// The folder that a logger writes a session into, locked for this process while the object lives.
class SessionFolder {
 public:
  /// Creates the folder, locks it and writes the message types into lcmtypes/. Throws InputError if
  /// it cannot be created or written, if another logger has it, or if it holds results already and
  /// `resume` is not set.
  SessionFolder(const std::filesystem::path& folder, bool resume);
  ~SessionFolder();
  SessionFolder(const SessionFolder&) = delete;
  SessionFolder& operator=(const SessionFolder&) = delete;

  /// `folder` from the root on, without a slash at its end.
  static std::filesystem::path AbsolutePath(const std::filesystem::path& folder);

  /// Throws std::runtime_error if the folder is no longer where it was: what is written to files
  /// that are open would be lost.
  void RequireThere() const;

  /// Absolute.
  const std::filesystem::path& path() const { return path_; }
  /// <session>.lcmlog, the session being the folder's name when it was begun.
  const std::filesystem::path& event_log() const { return event_log_; }
  std::filesystem::path results() const { return path_ / "results.sqlite"; }
  std::filesystem::path run_json() const { return path_ / "run.json"; }

 private:
  void Lock();
  void WriteLcmTypes() const;

  std::filesystem::path path_;
  std::filesystem::path event_log_;
  int lock_ = -1;
};

}  // namespace planbench
