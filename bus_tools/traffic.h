#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "messaging/bus.h"

namespace planbench {

/// Messages that may wait for a tool that hears all channels.
inline constexpr int kQueueCapacity = 65536;

/// What has come on each channel.
class Traffic {
 public:
  void Add(const ReceivedMessage& message);
  /// A table of the channels, by name: messages and kB a second since the last call, `seconds` ago,
  /// and messages in all; below it what the bus lost.
  std::string Rates(double seconds, const Bus::Counters& counters);

 private:
  struct Channel {
    std::int64_t messages = 0;
    std::int64_t recent_messages = 0;
    std::int64_t recent_bytes = 0;
  };
  std::map<std::string, Channel> channels_;
};

}  // namespace planbench
