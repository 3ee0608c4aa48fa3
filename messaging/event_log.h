#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "messaging/packet_reader.h"

struct _lcm_eventlog_t;

namespace planbench {

/// An LCM event log open for writing, split by size into files (EventLogFiles) if wanted. Not
/// thread-safe.
class EventLog {
 public:
  enum class Mode {
    kNew,     ///< There must be no such file.
    kAppend,  ///< After the last whole event, if there is one; event numbers go on.
              ///< What a killed logger left of its last event is cut off, since it would swallow
              ///< the next ones. A file that is no event log is refused.
  };
  /// With `split_bytes`, no event is added to a file that has as many; the next one begins another,
  /// whose event numbers go on. Throws InputError if the file cannot be opened.
  EventLog(const std::filesystem::path& file, Mode mode,
           std::optional<std::uintmax_t> split_bytes = {});
  /// Closes the file; a failure is logged. Flush first to hear of it.
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// Throws std::runtime_error naming the file if it cannot be written.
  void Write(const ReceivedMessage& message);
  /// Hands everything written to the operating system. Throws like Write.
  void Flush();
  /// After a failure: opens the file again after its last whole event, as kAppend does. Throws
  /// InputError.
  void Reopen();

  int num_files() const { return number_ + 1; }

 private:
  /// The file that is written.
  std::filesystem::path Current() const;
  void BeginNextFile();
  [[noreturn]] void Fail() const;

  struct Close {
    void operator()(_lcm_eventlog_t* log) const;
  };
  std::filesystem::path file_;  ///< The first.
  std::optional<std::uintmax_t> split_bytes_;
  int number_ = 0;            ///< Of the current file.
  std::uintmax_t bytes_ = 0;  ///< Of it.
  std::unique_ptr<_lcm_eventlog_t, Close> log_;
};

}  // namespace planbench
