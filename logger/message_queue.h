#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "messaging/packet_reader.h"

namespace planbench {

/// From the bus thread to the writer: holds at most so many bytes, and counts what it has to drop.
/// Thread-safe.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t capacity_bytes) : capacity_bytes_(capacity_bytes) {}

  /// False if there is no room for the message or the queue is closed.
  bool Push(const ReceivedMessage& message);
  /// The oldest message; nothing if none comes within `timeout`, or the queue is closed and empty.
  std::optional<ReceivedMessage> Pop(std::chrono::milliseconds timeout);
  /// Takes no more messages; those inside can still be popped.
  void Close();

  bool closed() const;
  bool empty() const;
  std::int64_t num_dropped() const;

 private:
  const std::size_t capacity_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ReceivedMessage> messages_;
  std::size_t bytes_ = 0;
  std::int64_t num_dropped_ = 0;
  bool closed_ = false;
};

}  // namespace planbench
