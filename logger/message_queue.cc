#include "logger/message_queue.h"

#include <utility>

namespace planbench {
namespace {

/// What a message takes up, bookkeeping included, so that many small ones are bounded too.
std::size_t Footprint(const ReceivedMessage& message) {
  return sizeof(ReceivedMessage) + message.channel.size() + message.bytes.size();
}

}  // namespace

bool MessageQueue::Push(const ReceivedMessage& message) {
  const std::size_t footprint = Footprint(message);
  const std::scoped_lock lock(mutex_);
  if (closed_ || bytes_ + footprint > capacity_bytes_) {
    ++num_dropped_;
    return false;
  }
  bytes_ += footprint;
  messages_.push_back(message);
  changed_.notify_one();
  return true;
}

std::optional<ReceivedMessage> MessageQueue::Pop(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [this] { return closed_ || !messages_.empty(); });
  if (messages_.empty()) return std::nullopt;
  ReceivedMessage message = std::move(messages_.front());
  messages_.pop_front();
  bytes_ -= Footprint(message);
  return message;
}

void MessageQueue::Close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

bool MessageQueue::closed() const {
  const std::scoped_lock lock(mutex_);
  return closed_;
}

bool MessageQueue::empty() const {
  const std::scoped_lock lock(mutex_);
  return messages_.empty();
}

std::int64_t MessageQueue::num_dropped() const {
  const std::scoped_lock lock(mutex_);
  return num_dropped_;
}

}  // namespace planbench
