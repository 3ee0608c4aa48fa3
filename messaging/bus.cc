#include "messaging/bus.h"

#include <fcntl.h>
#include <lcm/lcm.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "common/error.h"
#include "common/utime.h"
#include "messaging/multicast_receiver.h"
#include "messaging/network_interfaces.h"
#include "messaging/packet_reader.h"

namespace planbench {
namespace {

/// Of messages whose handlers the receiving thread can wait for.
constexpr std::size_t kSmallMessageBytes = 65536;

/// Collects what LCM prints to stderr while it connects, so that a failure can be told in one line.
class StderrCapture {
 public:
  StderrCapture() : file_(std::tmpfile()), saved_(dup(STDERR_FILENO)) {
    std::fflush(stderr);
    if (file_ != nullptr && saved_ >= 0) dup2(fileno(file_), STDERR_FILENO);
  }
  ~StderrCapture() { Restore(); }
  StderrCapture(const StderrCapture&) = delete;
  StderrCapture& operator=(const StderrCapture&) = delete;

  std::string Restore() {
    std::string text;
    if (file_ == nullptr) return text;
    std::fflush(stderr);
    if (saved_ >= 0) {
      dup2(saved_, STDERR_FILENO);
      close(saved_);
    }
    std::rewind(file_);
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) {
      text += static_cast<char>(c);
    }
    std::fclose(file_);
    file_ = nullptr;
    return text;
  }

 private:
  std::FILE* file_;
  int saved_;
};

/// Threads started while this lives get no signals: they are for the main thread, and would cut
/// short what these wait in.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

std::string FirstLine(const std::string& text) {
  const std::size_t begin = text.find_first_not_of("\n ");
  if (begin == std::string::npos) return "no reason given";
  return text.substr(begin, text.find('\n', begin) - begin);
}

lcm_t* ConnectSender(const std::string& url, int ttl) {
  StderrCapture capture;
  lcm_t* lcm = lcm_create(url.c_str());
  const std::string said = capture.Restore();
  if (lcm != nullptr) return lcm;
  if (said.find("multicast route") != std::string::npos) {
    throw InputError("LCM needs a multicast route and this machine has none for " + url + "; " +
                     MulticastRouteAdvice(ttl));
  }
  throw InputError("cannot connect to LCM at '" + url + "': " + FirstLine(said));
}

/// Tells of machines that are heard and cannot hear this process: its own messages stay here.
class OneWayReach {
 public:
  OneWayReach(std::string url, int ttl) : url_(std::move(url)), is_possible_(ttl == 0) {}

  void Notice(const PacketSender& from) {
    if (!is_possible_ || from.address == known_) return;
    if (IsOfThisMachine(from.address)) {
      known_ = from.address;
      return;
    }
    is_possible_ = false;  // to be told again
    spdlog::warn(
        "{} is on another machine and does not hear this process, whose messages stay on this one "
        "({} has ttl=0{}): put ttl=1 into the --lcm-url here if both are of one session, else take "
        "another port",
        from.Text(), url_, url_.find("ttl=") == std::string::npos ? " by default" : "");
  }

 private:
  std::string url_;
  bool is_possible_;
  std::uint32_t known_ = 0;  ///< An address of this machine.
};

}  // namespace

Subscription::Subscription() = default;
Subscription::Subscription(Inbox* inbox, std::shared_ptr<Subscriber> subscriber)
    : inbox_(inbox), subscriber_(std::move(subscriber)) {}
Subscription::Subscription(Subscription&&) noexcept = default;
Subscription& Subscription::operator=(Subscription&& other) noexcept {
  if (this != &other) {
    Release();
    inbox_ = other.inbox_;
    subscriber_ = std::move(other.subscriber_);
  }
  return *this;
}
Subscription::~Subscription() { Release(); }

void Subscription::Release() {
  if (subscriber_) inbox_->Remove(subscriber_);
  subscriber_.reset();
}

struct Bus::Impl {
  ~Impl() {
    stopping = true;
    if (thread.joinable()) thread.join();
    receiver.reset();
    if (sender != nullptr) lcm_destroy(sender);
    if (packets.counters().malformed > 0) {
      spdlog::warn("{} packets on the bus were none of LCM's and were left out",
                   packets.counters().malformed);
    }
    if (inbox.num_failed() > 1) {
      spdlog::warn("{} messages on the bus could not be used (the first of each kind was told)",
                   inbox.num_failed());
    }
  }

