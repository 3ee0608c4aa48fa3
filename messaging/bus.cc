#include "messaging/bus.h"

#include <fcntl.h>
#include <lcm/lcm.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <regex>
#include <thread>

#include "common/error.h"

namespace planbench {
namespace {

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

std::string FirstLine(const std::string& text) {
  const std::size_t begin = text.find_first_not_of("\n ");
  if (begin == std::string::npos) return "no reason given";
  return text.substr(begin, text.find('\n', begin) - begin);
}

lcm_t* Connect(const std::string& url) {
  StderrCapture capture;
  lcm_t* lcm = lcm_create(url.c_str());
  const std::string said = capture.Restore();
  if (lcm != nullptr) return lcm;
  if (said.find("multicast route") != std::string::npos) {
    throw InputError("LCM needs a multicast route and this machine has none for " + url +
                     "; as root: ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo");
  }
  throw InputError("cannot connect to LCM at '" + url + "': " + FirstLine(said));
}

void WarnIfReceiveBufferIsCapped(const std::string& url) {
  std::smatch match;
  if (!std::regex_search(url, match, std::regex("recv_buf_size=([0-9]{1,12})"))) return;
  const long long wanted = std::stoll(match[1]);
  long long cap = 0;
  if (!(std::ifstream("/proc/sys/net/core/rmem_max") >> cap) || cap >= wanted) return;
  spdlog::warn(
      "the kernel caps receive buffers at {} bytes where {} are wanted: large messages may be lost "
      "and sent again; as root: sysctl -w net.core.rmem_max={}",
      cap, wanted, wanted);
}

}  // namespace

std::string ResolveLcmUrl(const std::string& flag) {
  if (!flag.empty()) return flag;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment
                                                                  : kDefaultLcmUrl;
}

struct Subscription::State {
  lcm_t* lcm = nullptr;
  lcm_subscription_t* subscription = nullptr;
  Bus::BytesHandler handler;
  // Held while the handler runs, so that the subscription cannot go away under it.
  std::mutex running;
  bool live = true;

  ~State() {
    {
      const std::scoped_lock lock(running);
      live = false;
    }
    // Takes LCM's own lock, which the bus thread holds while it dispatches: not to be nested in
    // `running`.
    lcm_unsubscribe(lcm, subscription);
  }

  static void Dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
    auto* state = static_cast<State*>(user);
    const std::scoped_lock lock(state->running);
    if (!state->live) return;
    try {
      state->handler(channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
                     buffer->recv_utime);
    } catch (const std::exception& error) {
      // What a handler throws must not pass through LCM: it would be unusable afterwards.
      spdlog::error("message on {} dropped: {}", channel, error.what());
    }
  }
};

Subscription::Subscription() = default;
Subscription::Subscription(std::unique_ptr<State> state) : state_(std::move(state)) {}
Subscription::Subscription(Subscription&&) noexcept = default;
Subscription& Subscription::operator=(Subscription&&) noexcept = default;
Subscription::~Subscription() = default;

struct Bus::Impl {
  lcm_t* lcm = nullptr;
  std::atomic<bool> stopping = false;
  std::thread thread;

  void Receive() {
    while (!stopping) {
      if (lcm_handle_timeout(lcm, 50) < 0) {
        spdlog::critical("LCM cannot receive any more; this process is deaf");
        return;
      }
    }
  }
};

Bus::Bus(const std::string& url) : url_(url), impl_(std::make_unique<Impl>()) {
  impl_->lcm = Connect(url);
  WarnIfReceiveBufferIsCapped(url);
}

Bus::~Bus() {
  impl_->stopping = true;
  if (impl_->thread.joinable()) impl_->thread.join();
  lcm_destroy(impl_->lcm);
}

void Bus::Start() {
  if (!impl_->thread.joinable()) impl_->thread = std::thread([this] { impl_->Receive(); });
}

void Bus::PublishBytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (lcm_publish(impl_->lcm, channel.c_str(), bytes.data(),
                  static_cast<unsigned int>(bytes.size())) != 0) {
    spdlog::warn("a message of {} bytes on {} could not be sent", bytes.size(), channel);
  }
}

Subscription Bus::SubscribeBytes(const std::string& channel, BytesHandler handler,
                                 int queue_capacity) {
  auto state = std::make_unique<Subscription::State>();
  state->lcm = impl_->lcm;
  state->handler = std::move(handler);
  state->subscription =
      lcm_subscribe(impl_->lcm, channel.c_str(), &Subscription::State::Dispatch, state.get());
  if (state->subscription == nullptr) {
    throw InputError("cannot subscribe to '" + channel + "' at " + url_);
  }
  lcm_subscription_set_queue_capacity(state->subscription, queue_capacity);
  return Subscription(std::move(state));
}

}  // namespace planbench
