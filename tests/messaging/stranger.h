#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "messaging/multicast_receiver.h"

namespace planbench {

/// Sends packets to a bus as anybody can.
class Stranger {
 public:
  explicit Stranger(const std::string& url, const std::string& group = MulticastAddress().group)
      : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(MulticastAddress::Parse(url).port);
    inet_pton(AF_INET, group.c_str(), &to_.sin_addr);
    const unsigned char hops = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof(hops));
  }
  ~Stranger() { close(socket_); }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  void Send(const std::string& packet) const {
    ASSERT_EQ(sendto(socket_, packet.data(), packet.size(), 0,
                     reinterpret_cast<const sockaddr*>(&to_), sizeof(to_)),
              static_cast<ssize_t>(packet.size()));
  }

 private:
  int socket_;
  sockaddr_in to_ = {};
};

}  // namespace planbench
