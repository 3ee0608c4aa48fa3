#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace planbench {

/// Where a packet came from, both in host byte order. Every LCM connection sends from a port of its
/// own.
struct PacketSender {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  bool operator<(const PacketSender& other) const {
    return std::pair(address, port) < std::pair(other.address, other.port);
  }
  bool operator==(const PacketSender&) const = default;
  std::string Text() const;  ///< "127.0.0.1:40123"
};

/// A message as it came off the bus.
struct ReceivedMessage {
  std::string channel;
  std::vector<std::uint8_t> bytes;
  std::int64_t utime = 0;    ///< Time of receipt, us since the Unix epoch.
  PacketSender sender = {};  ///< 0:0 if it came off no network.
};

/// Makes messages of the packets of LCM's multicast protocol
/// (https://lcm-proj.github.io/lcm/content/udp-multicast-protocol.html): small messages are one
/// packet, larger ones are put together from their fragments. Anybody may send packets: what breaks
/// the protocol is counted and left out, and memory is taken for bytes that have come, never for
/// bytes that a packet announces. Not thread-safe.
class PacketReader {
 public:
  /// LCM's own limits.
  static constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 28;
  static constexpr std::size_t kMaxChannelLength = 63;
  /// How a message in one packet begins: with this number and its own, then the channel.
  static constexpr std::uint32_t kSmall = 0x4c433032;  // "LC02"
  static constexpr std::size_t kSmallHeader = 8;
  /// For fragments of messages that are not complete; beyond, those begun first are given up.
  static constexpr std::size_t kMaxPendingBytes = std::size_t{1} << 29;
  /// Senders remembered; beyond, those that have been silent longest are forgotten.
  static constexpr std::size_t kMaxSenders = 1024;

  struct Counters {
    std::int64_t malformed = 0;  ///< Packets that break the protocol.
    /// Messages that a sender's sequence numbers say were sent, and that did not come (whole).
    std::int64_t lost = 0;
    /// Of them those of several packets of which some came, as is known when their sender's next
    /// such comes. Packets that are kept from a receiver (MulticastReceiver::Hear) are none of
    /// them.
    std::int64_t incomplete = 0;
  };

  /// What is known of the messages of one sender since it was first heard.
  struct SenderCounters {
    std::int64_t received = 0;
    std::int64_t lost = 0;  ///< As in Counters.
  };

  explicit PacketReader(std::size_t max_pending_bytes = kMaxPendingBytes)
      : max_pending_bytes_(max_pending_bytes) {}

  /// The message that a packet completes, if any; `utime` becomes its time of receipt.
  std::optional<ReceivedMessage> Read(const PacketSender& sender,
                                      std::span<const std::uint8_t> packet, std::int64_t utime);

  const Counters& counters() const { return counters_; }
  /// Of the senders that are remembered.
  std::map<PacketSender, SenderCounters> Senders() const;

 private:
  /// A message of which some fragments have come.
  struct Pending {
    PacketSender sender;
    std::uint32_t sequence = 0;
    std::size_t size = 0;
    std::uint16_t num_fragments = 0;
    std::string channel;
    struct Fragment {
      std::size_t offset = 0;
      std::vector<std::uint8_t> bytes;
    };
    std::map<std::uint16_t, Fragment> fragments;
    std::size_t footprint = 0;  ///< Bytes of memory.
  };
  struct Known {
    std::uint32_t newest = 0;  ///< Sequence number.
    bool begun = false;        ///< Fragments of the newest have come: it is pending or done with.
    /// Of which of those before the newest, its bit being the lowest, nothing has come: they count
    /// as lost, unless they were overtaken.
    std::uint32_t missed = 0;
    SenderCounters counters;
    std::list<PacketSender>::iterator heard;
    std::list<Pending>::iterator pending;  ///< pending_.end() if none.
  };

  std::optional<ReceivedMessage> ReadSmall(const PacketSender& sender,
                                           std::span<const std::uint8_t> packet);
  std::optional<ReceivedMessage> ReadFragment(const PacketSender& sender,
                                              std::span<const std::uint8_t> packet);
  std::nullopt_t Malformed();
  void CountLost(Known* known, std::int64_t number);
  /// Notes a sequence number; what was missed since the last one is lost.
  Known& Hear(const PacketSender& sender, std::uint32_t sequence);
  void GiveUp(std::list<Pending>::iterator pending);
  std::optional<ReceivedMessage> Complete(Known* known);

  std::size_t max_pending_bytes_;
  Counters counters_;
  std::map<PacketSender, Known> senders_;
  std::list<PacketSender> heard_;  ///< Least recently heard first.
  std::list<Pending> pending_;     ///< In the order in which they were begun.
  std::size_t pending_bytes_ = 0;
};

}  // namespace planbench
