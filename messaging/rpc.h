#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "messaging/answer_memory.h"
#include "messaging/bus.h"

namespace planbench {

/// Client half of request and reply by request_id: repeats the request until the reply arrives, so
/// that a lost datagram costs a moment and nothing else. Thread-safe; calls from several threads
/// may be under way at once.
template <typename Request, typename Reply>
class RpcClient {
 public:
  /// `believes`, if given, tells of a reply's sender whether it is the server: replies of others
  /// are none.
  RpcClient(Bus* bus, std::string request_channel, const std::string& reply_channel,
            std::function<bool(const PacketSender&)> believes = nullptr)
      : bus_(bus),
        request_channel_(std::move(request_channel)),
        believes_(std::move(believes)),
        subscription_(bus->SubscribeFrom<Reply>(
            reply_channel,
            [this](const Reply& reply, const Origin& origin) { OnReply(reply, origin.sender); })) {}

  /// Publishes the request every `retry_period` until the reply with its request_id arrives.
  /// Nothing if `timeout` passes, or `give_up` (asked every 50 ms) says so.
  std::optional<Reply> Call(const Request& request, std::chrono::milliseconds retry_period,
                            std::chrono::milliseconds timeout,
                            const std::function<bool()>& give_up = nullptr) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + timeout;
    auto next_send = Clock::now();
    std::unique_lock lock(mutex_);
    waiting_.insert(request.request_id);
    std::optional<Reply> reply;
    while (true) {
      if (Clock::now() >= next_send) {
        lock.unlock();
        bus_->Publish(request_channel_, request);
        lock.lock();
        next_send = Clock::now() + retry_period;
      }
      if (replies_.count(request.request_id) == 0) {
        changed_.wait_until(
            lock, std::min({next_send, deadline, Clock::now() + std::chrono::milliseconds(50)}));
      }
      const auto found = replies_.find(request.request_id);
      if (found != replies_.end()) {
        reply = std::move(found->second);
        break;
      }
      if (Clock::now() >= deadline) break;
      if (give_up) {
        lock.unlock();
        const bool stop = give_up();
        lock.lock();
        if (stop && replies_.count(request.request_id) == 0) break;
      }
    }
    waiting_.erase(request.request_id);
    replies_.erase(request.request_id);
    return reply;
  }

 private:
  void OnReply(const Reply& reply, const PacketSender& sender) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.count(reply.request_id) == 0) return;
    if (believes_ && !believes_(sender)) return;
    replies_.emplace(reply.request_id, reply);
    changed_.notify_all();
  }

  Bus* bus_;
  std::string request_channel_;
  std::function<bool(const PacketSender&)> believes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::string> waiting_;
  std::map<std::string, Reply> replies_;
  Subscription subscription_;  // last: no reply may arrive before the rest stands
};

/// Server half: answers each request on a thread of its own, in order, one at a time. A request
/// that is repeated while it waits or is being answered is not queued again; one answered lately is
/// answered from memory. One that comes when kMostWaiting wait is dropped: it will be repeated.
template <typename Request, typename Reply>
class RpcServer {
 public:
  static constexpr std::size_t kMostWaiting = Bus::kDefaultQueueCapacity;

  /// `answer` must set nothing but the content: request_id is copied by the server. What it throws
  /// as InputError becomes a reply with ok = false and the message.
  RpcServer(Bus* bus, const std::string& request_channel, std::string reply_channel,
            std::function<Reply(const Request&)> answer)
      : bus_(bus),
        reply_channel_(std::move(reply_channel)),
        answer_(std::move(answer)),
        subscription_(bus->Subscribe<Request>(
            request_channel, [this](const Request& request) { OnRequest(request); },
            [this](const MessageError& error) { OnBadRequest(error); })),
        worker_([this] { Work(); }) {}

  ~RpcServer() {
    subscription_ = Subscription();
    {
      const std::scoped_lock lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    worker_.join();
  }

 private:
  void OnRequest(const Request& request) {
    const std::scoped_lock lock(mutex_);
    if (const std::vector<std::uint8_t>* reply = answers_.Find(request.request_id)) {
      bus_->PublishBytes(reply_channel_, *reply);
      return;
    }
    if (queue_.size() >= kMostWaiting) return;
    if (!pending_.insert(request.request_id).second) return;
    queue_.push_back(request);
    changed_.notify_all();
  }

  void OnBadRequest(const MessageError& error) {
    const std::string& id = error.request_id();
    const std::scoped_lock lock(mutex_);
    // Of a request that was taken a spoiled copy, which anybody can send who hears it, is nothing.
    const bool is_taken = pending_.count(id) > 0 || answers_.Find(id) != nullptr;
    if (id.empty() || is_taken) throw error;
    bus_->Publish(reply_channel_, Refusal(id, error.what()));
  }

  static Reply Refusal(const std::string& request_id, const std::string& why) {
    Reply reply;
    reply.request_id = request_id;
    reply.ok = false;
    reply.message = why;
    return reply;
  }

  void Work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      const Request request = std::move(queue_.front());
      queue_.pop_front();
      lock.unlock();
      std::vector<std::uint8_t> bytes;
      try {
        Reply reply = answer_(request);
        reply.request_id = request.request_id;
        bytes = Encode(reply);
      } catch (const InputError& error) {  // the answer's or, if there is no wire form, Encode's
        bytes = Encode(Refusal(request.request_id, error.what()));
      }
      lock.lock();
      pending_.erase(request.request_id);
      // Remembered already: a repetition that comes at this moment is answered.
      bus_->PublishBytes(reply_channel_, answers_.Add(request.request_id, std::move(bytes)));
    }
  }

  Bus* bus_;
  std::string reply_channel_;
  std::function<Reply(const Request&)> answer_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::deque<Request> queue_;
  std::set<std::string> pending_;
  AnswerMemory answers_;
  Subscription subscription_;
  std::thread worker_;  // last: it may not be left running if the rest cannot be made
};

}  // namespace planbench
