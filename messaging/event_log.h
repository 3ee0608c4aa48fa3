#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "messaging/packet_reader.h"

struct _lcm_eventlog_t;

namespace planbench {

/// An LCM event log open for writing. Not thread-safe.
class EventLog {
 public:
  enum class Mode {
    kNew,     ///< There must be no such file.
    kAppend,  ///< After the last whole event of the file, if there is one; event numbers go on.
              ///< What a killed logger left of its last event is cut off, since it would swallow
              ///< the next ones.
  };
  /// Throws InputError if the file cannot be opened.
  EventLog(const std::filesystem::path& file, Mode mode);
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

 private:
  [[noreturn]] void Fail() const;

  struct Close {
    void operator()(_lcm_eventlog_t* log) const;
  };
  std::filesystem::path file_;
  std::unique_ptr<_lcm_eventlog_t, Close> log_;
};

}  // namespace planbench
