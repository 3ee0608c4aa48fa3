#include "messaging/multicast_receiver.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <limits>
#include <optional>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "common/error.h"
#include "messaging/channel_filter.h"

namespace planbench {
namespace {

/// Packets taken from the kernel at once, and the most bytes that one can have.
constexpr std::size_t kBatch = 16;
constexpr std::size_t kMaxPacketBytes = 65536;

/// After which it is seen to that the group is joined. A process that announces itself hears itself
/// twice as often, so that where the bus works this costs nothing.
constexpr std::chrono::milliseconds kSilence{1000};

/// What a socket's options take.
constexpr int kMostBufferBytes = std::numeric_limits<int>::max();
constexpr int kMostHops = 255;

/// The value of `option` ("NAME=VALUE"); nothing if it is not called `name`.
std::optional<int> OptionNumber(const std::string& url, const std::string& option,
                                const std::string& name, int most) {
  if (option != name && !option.starts_with(name + "=")) return std::nullopt;
  const char* begin = option.data() + std::min(option.size(), name.size() + 1);
  const char* end = option.data() + option.size();
  int value = 0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest != end || value < 0 || value > most) {
    throw InputError(fmt::format(
        "cannot connect to LCM at '{}': {} is to be a whole number from 0 to {}", url, name, most));
  }
  return value;
}

void Set(int socket_fd, int level, int option, const void* value, std::size_t size,
         const char* what) {
  if (setsockopt(socket_fd, level, option, value, static_cast<socklen_t>(size)) != 0) {
    throw InputError(fmt::format("{}: {}", what, std::strerror(errno)));
  }
}

void SetReceiveBuffer(int socket_fd, int bytes) {
  if (bytes <= 0) return;
  Set(socket_fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes), "receive buffer");
  int granted = 0;  // twice what is for data
  socklen_t size = sizeof(granted);
  getsockopt(socket_fd, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  if (granted / 2 >= bytes) return;
  spdlog::warn(
      "the kernel caps receive buffers at {} bytes where {} are wanted: large messages may be lost "
      "and sent again; as root: sysctl -w net.core.rmem_max={}",
      granted / 2, bytes, bytes);
}

in_addr Group(const MulticastAddress& address) {
  in_addr group = {};
  inet_pton(AF_INET, address.group.c_str(), &group);
  return group;
}

void Bind(int socket_fd, const MulticastAddress& address) {
  const int yes = 1;
  Set(socket_fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes), "address in use");
  sockaddr_in bound = {};
  bound.sin_family = AF_INET;
  bound.sin_port = htons(address.port);
  bound.sin_addr = Group(address);
  if (bind(socket_fd, reinterpret_cast<const sockaddr*>(&bound), sizeof(bound)) != 0) {
    throw InputError(fmt::format("cannot receive from {}:{}: {}", address.group, address.port,
                                 std::strerror(errno)));
  }
}

