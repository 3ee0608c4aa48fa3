#include "messaging/event_log_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <system_error>

#include "messaging/event_log_files.h"
#include "messaging/file_bytes.h"

namespace planbench {
namespace {

// LCM's format (https://lcm-proj.github.io/lcm/content/log-file-format.html): event after event,
// each with a header of this word, its number, its time, and the lengths of channel and data, all
// big-endian, before the two. LCM's own reader ends where a byte of that is wrong.
constexpr std::array<std::uint8_t, 4> kSyncWord = {0xed, 0xa1, 0xda, 0x01};
constexpr std::size_t kHeaderBytes = 28;
/// LCM's own bounds.
constexpr std::size_t kMaxChannelBytes = 999;
constexpr std::size_t kMaxDataBytes = std::numeric_limits<std::int32_t>::max();

struct Event {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::size_t channel_bytes = 0;
  std::size_t data_bytes = 0;
};

std::uint64_t BigEndian(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

/// The whole events of a file, one after the other.
class EventScanner {
 public:
  explicit EventScanner(const std::filesystem::path& file) : bytes_(file) {}

  /// What is passed over before it is counted.
  std::optional<Event> Next() {
    std::optional<Event> event = Search(extent_.bytes);
    // One that the next does not follow is whole all the same, unless another begins within it:
    // then its lengths are wrong.
    while (event && !IsFollowed(*event)) {
      const std::optional<Event> other = Search(event->begin + 1);
      if (!other || other->begin >= event->end) break;
      event = other;
    }
    if (!event) return event;
    if (const std::uint64_t gap = event->begin - extent_.bytes; gap > 0) {
      if (extent_.num_damaged++ == 0) extent_.first_damaged = extent_.bytes;
      extent_.damaged_bytes += gap;
    }
    extent_.bytes = event->end;
    // That of a damaged header may be any.
    extent_.next_number =
        event->number < std::numeric_limits<std::int64_t>::max() ? event->number + 1 : 0;
    return event;
  }

  void Read(const Event& event, LoggedMessage* message) {
    const auto bytes =
        bytes_.Exactly(event.begin + kHeaderBytes, event.channel_bytes + event.data_bytes);
    const auto data = bytes.subspan(event.channel_bytes);
    message->channel.assign(bytes.begin(), data.begin());
    message->bytes.assign(data.begin(), data.end());
    message->utime = event.utime;
    message->place.offset = event.begin + kHeaderBytes + event.channel_bytes;
    message->place.bytes = event.data_bytes;
  }

  /// Of what came so far.
  const EventLogExtent& extent() const { return extent_; }

 private:
  /// The event there, if it is one that the file holds to its end.
  std::optional<Event> At(std::uint64_t begin) {
    const auto bytes = bytes_.From(begin, kHeaderBytes + kMaxChannelBytes);
    if (bytes.size() < kHeaderBytes ||
        !std::equal(kSyncWord.begin(), kSyncWord.end(), bytes.begin())) {
      return std::nullopt;
    }
    Event event;
    event.number = static_cast<std::int64_t>(BigEndian(bytes.subspan(4, 8)));
    event.utime = static_cast<std::int64_t>(BigEndian(bytes.subspan(12, 8)));
    event.channel_bytes = BigEndian(bytes.subspan(20, 4));
    event.data_bytes = BigEndian(bytes.subspan(24, 4));
    event.begin = begin;
    event.end = begin + kHeaderBytes + event.channel_bytes + event.data_bytes;
    if (event.channel_bytes == 0 || event.channel_bytes > kMaxChannelBytes ||
        event.data_bytes > kMaxDataBytes || bytes.size() < kHeaderBytes + event.channel_bytes ||
        !bytes_.HasGrownTo(event.end)) {
      return std::nullopt;
    }
    // On the bus a zero ends it.
    const auto channel = bytes.subspan(kHeaderBytes, event.channel_bytes);
    if (std::find(channel.begin(), channel.end(), 0) != channel.end()) return std::nullopt;
    return event;
  }

  /// Whether the next by number begins where it ends.
  bool IsFollowed(const Event& event) const {
    std::array<std::uint8_t, kSyncWord.size() + 8> expected = {};
    std::copy(kSyncWord.begin(), kSyncWord.end(), expected.begin());
    std::uint64_t number = static_cast<std::uint64_t>(event.number) + 1;
    for (std::size_t i = expected.size(); i > kSyncWord.size(); number >>= 8) {
      expected[--i] = static_cast<std::uint8_t>(number & 0xff);
    }
    std::array<std::uint8_t, expected.size()> next = {};
    bytes_.Copy(event.end, next);
    return next == expected;
  }

  /// The first from there on.
  std::optional<Event> Search(std::uint64_t begin) {
    for (;;) {
      const auto bytes = bytes_.From(begin, kHeaderBytes);
      if (bytes.size() < kHeaderBytes) return std::nullopt;
      const auto word = std::search(bytes.begin(), bytes.end(), kSyncWord.begin(), kSyncWord.end());
      begin += static_cast<std::uint64_t>(word - bytes.begin());
      if (word == bytes.end()) {
        begin -= kSyncWord.size() - 1;  // a part of it may be there
        continue;
      }
      if (const auto event = At(begin)) return event;
      ++begin;
    }
  }

  FileBytes bytes_;
  EventLogExtent extent_;
};

std::string DamageText(const std::filesystem::path& file, const EventLogExtent& extent) {
  const std::string where = extent.num_damaged == 1
                                ? fmt::format("from byte {} on", extent.first_damaged)
                                : fmt::format("in {} places, the first from byte {} on,",
                                              extent.num_damaged, extent.first_damaged);
  return fmt::format(
      "{}: {} bytes {} are passed over: the file is damaged, there is no whole event",
      file.string(), extent.damaged_bytes, where);
}

}  // namespace

EventLogExtent ReadEventLogFile(const std::filesystem::path& file, const VisitMessage& visit) {
  EventScanner events(file);
  LoggedMessage message;
  message.place.file = std::make_shared<const std::filesystem::path>(file);
  while (const std::optional<Event> event = events.Next()) {
    events.Read(*event, &message);
    visit(message);
  }
  return events.extent();
}

std::vector<std::string> ReadEventLog(const std::filesystem::path& event_log,
                                      const VisitMessage& visit) {
  std::vector<std::string> passed_over;
  for (const std::filesystem::path& file : EventLogFiles(event_log)) {
    // A live logger writes on.
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    const EventLogExtent extent = ReadEventLogFile(file, visit);
    if (extent.num_damaged > 0) passed_over.push_back(DamageText(file, extent));
    if (error || extent.bytes >= size) continue;
    passed_over.push_back(
        fmt::format("{}: {} bytes after the last whole event are not read: from byte {} on an "
                    "event was cut in two, its logger is still writing, or the file is damaged",
                    file.string(), size - extent.bytes, extent.bytes));
  }
  return passed_over;
}

std::vector<std::uint8_t> ReadEventBytes(const EventPlace& place) {
  FileBytes file(*place.file, place.bytes);
  const auto bytes = file.Exactly(place.offset, place.bytes);
  return {bytes.begin(), bytes.end()};
}

bool HoldsEvent(const std::filesystem::path& event_log) {
  const std::vector<std::filesystem::path> files = EventLogFiles(event_log);
  return std::any_of(files.begin(), files.end(), [](const std::filesystem::path& file) {
    return EventScanner(file).Next().has_value();
  });
}

bool BeginsAsEventLog(const std::filesystem::path& file) {
  FileBytes bytes(file, kSyncWord.size());
  const auto begin = bytes.From(0, kSyncWord.size());
  return std::equal(begin.begin(), begin.end(), kSyncWord.begin());
}

}  // namespace planbench
