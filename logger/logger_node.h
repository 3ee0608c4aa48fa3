#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "logger/message_queue.h"
#include "logger/session_recorder.h"
#include "messaging/bus.h"
#include "messaging/node_announcer.h"
#include "messaging/node_registry.h"

namespace planbench {

struct LoggerOptions {
  std::filesystem::path out;  ///< Session folder.
  std::string name = "logger";
  bool resume = false;  ///< Add to a folder that holds results already.
  /// Size from which on a file of the event log is followed by another one; none: never.
  std::optional<std::uintmax_t> split_bytes = std::uintmax_t{1} << 30;
  /// Memory for messages that wait to be written.
  std::size_t queue_bytes = std::size_t{512} << 20;
};

/// The logger as a process on the bus: the bus thread copies every message into a bounded queue, a
/// thread of its own records them. While that fails (disk full) its status tells the trouble, and
/// it is tried again; nothing is acknowledged meanwhile.
///
/// Sessions and run records are taken from the driver that is live, if one is. Those of others go
/// into the event log under another channel, where no reader takes them for what they claim to be.
class LoggerNode {
 public:
  /// Goes live. Throws InputError if the name is none or the folder cannot be used.
  LoggerNode(Bus* bus, const LoggerOptions& options);
  /// Records what was received so far and closes the files.
  ~LoggerNode();
  LoggerNode(const LoggerNode&) = delete;
  LoggerNode& operator=(const LoggerNode&) = delete;

  /// Runs until `stop` (asked every 50 ms) says so, then records what was received so far. True if
  /// everything that came was recorded: nothing dropped, no run record refused. Throws
  /// std::runtime_error if the folder cannot be written in the end; if it is the database that
  /// cannot, the event log has everything that came.
  bool Run(const std::function<bool()>& stop);

  std::int64_t num_dropped() const { return queue_.num_dropped(); }

 private:
  void OnMessage(const ReceivedMessage& message);
  bool IsForged(const ReceivedMessage& message) const;
  void Write();
  /// Does it until it succeeds; throws what it threw last once there is to be an end.
  void Persist(const std::function<void()>& work);
  void SetTrouble(const std::string& trouble);
  void Stop();

  Bus* bus_;
  std::mutex status_mutex_;
  NodeStatusMessage status_;
  MessageQueue queue_;
  SessionRecorder recorder_;
  // After what takes long: what is kept from those who have subscribed to some channels alone, and
  // then to all, looks lost.
  NodeRegistry registry_;
  std::chrono::steady_clock::time_point last_complaint_;  // for handlers only
  std::exception_ptr failure_;                            // the writer's; to be read after the join
  std::thread writer_;
  std::unique_ptr<NodeAnnouncer> announcer_;
  Subscription everything_;
};

}  // namespace planbench