/// On the interface by which the route goes now. Fails with EADDRINUSE if that is done. What one
/// socket has joined all get that are bound to the group (IP_MULTICAST_ALL, ip(7)).
bool Join(int socket_fd, const MulticastAddress& address) {
  ip_mreq membership = {};
  membership.imr_multiaddr = Group(address);
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  return setsockopt(socket_fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
}

int MakeSocket() { return socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

}  // namespace

MulticastAddress MulticastAddress::Parse(const std::string& url) {
  static const std::regex kUrl(R"(udpm://([0-9.]*)(?::([0-9]{1,5}))?(?:\?(.*))?)");
  const auto fail = [&] {
    throw InputError("cannot connect to LCM at '" + url +
                     "': the bus is udpm://GROUP:PORT, GROUP being a multicast address");
  };
  MulticastAddress address;
  std::smatch match;
  if (!std::regex_match(url, match, kUrl)) fail();
  if (match[1].length() > 0) address.group = match[1];
  if (match[2].matched) {
    const int port = std::stoi(match[2]);
    if (port < 1 || port > 65535) fail();
    address.port = static_cast<std::uint16_t>(port);
  }
  in_addr group = {};
  if (inet_pton(AF_INET, address.group.c_str(), &group) != 1 ||
      !IN_MULTICAST(ntohl(group.s_addr))) {
    fail();
  }
  std::istringstream options(match[3]);
  for (std::string option; std::getline(options, option, '&');) {
    if (const auto bytes = OptionNumber(url, option, "recv_buf_size", kMostBufferBytes)) {
      address.receive_buffer_bytes = *bytes;
    }
    // LCM's, which warns of what is none and goes on with its own.
    if (const auto hops = OptionNumber(url, option, "ttl", kMostHops)) address.ttl = *hops;
  }
  return address;
}

MulticastReceiver::MulticastReceiver(const MulticastAddress& address, Handler handler)
    : address_(address), handler_(std::move(handler)) {
  socket_ = MakeSocket();
  member_ = MakeSocket();
  stop_ = eventfd(0, EFD_CLOEXEC);
  try {
    if (socket_ < 0 || member_ < 0 || stop_ < 0) throw InputError(std::strerror(errno));
    SetReceiveBuffer(socket_, address.receive_buffer_bytes);
    Bind(socket_, address);
    if (!Join(member_, address)) {
      throw InputError(fmt::format("cannot join {}: {}", address.group, std::strerror(errno)));
    }
    thread_ = std::thread([this] { Receive(); });
  } catch (...) {
    close(socket_);
    close(member_);
    close(stop_);
    throw;
  }
}

MulticastReceiver::~MulticastReceiver() {
  eventfd_write(stop_, 1);
  thread_.join();
  close(socket_);
  close(member_);
  close(stop_);
}

void MulticastReceiver::Hear(const std::optional<std::set<std::string>>& channels) {
  if (channels) {
    std::vector<sock_filter> filter = ChannelFilter(*channels);
    const sock_fprog program = {static_cast<unsigned short>(filter.size()), filter.data()};
    if (filter.size() <= BPF_MAXINSNS &&
        setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) == 0) {
      return;
    }
  }
  const int unused = 0;
  setsockopt(socket_, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof(unused));
}

void MulticastReceiver::JoinAgain() {
  bool joined = Join(member_, address_);
  if (!joined && errno == EADDRINUSE) return;
  if (!joined) {
    // There is no route now, or it has been away too often. What the socket had joined is gone with
    // its interface, and would else count as joined should another get that one's number.
    close(member_);
    member_ = MakeSocket();
    joined = Join(member_, address_);
  }
  if (joined) {
    spdlog::warn(
        "{} was joined again: the network interface that the bus goes by is another, or "
        "was away",
        address_.group);
  }
}

void MulticastReceiver::Receive() {
  std::vector<std::uint8_t> memory(kBatch * kMaxPacketBytes);
  std::array<sockaddr_in, kBatch> senders = {};
  std::array<iovec, kBatch> buffers = {};
  std::array<mmsghdr, kBatch> packets = {};
  std::array<pollfd, 2> awaited = {pollfd{socket_, POLLIN, 0}, pollfd{stop_, POLLIN, 0}};
  while (true) {
    const int num_ready = poll(awaited.data(), awaited.size(), static_cast<int>(kSilence.count()));
    if (num_ready < 0 && errno != EINTR) {
      spdlog::critical("the bus cannot be heard any more: {}", std::strerror(errno));
      return;
    }
    if (num_ready == 0) JoinAgain();
    if (awaited[1].revents != 0) return;
    for (std::size_t i = 0; i < kBatch; ++i) {
      buffers[i] = {memory.data() + i * kMaxPacketBytes, kMaxPacketBytes};
      packets[i].msg_hdr = {};
      packets[i].msg_hdr.msg_name = &senders[i];
      packets[i].msg_hdr.msg_namelen = sizeof(senders[i]);
      packets[i].msg_hdr.msg_iov = &buffers[i];
      packets[i].msg_hdr.msg_iovlen = 1;
    }
    const int num = recvmmsg(socket_, packets.data(), kBatch, 0, nullptr);
    for (std::size_t i = 0; num > 0 && i < static_cast<std::size_t>(num); ++i) {
      handler_({ntohl(senders[i].sin_addr.s_addr), ntohs(senders[i].sin_port)},
               {memory.data() + i * kMaxPacketBytes, packets[i].msg_len});
    }
  }
}

}  // namespace planbench
