#include "messaging/packet_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace planbench {
namespace {

constexpr std::uint32_t kFragment = 0x4c433033;  // "LC03"
constexpr std::size_t kFragmentHeader = 20;
/// What a fragment takes up beside its bytes, at most.
constexpr std::size_t kFragmentOverhead = 128;
constexpr std::int32_t kMostOvertaken = 16;

/// Numbers are in network byte order.
std::uint32_t Number(std::span<const std::uint8_t> packet, std::size_t at, int num_bytes) {
  std::uint32_t number = 0;
  for (int i = 0; i < num_bytes; ++i) number = number << 8 | packet[at + static_cast<unsigned>(i)];
  return number;
}

/// Takes a channel's name and its terminating zero off the front; nothing if there is none.
std::optional<std::string> TakeChannel(std::span<const std::uint8_t>* bytes) {
  const auto searched = bytes->first(std::min(bytes->size(), PacketReader::kMaxChannelLength + 1));
  const auto zero = std::find(searched.begin(), searched.end(), std::uint8_t{0});
  if (zero == searched.end() || zero == searched.begin()) return std::nullopt;
  std::string channel(searched.begin(), zero);
  *bytes = bytes->subspan(channel.size() + 1);
  return channel;
}

}  // namespace

std::string PacketSender::Text() const {
  return fmt::format("{}.{}.{}.{}:{}", address >> 24, address >> 16 & 255, address >> 8 & 255,
                     address & 255, port);
}

std::nullopt_t PacketReader::Malformed() {
  ++counters_.malformed;
  return std::nullopt;
}

std::optional<ReceivedMessage> PacketReader::Read(const PacketSender& sender,
                                                  std::span<const std::uint8_t> packet,
                                                  std::int64_t utime) {
  if (packet.size() < kSmallHeader) return Malformed();
  std::optional<ReceivedMessage> message;
  switch (Number(packet, 0, 4)) {
    case kSmall:
      message = ReadSmall(sender, packet);
      break;
    case kFragment:
      message = ReadFragment(sender, packet);
      break;
    default:
      return Malformed();
  }
  if (message) {
    message->utime = utime;
    message->sender = sender;
  }
  return message;
}

std::optional<ReceivedMessage> PacketReader::ReadSmall(const PacketSender& sender,
                                                       std::span<const std::uint8_t> packet) {
  std::span<const std::uint8_t> rest = packet.subspan(kSmallHeader);
  std::optional<std::string> channel = TakeChannel(&rest);
  if (!channel) return Malformed();
  const std::uint32_t sequence = Number(packet, 4, 4);
  Known& known = Hear(sender, sequence);
  ++known.counters.received;
  const std::uint32_t overtaken = known.missed & std::uint32_t{1} << (known.newest - sequence);
  if (overtaken != 0) CountLost(&known, -1);
  known.missed &= ~overtaken;
  return ReceivedMessage{*std::move(channel), {rest.begin(), rest.end()}};
}

