#include "messaging/packet_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace planbench {
namespace {

using Packet = std::vector<std::uint8_t>;

constexpr PacketSender kAlice = {0x7f000001, 40000};
constexpr PacketSender kBob = {0x7f000001, 40001};

void Append(Packet* packet, std::uint64_t number, int num_bytes) {
  for (int i = num_bytes - 1; i >= 0; --i) {
    packet->push_back(static_cast<std::uint8_t>(number >> (8 * i) & 255));
  }
}

void Append(Packet* packet, const std::string& text) {
  packet->insert(packet->end(), text.begin(), text.end());
}

Packet Small(std::uint32_t sequence, const std::string& channel, const std::string& payload) {
  Packet packet;
  Append(&packet, "LC02");
  Append(&packet, sequence, 4);
  Append(&packet, channel + std::string(1, '\0') + payload);
  return packet;
}

struct Header {
  std::uint32_t sequence = 1;
  std::uint32_t size = 0;
  std::uint32_t offset = 0;
  std::uint16_t number = 0;
  std::uint16_t num_fragments = 0;
};

Packet Fragment(const Header& header, const std::string& rest) {
  Packet packet;
  Append(&packet, "LC03");
  Append(&packet, header.sequence, 4);
  Append(&packet, header.size, 4);
  Append(&packet, header.offset, 4);
  Append(&packet, header.number, 2);
  Append(&packet, header.num_fragments, 2);
  Append(&packet, rest);
  return packet;
}

/// The first fragment carries the channel.
std::vector<Packet> Cut(std::uint32_t sequence, const std::string& channel,
                        const std::string& payload, std::size_t piece) {
  const std::size_t num = (payload.size() + piece - 1) / piece;
  std::vector<Packet> packets;
  for (std::size_t i = 0; i < num; ++i) {
    const Header header = {sequence, static_cast<std::uint32_t>(payload.size()),
                           static_cast<std::uint32_t>(i * piece), static_cast<std::uint16_t>(i),
                           static_cast<std::uint16_t>(num)};
    const std::string head = i == 0 ? channel + std::string(1, '\0') : "";
    packets.push_back(Fragment(header, head + payload.substr(i * piece, piece)));
  }
  return packets;
}

std::string Text(const std::optional<ReceivedMessage>& message) {
  if (!message) return "none";
  return message->channel + ":" + std::string(message->bytes.begin(), message->bytes.end());
}

/// What a sequence of packets of one sender comes to.
std::vector<std::string> ReadAll(PacketReader* reader, const std::vector<Packet>& packets,
                                 const PacketSender& sender = kAlice) {
  std::vector<std::string> messages;
  for (const Packet& packet : packets) {
    const auto message = reader->Read(sender, packet, 0);
    if (message) messages.push_back(Text(message));
  }
  return messages;
}

TEST(PacketReader, SmallMessagesHaveChannelBytesAndTime) {
  PacketReader reader;
  const auto message = reader.Read(kAlice, Small(7, "CHANNEL", "payload"), 42);
  EXPECT_EQ(Text(message), "CHANNEL:payload");
  EXPECT_EQ(message->utime, 42);
  EXPECT_EQ(Text(reader.Read(kAlice, Small(8, "EMPTY", ""), 0)), "EMPTY:");
  EXPECT_EQ(Text(reader.Read(kAlice, Small(9, std::string(63, 'C'), ""), 0)),
            std::string(63, 'C') + ":");
  EXPECT_EQ(reader.counters().malformed, 0);
  EXPECT_EQ(reader.counters().lost, 0);
}

TEST(PacketReader, FragmentsInAnyOrderAndRepeatedMakeOneMessage) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::string payload(1 + random() % 3000, ' ');
    for (char& c : payload) c = static_cast<char>(random());
    std::vector<Packet> packets = Cut(5, "LARGE", payload, 1 + random() % 700);
    const std::vector<Packet> again = packets;
    packets.insert(packets.end(), again.begin(), again.end());
    std::shuffle(packets.begin(), packets.end(), random);
    PacketReader reader;
    EXPECT_EQ(ReadAll(&reader, packets), std::vector<std::string>{"LARGE:" + payload});
    EXPECT_EQ(reader.counters().malformed, 0);
    EXPECT_EQ(reader.counters().lost, 0);
  }
}

TEST(PacketReader, SendersDoNotMixTheirFragments) {
  const std::vector<Packet> a = Cut(5, "A", "aaaaaa", 2);
  const std::vector<Packet> b = Cut(5, "B", "bbbbbb", 2);
  PacketReader reader;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(reader.Read(kAlice, a[i], 0));
    EXPECT_FALSE(reader.Read(kBob, b[i], 0));
  }
  EXPECT_EQ(Text(reader.Read(kBob, b[2], 0)), "B:bbbbbb");
  EXPECT_EQ(Text(reader.Read(kAlice, a[2], 0)), "A:aaaaaa");
}

