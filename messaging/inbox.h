#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "messaging/packet_reader.h"

namespace planbench {

/// A handler of messages and what waits for it.
struct Subscriber {
  using Handler = std::function<void(const ReceivedMessage& message)>;

  std::string channel;  ///< Empty: all.
  int capacity = 0;     ///< Messages that may wait; 0: any number.
  int num_waiting = 0;  ///< Guarded by the inbox's mutex.
  std::mutex running;   ///< Held while the handler runs, so that it cannot go away under it.
  Handler handler;      ///< Empty once the subscription has ended.
};

/// Messages on their way from those who receive them to those who handle them. Thread-safe.
class Inbox {
 public:
  /// Bytes of messages that may wait in all.
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  /// Failures of handlers that are told one by one; further ones are counted only.
  static constexpr std::size_t kMaxTold = 256;

  void Add(std::shared_ptr<Subscriber> subscriber);
  /// Waits for a running call of its handler; there is none afterwards.
  void Remove(const std::shared_ptr<Subscriber>& subscriber);

  /// Of the subscribers; none if one of them is for all channels.
  std::optional<std::set<std::string>> Channels() const;

  /// Queues a message for the subscribers of its channel; one whose messages are too many gets
  /// none. `at_once`: hands it to them on this thread, which is spared waking another, unless that
  /// has to wait: for other messages, or because a subscriber to all channels, who has more to do
  /// than its sender can wait for, is among them.
  void Take(ReceivedMessage message, bool at_once);
  /// Hands the oldest message to its handlers, waiting for one up to `timeout`. What a handler
  /// throws is logged, once for each channel and text, as long as those are not too many.
  void HandleOne(std::chrono::milliseconds timeout);

  /// Calls of handlers that threw.
  std::int64_t num_failed() const;

  /// Messages that a subscriber did not get, times subscribers.
  std::int64_t num_dropped() const;

 private:
  struct Entry {
    ReceivedMessage message;
    std::vector<std::shared_ptr<Subscriber>> subscribers;
  };

  /// Needs the lock.
  void Queue(std::vector<std::shared_ptr<Subscriber>> subscribers, ReceivedMessage message);
  /// Runs handlers, without the lock, and says when they are done.
  void Handle(const std::vector<std::shared_ptr<Subscriber>>& subscribers,
              const ReceivedMessage& message);

  /// Runs a handler, and notes what it throws.
  void Call(Subscriber* subscriber, const ReceivedMessage& message);
  void NoteFailure(const std::string& channel, const std::string& what);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<Subscriber>> subscribers_;
  std::deque<Entry> entries_;
  std::size_t bytes_ = 0;
  bool handling_ = false;  ///< Handlers run, on whichever thread: those of one message at a time.
  std::int64_t num_dropped_ = 0;
  std::int64_t num_failed_ = 0;
  std::set<std::string> told_;  ///< Channels and what was wrong, as logged.
};

}  // namespace planbench
