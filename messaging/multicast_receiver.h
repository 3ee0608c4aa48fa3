#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>

#include "messaging/packet_reader.h"

namespace planbench {

/// What a scene of some ten thousand objects needs.
inline constexpr int kReceiveBufferBytes = 4 << 20;

/// What an udpm:// URL says of an LCM bus.
struct MulticastAddress {
  std::string group = "239.255.76.67";
  std::uint16_t port = 7667;
  int receive_buffer_bytes = kReceiveBufferBytes;  ///< Of the socket; 0: the system's default.
  int ttl = 0;  ///< Hops that what is sent may take, as LCM has it; 0: none leaves this machine.

  /// Throws InputError for anything but udpm://[GROUP[:PORT]][?OPTION=VALUE[&...]], and for values
  /// of recv_buf_size and ttl that a socket cannot have.
  static MulticastAddress Parse(const std::string& url);
};

/// Receives the packets of a multicast group on a thread of its own, from construction on. Packets
/// for other groups or for this host alone, which a socket bound to the port would get too, are
/// not seen. When nothing has come for a while it joins the group again if it must: an interface
/// that was taken away and came back (USB, VPN) knows of no member.
class MulticastReceiver {
 public:
  using Handler =
      std::function<void(const PacketSender& sender, std::span<const std::uint8_t> packet)>;

  /// Throws InputError in one line if the group cannot be joined. Warns if the kernel grants less
  /// than the receive buffer asked for.
  MulticastReceiver(const MulticastAddress& address, Handler handler);
  ~MulticastReceiver();
  MulticastReceiver(const MulticastReceiver&) = delete;
  MulticastReceiver& operator=(const MulticastReceiver&) = delete;

  /// Has the kernel drop messages in one packet on all channels but these, from now on, so that
  /// they wake nobody; none, or more than the kernel takes: all are received, as at first.
  void Hear(const std::optional<std::set<std::string>>& channels);

 private:
  void Receive();
  void JoinAgain();

  MulticastAddress address_;
  Handler handler_;
  int socket_ = -1;
  int member_ = -1;  ///< A socket that is in the group, for this machine's sake: see Join.
  int stop_ = -1;    ///< An eventfd.
  std::thread thread_;
};

}  // namespace planbench