  void Connect(const std::string& url) {
    const MulticastAddress address = MulticastAddress::Parse(url);
    // LCM looks for a multicast route. It receives nothing, since nothing subscribes with it.
    sender = ConnectSender(url, address.ttl);
    reach.emplace(url, address.ttl);
    const SignalsBlocked blocked;
    receiver.emplace(address,
                     [this](const PacketSender& from, std::span<const std::uint8_t> packet) {
                       OnPacket(from, packet);
                     });
  }

  void Add(const std::shared_ptr<Subscriber>& subscriber) {
    const std::scoped_lock lock(hearing);
    inbox.Add(subscriber);
    if (receiver) receiver->Hear(inbox.Channels());
  }

  void OnPacket(const PacketSender& from, std::span<const std::uint8_t> packet) {
    reach->Notice(from);
    std::optional<ReceivedMessage> message;
    {
      const std::scoped_lock lock(packets_mutex);
      const std::int64_t malformed = packets.counters().malformed;
      message = packets.Read(from, packet, NowUtime());
      if (malformed == 0 && packets.counters().malformed > 0) {
        spdlog::warn("{} sent a packet of {} bytes that is none of LCM's: left out, as others are",
                     from.Text(), packet.size());
      }
    }
    if (!message) return;
    // Large ones take long to decode, and meanwhile others come.
    const bool at_once = started && message->bytes.size() <= kSmallMessageBytes;
    inbox.Take(*std::move(message), at_once);
  }

  lcm_t* sender = nullptr;  ///< Null: what is published goes into the inbox.
  Inbox inbox;
  std::mutex hearing;  ///< What the receiver hears is what the inbox has subscribers for, or more.
  mutable std::mutex packets_mutex;
  PacketReader packets;
  std::optional<OneWayReach> reach;  ///< None without a network; the receiving thread's.
  std::optional<MulticastReceiver> receiver;
  std::atomic<bool> started = false;
  std::atomic<bool> stopping = false;
  std::thread thread;
};

Bus::Bus(const std::string& url) : url_(url), impl_(std::make_unique<Impl>()) {
  if (url != "memq://") impl_->Connect(url);
}

Bus::~Bus() {
  if (const std::int64_t count = contradictions_.count(); count > 0) {
    spdlog::warn("{} messages on the bus contradicted what was known of it and were refused",
                 count);
  }
}

void Bus::Start() {
  const SignalsBlocked blocked;
  if (impl_->thread.joinable()) return;
  impl_->thread = std::thread([this] {
    while (!impl_->stopping) impl_->inbox.HandleOne(std::chrono::milliseconds(50));
  });
  impl_->started = true;
}

void Bus::PublishBytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (impl_->sender == nullptr) {
    impl_->inbox.Take({channel, {bytes.begin(), bytes.end()}, NowUtime()}, false);
    return;
  }
  if (lcm_publish(impl_->sender, channel.c_str(), bytes.data(),
                  static_cast<unsigned int>(bytes.size())) != 0) {
    spdlog::warn("a message of {} bytes on {} could not be sent", bytes.size(), channel);
  }
}

Subscription Bus::SubscribeBytes(const std::string& channel, BytesHandler handler,
                                 int queue_capacity) {
  auto subscriber = std::make_shared<Subscriber>();
  subscriber->channel = channel;
  subscriber->capacity = queue_capacity;
  subscriber->handler = std::move(handler);
  impl_->Add(subscriber);
  return Subscription(&impl_->inbox, std::move(subscriber));
}

Subscription Bus::SubscribeToAll(BytesHandler handler, int queue_capacity) {
  return SubscribeBytes("", std::move(handler), queue_capacity);
}

Bus::Counters Bus::counters() const {
  const std::int64_t dropped = impl_->inbox.num_dropped();
  const std::scoped_lock lock(impl_->packets_mutex);
  const PacketReader::Counters& packets = impl_->packets.counters();
  return {packets.malformed, packets.lost, dropped, packets.incomplete};
}

std::map<PacketSender, PacketReader::SenderCounters> Bus::senders() const {
  const std::scoped_lock lock(impl_->packets_mutex);
  return impl_->packets.Senders();
}

}  // namespace planbench
