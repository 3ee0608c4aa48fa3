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

void Inbox::Take(ReceivedMessage message, bool at_once) {
  std::vector<std::shared_ptr<Subscriber>> subscribers;
  {
    const std::scoped_lock lock(mutex_);
    at_once = at_once && !handling_ && entries_.empty();
    for (const std::shared_ptr<Subscriber>& subscriber : subscribers_) {
      const bool to_all = subscriber->channel.empty();
      if (!to_all && subscriber->channel != message.channel) continue;
      at_once = at_once && !to_all;
      subscribers.push_back(subscriber);
    }
    if (subscribers.empty()) return;
    if (!at_once) return Queue(std::move(subscribers), std::move(message));
    handling_ = true;
  }
  Handle(subscribers, message);
}

void Inbox::Queue(std::vector<std::shared_ptr<Subscriber>> subscribers, ReceivedMessage message) {
  const bool full = bytes_ + message.bytes.size() > kMaxBytes;
  num_dropped_ += static_cast<std::int64_t>(
      std::erase_if(subscribers, [full](const std::shared_ptr<Subscriber>& subscriber) {
        return full ||
               (subscriber->capacity > 0 && subscriber->num_waiting >= subscriber->capacity);
      }));
  if (subscribers.empty()) return;
  for (const std::shared_ptr<Subscriber>& subscriber : subscribers) ++subscriber->num_waiting;
  bytes_ += message.bytes.size();
  entries_.push_back({std::move(message), std::move(subscribers)});
  changed_.notify_one();
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