std::optional<ReceivedMessage> PacketReader::ReadFragment(const PacketSender& sender,
                                                          std::span<const std::uint8_t> packet) {
  if (packet.size() < kFragmentHeader) return Malformed();
  const std::uint32_t sequence = Number(packet, 4, 4);
  const std::size_t size = Number(packet, 8, 4);
  const std::size_t offset = Number(packet, 12, 4);
  const auto number = static_cast<std::uint16_t>(Number(packet, 16, 2));
  const auto num_fragments = static_cast<std::uint16_t>(Number(packet, 18, 2));
  std::span<const std::uint8_t> rest = packet.subspan(kFragmentHeader);
  std::optional<std::string> channel;
  if (number == 0) {
    channel = TakeChannel(&rest);
    if (!channel) return Malformed();
  }
  if (number >= num_fragments || size > kMaxMessageBytes || offset > size ||
      rest.size() > size - offset) {
    return Malformed();
  }

  Known& known = Hear(sender, sequence);
  if (known.pending != pending_.end() && known.pending->sequence != sequence) {
    // A sender sends one message after the other: of the one before nothing more will come.
    if (static_cast<std::int32_t>(sequence - known.pending->sequence) < 0) return std::nullopt;
    GiveUp(known.pending);
  }
  if (known.pending == pending_.end()) {
    if (known.newest != sequence || known.begun) return std::nullopt;
    known.begun = true;
    known.pending =
        pending_.insert(pending_.end(), {sender, sequence, size, num_fragments, "", {}, 0});
  }
  Pending& pending = *known.pending;
  if (pending.size != size || pending.num_fragments != num_fragments) return Malformed();
  if (pending.fragments.contains(number)) return std::nullopt;
  if (channel) pending.channel = *std::move(channel);
  pending.fragments[number] = {offset, {rest.begin(), rest.end()}};
  const std::size_t footprint = rest.size() + kFragmentOverhead;
  pending.footprint += footprint;
  pending_bytes_ += footprint;
  if (pending.fragments.size() == num_fragments) return Complete(&known);
  while (pending_bytes_ > max_pending_bytes_) GiveUp(pending_.begin());
  return std::nullopt;
}

std::optional<ReceivedMessage> PacketReader::Complete(Known* known) {
  const Pending pending = std::move(*known->pending);
  pending_bytes_ -= pending.footprint;
  pending_.erase(known->pending);
  known->pending = pending_.end();
  ReceivedMessage message{pending.channel, {}};
  for (const auto& [number, fragment] : pending.fragments) {
    if (fragment.offset != message.bytes.size()) return Malformed();
    message.bytes.insert(message.bytes.end(), fragment.bytes.begin(), fragment.bytes.end());
  }
  if (message.bytes.size() != pending.size) return Malformed();
  ++known->counters.received;
  return message;
}

void PacketReader::CountLost(Known* known, std::int64_t number) {
  counters_.lost += number;
  known->counters.lost += number;
}

std::map<PacketSender, PacketReader::SenderCounters> PacketReader::Senders() const {
  std::map<PacketSender, SenderCounters> senders;
  for (const auto& [sender, known] : senders_) senders[sender] = known.counters;
  return senders;
}

void PacketReader::GiveUp(std::list<Pending>::iterator pending) {
  Known& known = senders_.at(pending->sender);
  CountLost(&known, 1);
  ++counters_.incomplete;
  pending_bytes_ -= pending->footprint;
  known.pending = pending_.end();
  pending_.erase(pending);
}

PacketReader::Known& PacketReader::Hear(const PacketSender& sender, std::uint32_t sequence) {
  const auto [place, is_new] = senders_.try_emplace(sender);
  Known& known = place->second;
  if (is_new) {
    known = {sequence, false, 0, {}, heard_.insert(heard_.end(), sender), pending_.end()};
    if (senders_.size() > kMaxSenders) {
      const auto oldest = senders_.find(heard_.front());
      if (oldest->second.pending != pending_.end()) GiveUp(oldest->second.pending);
      heard_.pop_front();
      senders_.erase(oldest);
    }
    return known;
  }
  heard_.splice(heard_.end(), heard_, known.heard);
  const auto step = static_cast<std::int32_t>(sequence - known.newest);  // numbers wrap
  // A little earlier: the packet was repeated or overtaken. Much earlier: another process has got
  // the port.
  if (step > 0 || step < -kMostOvertaken) {
    if (step > 0) {
      CountLost(&known, step - 1);
      known.missed =
          step < 32 ? known.missed << step | ((std::uint32_t{1} << step) - 2) : ~std::uint32_t{1};
    } else {
      known.missed = 0;
      if (known.pending != pending_.end()) GiveUp(known.pending);
    }
    known.newest = sequence;
    known.begun = false;
  }
  return known;
}

}  // namespace planbench
