#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "messaging/packet_reader.h"

namespace planbench {

/// Messages that contradict what is known of their sender or of what they tell: forged ones,
/// replays on a live bus, two sessions on one port. None of them has had an effect. Thread-safe.
class Contradictions {
 public:
  /// Senders and channels told apart; further ones are counted in total only.
  static constexpr std::size_t kMaxEntries = 256;

  struct Entry {
    std::string sender;
    std::string channel;
    std::string what;  ///< Of the first.
    std::int64_t count = 0;
  };

  /// Logs the first of a sender on a channel.
  void Note(const PacketSender& sender, const std::string& channel, const std::string& what);

  std::int64_t count() const;
  std::vector<Entry> entries() const;

 private:
  mutable std::mutex mutex_;
  std::int64_t count_ = 0;
  std::map<std::pair<std::string, std::string>, Entry> entries_;  // by sender and channel
};

}  // namespace planbench
