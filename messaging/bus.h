#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "messaging/codec.h"
#include "messaging/contradictions.h"
#include "messaging/inbox.h"

namespace planbench {

/// Keeps a handler subscribed while it lives. Destroying it waits for a running call of the handler
/// to end, after which there is none: it must not be destroyed from within the handler, nor outlive
/// the bus.
class Subscription {
 public:
  Subscription();
  Subscription(Subscription&&) noexcept;
  Subscription& operator=(Subscription&&) noexcept;
  ~Subscription();

 private:
  friend class Bus;
  Subscription(Inbox* inbox, std::shared_ptr<Subscriber> subscriber);
  void Release();
  Inbox* inbox_ = nullptr;
  std::shared_ptr<Subscriber> subscriber_;
};

/// Where a message came from, and when: before it was decoded.
struct Origin {
  PacketSender sender;
  std::chrono::steady_clock::time_point arrival;
};

/// The only owner of an LCM connection. Messages are sent by LCM, but received by this project's
/// own reader of its protocol, which no packet harms. Handlers run on the bus's threads, one at a
/// time, from Start() on; what they throw is logged with the channel's name, once, and goes no
/// further. Publishing is thread-safe.
class Bus {
 public:
  /// Messages a subscription can hold while its handler is busy.
  static constexpr int kDefaultQueueCapacity = 1024;

  /// Connects; throws InputError in one line if the URL is bad or there is no multicast route.
  /// "memq://" is a bus within this object.
  explicit Bus(const std::string& url);
  /// Stops the threads.
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  const std::string& url() const { return url_; }

  /// Starts to call handlers. Subscriptions may be made before and after.
  void Start();

  template <typename Message>
  void Publish(const std::string& channel, const Message& message) {
    PublishBytes(channel, Encode(message));
  }
  /// `on_bad_message`, if given, gets messages that could not be decoded, so that a server can
  /// refuse them; without it they are logged.
  template <typename Message>
  [[nodiscard]] Subscription Subscribe(
      const std::string& channel, std::function<void(Message&&)> handler,
      std::function<void(const MessageError&)> on_bad_message = nullptr,
      int queue_capacity = kDefaultQueueCapacity) {
    std::function<void(const MessageError&, const Origin&)> on_bad;
    if (on_bad_message) {
      on_bad = [on_bad_message = std::move(on_bad_message)](
                   const MessageError& error, const Origin&) { on_bad_message(error); };
    }
    return SubscribeFrom<Message>(
        channel,
        [handler = std::move(handler)](Message&& message, const Origin&) {
          handler(std::move(message));
        },
        std::move(on_bad), queue_capacity);
  }
  /// The same for handlers that are also told where the message came from.
  template <typename Message>
  [[nodiscard]] Subscription SubscribeFrom(
      const std::string& channel, std::function<void(Message&&, const Origin&)> handler,
      std::function<void(const MessageError&, const Origin&)> on_bad_message = nullptr,
      int queue_capacity = kDefaultQueueCapacity) {
    return SubscribeBytes(
        channel,
        [handler = std::move(handler),
         on_bad_message = std::move(on_bad_message)](const ReceivedMessage& received) {
          const Origin origin{received.sender, std::chrono::steady_clock::now()};
          try {
            handler(Decode<Message>(received.bytes, received.channel), origin);
          } catch (const MessageError& error) {
            if (!on_bad_message) throw;
            on_bad_message(error, origin);
          }
        },
        queue_capacity);
  }

  void PublishBytes(const std::string& channel, std::span<const std::uint8_t> bytes);
  /// queue_capacity 0 is unbounded.
  using BytesHandler = Subscriber::Handler;
  [[nodiscard]] Subscription SubscribeBytes(const std::string& channel, BytesHandler handler,
                                            int queue_capacity = kDefaultQueueCapacity);
  /// To all channels.
  [[nodiscard]] Subscription SubscribeToAll(BytesHandler handler, int queue_capacity);

  /// All but `incomplete` are of a bus with a subscription to all channels: others do not see all
  /// packets.
  struct Counters {
    std::int64_t malformed = 0;  ///< Packets that were none of LCM's.
    std::int64_t lost = 0;       ///< Messages sent that did not come whole, as far as can be known.
    std::int64_t dropped = 0;    ///< Messages that came faster than they were handled.
    std::int64_t incomplete = 0;  ///< Large messages sent of which only parts came.
  };
  Counters counters() const;
  /// Of a bus with a subscription to all channels: who was heard, this process included.
  std::map<PacketSender, PacketReader::SenderCounters> senders() const;
  /// Messages that claimed to be from another sender than theirs, as those who took or refused them
  /// noted.
  Contradictions& contradictions() { return contradictions_; }

 private:
  struct Impl;
  std::string url_;
  Contradictions contradictions_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planbench
