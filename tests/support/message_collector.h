#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "messaging/bus.h"
#include "tests/support/wait_until.h"

namespace planbench {

/// Keeps what comes on a channel.
template <typename Message>
class MessageCollector {
 public:
  MessageCollector(Bus* bus, const std::string& channel)
      : subscription_(bus->Subscribe<Message>(channel, [this](const Message& message) {
          const std::scoped_lock lock(mutex_);
          messages_.push_back(message);
          changed_.notify_all();
        })) {}

  /// Waits for that many messages; returns those there are.
  std::vector<Message> WaitFor(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kTestPatience, [&] { return messages_.size() >= count; });
    return messages_;
  }
  /// Waits until one of the messages satisfies `condition`; false if none comes.
  bool WaitForOne(const std::function<bool(const Message&)>& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kTestPatience, [&] {
      for (const Message& message : messages_) {
        if (condition(message)) return true;
      }
      return false;
    });
  }
  std::vector<Message> messages() {
    const std::scoped_lock lock(mutex_);
    return messages_;
  }
  std::size_t Count(const std::function<bool(const Message&)>& condition) {
    std::size_t count = 0;
    for (const Message& message : messages()) count += condition(message) ? 1 : 0;
    return count;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Message> messages_;
  Subscription subscription_;  // last: nothing may arrive before the rest stands
};

}  // namespace planbench
