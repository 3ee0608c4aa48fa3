#include "messaging/channel_filter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "messaging/packet_reader.h"

namespace planbench {
namespace {

/// Where a packet begins for a filter: behind the UDP header.
constexpr std::uint32_t kPacket = 8;
constexpr std::uint32_t kChannel = kPacket + PacketReader::kSmallHeader;

sock_filter Return(std::uint32_t num_bytes) { return BPF_STMT(BPF_RET | BPF_K, num_bytes); }
sock_filter Pass() { return Return(0xffffffff); }
sock_filter Drop() { return Return(0); }

/// Passes a packet whose channel is this one; another goes on behind.
void AppendTest(const std::string& channel, std::vector<sock_filter>* program) {
  const std::size_t num_bytes = channel.size() + 1;  // with the terminating zero
  std::vector<sock_filter> test;
  for (std::size_t at = 0; at < num_bytes;) {
    const std::size_t left = num_bytes - at;
    const std::size_t width = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    const int size = width == 4 ? BPF_W : width == 2 ? BPF_H : BPF_B;
    std::uint32_t word = 0;  // in network byte order, as the kernel reads it
    for (std::size_t i = 0; i < width; ++i) {
      word = word << 8 | static_cast<std::uint8_t>(channel.c_str()[at + i]);
    }
    test.push_back(BPF_STMT(static_cast<std::uint16_t>(BPF_LD | BPF_ABS | size),
                            kChannel + static_cast<std::uint32_t>(at)));
    test.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word, 0, 0));
    at += width;
  }
  test.push_back(Pass());
  for (std::size_t i = 1; i < test.size() - 1; i += 2) {
    test[i].jf = static_cast<std::uint8_t>(test.size() - 1 - i);
  }
  program->insert(program->end(), test.begin(), test.end());
}

}  // namespace

std::vector<sock_filter> ChannelFilter(const std::set<std::string>& channels) {
  std::vector<sock_filter> program = {
      BPF_STMT(BPF_LD | BPF_ABS | BPF_W, kPacket),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PacketReader::kSmall, 1, 0),
      Pass(),
  };
  // A load beyond the end of a packet drops it: short names first, so that only packets of other
  // channels can be too short for a test.
  std::vector<std::string> by_length(channels.begin(), channels.end());
  std::stable_sort(by_length.begin(), by_length.end(),
                   [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
  for (const std::string& channel : by_length) {
    if (channel.size() <= PacketReader::kMaxChannelLength) AppendTest(channel, &program);
  }
  program.push_back(Drop());
  return program;
}

}  // namespace planbench
