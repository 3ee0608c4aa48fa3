#include "messaging/inbox.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "common/text.h"

namespace planbench {
void Inbox::Add(std::shared_ptr<Subscriber> subscriber) {
  const std::scoped_lock lock(mutex_);
  subscribers_.push_back(std::move(subscriber));
}

void Inbox::Remove(const std::shared_ptr<Subscriber>& subscriber) {
  {
    const std::scoped_lock lock(mutex_);
    std::erase(subscribers_, subscriber);
  }
  const std::scoped_lock lock(subscriber->running);
  subscriber->handler = nullptr;  // with all it captured
}

std::optional<std::set<std::string>> Inbox::Channels() const {
  const std::scoped_lock lock(mutex_);
  std::set<std::string> channels;
  for (const std::shared_ptr<Subscriber>& subscriber : subscribers_) {
    if (subscriber->channel.empty()) return std::nullopt;
    channels.insert(subscriber->channel);
  }
  return channels;
}

void Inbox::Push(ReceivedMessage message) {
  const std::scoped_lock lock(mutex_);
  const bool full = bytes_ + message.bytes.size() > kMaxBytes;
  Entry entry;
  for (const std::shared_ptr<Subscriber>& subscriber : subscribers_) {
    if (!subscriber->channel.empty() && subscriber->channel != message.channel) continue;
    if (full || (subscriber->capacity > 0 && subscriber->num_waiting >= subscriber->capacity)) {
      ++num_dropped_;
      continue;
    }
    ++subscriber->num_waiting;
    entry.subscribers.push_back(subscriber);
  }
  if (entry.subscribers.empty()) return;
  bytes_ += message.bytes.size();
  entry.message = std::move(message);
  entries_.push_back(std::move(entry));
  changed_.notify_one();
}

bool Inbox::HandleNow(const ReceivedMessage& message) {
  std::vector<std::shared_ptr<Subscriber>> subscribers;
  {
    const std::scoped_lock lock(mutex_);
    if (handling_ || !entries_.empty()) return false;
    for (const std::shared_ptr<Subscriber>& subscriber : subscribers_) {
      if (subscriber->channel.empty()) return false;
      if (subscriber->channel == message.channel) subscribers.push_back(subscriber);
    }
    handling_ = true;
  }
  Handle(subscribers, message);
  return true;
}

void Inbox::HandleOne(std::chrono::milliseconds timeout) {
  Entry entry;
  {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return !handling_ && !entries_.empty(); };
    if (!changed_.wait_for(lock, timeout, ready)) return;
    entry = std::move(entries_.front());
    entries_.pop_front();
    bytes_ -= entry.message.bytes.size();
    for (const std::shared_ptr<Subscriber>& subscriber : entry.subscribers) {
      --subscriber->num_waiting;
    }
    handling_ = true;
  }
  Handle(entry.subscribers, entry.message);
}

void Inbox::Call(Subscriber* subscriber, const ReceivedMessage& message) {
  const std::scoped_lock lock(subscriber->running);
  if (!subscriber->handler) return;
  try {
    subscriber->handler(message);
  } catch (const std::exception& error) {
    NoteFailure(message.channel, error.what());
  } catch (...) {
    NoteFailure(message.channel, "its handler threw something");
  }
}

// What cannot be read is mostly repeated: a planner that sends bad results is asked four times a
// second.
void Inbox::NoteFailure(const std::string& channel, const std::string& what) {
  const std::string text = Printable(channel) + " dropped: " + what;
  const std::scoped_lock lock(mutex_);
  ++num_failed_;
  if (told_.size() == kMaxTold || !told_.insert(text).second) return;
  spdlog::error("message on {} (told once)", text);
  if (told_.size() == kMaxTold) spdlog::warn("further messages that are dropped are only counted");
}

void Inbox::Handle(const std::vector<std::shared_ptr<Subscriber>>& subscribers,
                   const ReceivedMessage& message) {
  for (const std::shared_ptr<Subscriber>& subscriber : subscribers) {
    Call(subscriber.get(), message);
  }
  const std::scoped_lock lock(mutex_);
  handling_ = false;
  if (!entries_.empty()) changed_.notify_one();
}

std::int64_t Inbox::num_failed() const {
  const std::scoped_lock lock(mutex_);
  return num_failed_;
}

std::int64_t Inbox::num_dropped() const {
  const std::scoped_lock lock(mutex_);
  return num_dropped_;
}

}  // namespace planbench
