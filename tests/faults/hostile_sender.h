#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "messaging/bus.h"

namespace planbench {

/// Somebody on a session's bus who means it ill: sends packets that are none and packets that
/// announce much, and to whatever he hears a forged message that fits it.
class HostileSender {
 public:
  /// What forged results and records say their planning took, s.
  static constexpr double kForgedTime = 0.123456;

  HostileSender(const std::string& url, std::uint64_t seed);
  ~HostileSender();
  HostileSender(const HostileSender&) = delete;
  HostileSender& operator=(const HostileSender&) = delete;

  std::int64_t num_forged() const { return num_forged_; }

 private:
  template <typename Message>
  void Forge(const std::string& channel, const Message& message);
  void OnMessage(const ReceivedMessage& message);
  void SendPackets(const std::string& url, std::uint64_t seed);

  /// By instance, in the bus's thread.
  std::map<std::string, std::chrono::steady_clock::time_point> first_heard_;
  Bus bus_;
  std::atomic<std::int64_t> num_forged_ = 0;
  std::atomic<bool> stopping_ = false;
  Subscription everything_;
  std::thread packets_;
};

}  // namespace planbench