TEST(PacketReader, CountsWhatBreaksTheProtocolAndLeavesItOut) {
  const std::vector<Packet> bad = {
      {},
      {'L', 'C', '0', '2'},
      Small(1, "", "payload"),
      Small(1, std::string(64, 'C'), ""),
      {'L', 'C', '0', '4', 0, 0, 0, 1, 'A', 0},
      {'L', 'C', '0', '2', 0, 0, 0, 1},
      {'L', 'C', '0', '2', 0, 0, 0, 1, 'A'},
      {'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0},
      Fragment({1, 10, 0, 0, 2}, "NO ZERO"),
      Fragment({1, 10, 0, 2, 2}, "payload"),
      Fragment({1, 10, 0, 0, 0}, std::string("A\0", 2)),
      Fragment({1, 10, 11, 1, 2}, ""),
      Fragment({1, 10, 5, 1, 2}, "beyond"),
      Fragment({1, (1u << 28) + 1, 0, 1, 2}, "large"),
  };
  PacketReader reader;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_FALSE(reader.Read(kAlice, bad[i], 0)) << i;
    EXPECT_EQ(reader.counters().malformed, static_cast<std::int64_t>(i) + 1) << i;
  }
  EXPECT_EQ(Text(reader.Read(kAlice, Small(1, "GOOD", ""), 0)), "GOOD:");
}

TEST(PacketReader, FragmentsThatContradictEachOtherAreNoMessage) {
  const std::string zero(1, '\0');
  PacketReader reader;
  // Another size than the first said.
  EXPECT_FALSE(reader.Read(kAlice, Fragment({1, 4, 0, 0, 2}, "A" + zero + "ab"), 0));
  EXPECT_FALSE(reader.Read(kAlice, Fragment({1, 5, 2, 1, 2}, "cde"), 0));
  EXPECT_EQ(reader.counters().malformed, 1);
  EXPECT_EQ(Text(reader.Read(kAlice, Fragment({1, 4, 2, 1, 2}, "cd"), 0)), "A:abcd");
  // A gap, an overlap, too little.
  int sequence = 2;
  for (const auto& [offset, rest] : {std::pair(3, "d"), std::pair(1, "bcd"), std::pair(2, "c")}) {
    const auto number = static_cast<std::uint32_t>(sequence++);
    EXPECT_FALSE(reader.Read(kAlice, Fragment({number, 4, 0, 0, 2}, "A" + zero + "ab"), 0));
    EXPECT_FALSE(reader.Read(
        kAlice, Fragment({number, 4, static_cast<std::uint32_t>(offset), 1, 2}, rest), 0));
  }
  EXPECT_EQ(reader.counters().malformed, 4);
}

TEST(PacketReader, CountsMessagesThatDidNotCome) {
  PacketReader reader;
  const auto read = [&](std::uint32_t sequence) {
    EXPECT_TRUE(reader.Read(kAlice, Small(sequence, "A", ""), 0));
    return reader.counters().lost;
  };
  EXPECT_EQ(read(100), 0);  // who comes late has lost nothing
  EXPECT_EQ(read(101), 0);
  EXPECT_EQ(read(104), 2);
  EXPECT_EQ(read(104), 2);         // repeated
  EXPECT_EQ(read(103), 1);         // overtaken
  EXPECT_EQ(read(103), 1);         // and repeated
  EXPECT_EQ(read(0xffffffff), 1);  // another process on the same port, just before 0 ...
  EXPECT_EQ(read(1), 2);           // ... where numbers wrap
  // Fragments of which one never comes.
  const std::vector<Packet> packets = Cut(2, "B", "bbbb", 2);
  EXPECT_FALSE(reader.Read(kAlice, packets[0], 0));
  EXPECT_EQ(reader.counters().lost, 2);
  EXPECT_EQ(reader.counters().incomplete, 0);
  EXPECT_FALSE(reader.Read(kAlice, Cut(3, "B", "bbbb", 2)[0], 0));
  EXPECT_EQ(reader.counters().lost, 3);
  EXPECT_EQ(reader.counters().incomplete, 1);
}

TEST(PacketReader, OvertakenMessagesAreNotLost) {
  std::mt19937_64 generator(1);
  PacketReader reader;
  std::vector<std::uint32_t> order(2000);
  std::iota(order.begin(), order.end(), 0xfffffc00);  // numbers wrap
  // None is more than 16 behind; the first stays where it is: who comes before it counts for
  // nothing.
  for (std::size_t i = 1; i < order.size(); i += 16) {
    std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(i),
                 order.begin() + static_cast<std::ptrdiff_t>(std::min(i + 16, order.size())),
                 generator);
  }
  for (const std::uint32_t sequence : order) {
    if (sequence % 100 == 50) continue;
    EXPECT_TRUE(reader.Read(kAlice, Small(sequence, "A", ""), 0));
  }
  EXPECT_EQ(reader.counters().lost,
            std::count_if(order.begin(), order.end(),
                          [](std::uint32_t sequence) { return sequence % 100 == 50; }));
}

