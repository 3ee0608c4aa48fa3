#include "messaging/bus.h"

#include <fcntl.h>
#include <lcm/lcm.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
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

/// Threads started while this lives get no signals: they are for the main thread, and would cut
/// short what LCM's threads wait in.
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

struct Subscription::State {
  lcm_subscription_t* subscription = nullptr;
  Retired* retired = nullptr;
  Bus::BytesHandler handler;
  // Held while the handler runs, so that the subscription cannot go away under it.
  std::mutex running;
  bool live = true;

  static void Dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
    auto* state = static_cast<State*>(user);
    const std::scoped_lock lock(state->running);
    if (!state->live) return;
    // What a handler throws must not pass through LCM: it would be unusable afterwards.
    try {
      state->handler(channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
                     buffer->recv_utime);
    } catch (const std::exception& error) {
      spdlog::error("message on {} dropped: {}", channel, error.what());
    } catch (...) {
      spdlog::error("message on {} dropped: its handler threw something", channel);
    }
  }
};

/// Subscriptions that have ended but that LCM still knows. LCM goes through its list of handlers
/// without holding its lock, so that taking one off the list from another thread, be it of the same
/// channel or not yet called, makes it skip others or read past the end. The bus thread takes them
/// off, between messages.
struct Subscription::Retired {
  std::mutex mutex;
  std::vector<std::unique_ptr<State>> states;

  void Add(std::unique_ptr<State> state) {
    const std::scoped_lock lock(mutex);
    states.push_back(std::move(state));
  }
  void Unsubscribe(lcm_t* lcm) {
    std::vector<std::unique_ptr<State>> ended;
    {
      const std::scoped_lock lock(mutex);
      ended.swap(states);
    }
    for (const std::unique_ptr<State>& state : ended) lcm_unsubscribe(lcm, state->subscription);
  }
};

Subscription::Subscription() = default;
Subscription::Subscription(std::unique_ptr<State> state) : state_(std::move(state)) {}
Subscription::Subscription(Subscription&&) noexcept = default;
Subscription& Subscription::operator=(Subscription&& other) noexcept {
  if (this != &other) {
    Release();
    state_ = std::move(other.state_);
  }
  return *this;
}
Subscription::~Subscription() { Release(); }

void Subscription::Release() {
  if (!state_) return;
  {
    const std::scoped_lock lock(state_->running);
    state_->live = false;
    state_->handler = nullptr;  // with all it captured
  }
  Retired* retired = state_->retired;
  retired->Add(std::move(state_));
}

struct Bus::Impl {
  lcm_t* lcm = nullptr;
  Subscription::Retired retired;
  std::atomic<bool> stopping = false;
  std::thread thread;

  void Receive() {
    while (!stopping) {
      retired.Unsubscribe(lcm);
      errno = 0;
      if (lcm_handle_timeout(lcm, 50) < 0 && errno != EINTR) {
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
  const SignalsBlocked blocked;
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
  state->retired = &impl_->retired;
  state->handler = std::move(handler);
  {
    const SignalsBlocked blocked;  // the first subscription starts a thread of LCM's
    state->subscription =
        lcm_subscribe(impl_->lcm, channel.c_str(), &Subscription::State::Dispatch, state.get());
  }
  if (state->subscription == nullptr) {
    throw InputError("cannot subscribe to '" + channel + "' at " + url_);
  }
  lcm_subscription_set_queue_capacity(state->subscription, queue_capacity);
  return Subscription(std::move(state));
}

}  // namespace planbench
