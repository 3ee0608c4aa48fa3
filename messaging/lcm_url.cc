#include "messaging/lcm_url.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "messaging/multicast_receiver.h"

namespace planbench {

std::string LcmUrl(int port) {
  // Spelled out for LCM's own programs, which take the system's default otherwise.
  return fmt::format("udpm://239.255.76.67:{}?ttl=0&recv_buf_size={}", port, kReceiveBufferBytes);
}

std::string ResolveLcmUrl(const std::string& flag) {
  if (!flag.empty()) return flag;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : LcmUrl();
}

int FreeUdpPort() {
  std::random_device random;
  std::uniform_int_distribution<int> any_port(20000, 32000);  // below Linux's ephemeral range
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const int port = any_port(random);
    const int socket_fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_fd < 0) break;
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    // Without SO_REUSEADDR this fails if anybody, LCM included, has the port.
    const bool free =
        bind(socket_fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    close(socket_fd);
    if (free) return port;
  }
  throw std::runtime_error("no free UDP port found");
}

}  // namespace planbench
