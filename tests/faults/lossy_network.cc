// A bad network for one process and its children, where the kernel cannot make one: preloaded
// (LD_PRELOAD), it loses, doubles and swaps the datagrams that they send.
//
// PLANBENCH_LOSS, in percent, of each: lost, sent twice, sent after the next one.
// PLANBENCH_FAULT_SEED and the process's number make the sequence.

#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <random>
#include <vector>

namespace {

using SendMessage = ssize_t (*)(int, const msghdr*, int);

std::uint64_t FromEnvironment(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
}

struct Datagram {
  int socket = -1;
  sockaddr_in to = {};
  std::vector<char> bytes;
};

class BadNetwork {
 public:
  ssize_t Send(int socket, const msghdr* message, int flags) {
    const std::scoped_lock lock(mutex_);
    Datagram datagram;
    datagram.socket = socket;
    datagram.to = *static_cast<const sockaddr_in*>(message->msg_name);
    for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
      const auto* begin = static_cast<const char*>(message->msg_iov[i].iov_base);
      datagram.bytes.insert(datagram.bytes.end(), begin, begin + message->msg_iov[i].iov_len);
    }
    const auto size = static_cast<ssize_t>(datagram.bytes.size());
    if (Happens()) return size;
    if (!held_.bytes.empty()) {
      Out(datagram, flags);
      Out(held_, flags);
      held_.bytes.clear();
    } else if (Happens()) {
      held_ = std::move(datagram);
    } else {
      Out(datagram, flags);
      if (Happens()) Out(datagram, flags);
    }
    return size;
  }

 private:
  bool Happens() { return random_() % 100 < percent_; }
  static void Out(const Datagram& datagram, int flags) {
    sendto(datagram.socket, datagram.bytes.data(), datagram.bytes.size(), flags,
           reinterpret_cast<const sockaddr*>(&datagram.to), sizeof datagram.to);
  }

  std::mutex mutex_;
  const std::uint64_t percent_ = FromEnvironment("PLANBENCH_LOSS");
  std::mt19937_64 random_{FromEnvironment("PLANBENCH_FAULT_SEED") * 1'000'003 +
                          static_cast<std::uint64_t>(getpid())};
  Datagram held_;
};

}  // namespace

// In the place of the system's, for LCM, which sends by it.
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto original = reinterpret_cast<SendMessage>(dlsym(RTLD_NEXT, "sendmsg"));
  const auto* to = static_cast<const sockaddr*>(message->msg_name);
  if (to == nullptr || to->sa_family != AF_INET) return original(socket, message, flags);
  static BadNetwork network;
  return network.Send(socket, message, flags);
}