TEST(PacketReader, CountsForEverySender) {
  PacketReader reader;
  const PacketSender bob = {kAlice.address, static_cast<std::uint16_t>(kAlice.port + 1)};
  for (const std::uint32_t sequence : {7, 8, 10}) reader.Read(kAlice, Small(sequence, "A", ""), 0);
  ReadAll(&reader, Cut(11, "A", "aaaa", 2));
  reader.Read(bob, Cut(1, "B", "bbbb", 2)[0], 0);
  reader.Read(bob, Cut(3, "B", "bbbb", 2)[0], 0);
  const auto senders = reader.Senders();
  ASSERT_EQ(senders.size(), 2u);
  EXPECT_EQ(senders.at(kAlice).received, 4);
  EXPECT_EQ(senders.at(kAlice).lost, 1);
  EXPECT_EQ(senders.at(bob).received, 0);
  EXPECT_EQ(senders.at(bob).lost, 2);
}

TEST(PacketReader, TakesFragmentsOfANewProcessOnAnOldPort) {
  PacketReader reader;
  EXPECT_TRUE(reader.Read(kAlice, Small(5000, "A", ""), 0));
  EXPECT_FALSE(reader.Read(kAlice, Cut(5001, "B", "bbbb", 2)[0], 0));
  EXPECT_EQ(ReadAll(&reader, Cut(0, "B", "cccc", 2)), std::vector<std::string>{"B:cccc"});
}

TEST(PacketReader, AnnouncedBytesTakeNoMemory) {
  PacketReader reader;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    const PacketSender sender = {i, 1};
    EXPECT_FALSE(
        reader.Read(sender, Fragment({1, 1u << 28, 0, 0, 4096}, std::string("A\0b", 3)), 0));
  }
  // All but those of the senders remembered have been given up.
  EXPECT_EQ(reader.counters().lost, 10'000 - static_cast<std::int64_t>(PacketReader::kMaxSenders));
  EXPECT_EQ(reader.counters().malformed, 0);
}

TEST(PacketReader, GivesUpTheOldestMessageWhereFragmentsTakeTooMuch) {
  PacketReader reader(1 << 19);
  const std::string piece(1 << 10, 'x');
  const auto send = [&](const PacketSender& sender, std::uint16_t number) {
    const std::string head = number == 0 ? std::string("A\0", 2) : "";
    const Header header = {1, 1u << 17, static_cast<std::uint32_t>(number) << 10, number, 128};
    return reader.Read(sender, Fragment(header, head + piece), 0);
  };
  // Of four messages of 128 KiB all but the last fragment: with their overhead three fit.
  for (std::uint16_t number = 0; number < 127; ++number) {
    for (std::uint16_t port = 1; port <= 4; ++port) EXPECT_FALSE(send({1, port}, number));
  }
  EXPECT_EQ(reader.counters().lost, 1);
  EXPECT_FALSE(send({1, 1}, 127));
  EXPECT_TRUE(send({1, 2}, 127));
}

TEST(PacketReader, RandomPacketsDoNoHarm) {
  std::mt19937_64 random(2);
  PacketReader reader;
  std::int64_t num_messages = 0;
  for (int i = 0; i < 50'000; ++i) {
    // Near the protocol: small numbers, so that fragments meet.
    const Header header = {
        static_cast<std::uint32_t>(random() % 8), static_cast<std::uint32_t>(random() % 6),
        static_cast<std::uint32_t>(random() % 6), static_cast<std::uint16_t>(random() % 4),
        static_cast<std::uint16_t>(random() % 4)};
    std::string rest(random() % 6, 'A');
    for (char& c : rest) c = random() % 3 == 0 ? '\0' : c;
    Packet packet = random() % 4 == 0 ? Small(header.sequence, rest, rest) : Fragment(header, rest);
    if (random() % 4 == 0) packet[random() % packet.size()] = static_cast<std::uint8_t>(random());
    if (random() % 8 == 0) packet.resize(random() % packet.size());
    const PacketSender sender = {static_cast<std::uint32_t>(random() % 3), 1};
    num_messages += reader.Read(sender, packet, 0) ? 1 : 0;
  }
  EXPECT_GT(num_messages, 2'000);
  EXPECT_GT(reader.counters().malformed, 2'000);
}

}  // namespace
}  // namespace planbench
