#include "messaging/lcm_url.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <optional>

namespace planbench {
namespace {

TEST(LcmUrlTest, ComesFromFlagElseEnvironmentElseDefault) {
  const char* set = std::getenv("LCM_DEFAULT_URL");
  const std::optional<std::string> before = set ? std::optional<std::string>(set) : std::nullopt;
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(ResolveLcmUrl(""), LcmUrl());
  setenv("LCM_DEFAULT_URL", "", 1);
  EXPECT_EQ(ResolveLcmUrl(""), LcmUrl());
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(ResolveLcmUrl(""), "memq://");
  EXPECT_EQ(ResolveLcmUrl("udpm://"), "udpm://");
  before ? setenv("LCM_DEFAULT_URL", before->c_str(), 1) : unsetenv("LCM_DEFAULT_URL");
}

TEST(FreeUdpPortTest, CanBeBound) {
  const int port = FreeUdpPort();
  EXPECT_GT(port, 1023);
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(fd, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  for (int i = 0; i < 200; ++i) EXPECT_NE(FreeUdpPort(), port);
  close(fd);
}

}  // namespace
}  // namespace planbench
