#include "messaging/event_log_reader.h"

#include <fmt/format.h>
#include <lcm/eventlog.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include "common/error.h"
#include "messaging/event_log_files.h"

namespace planbench {
namespace {

/// What an event has before its channel and data.
constexpr std::int64_t kHeaderBytes = 28;
constexpr std::int64_t kSyncWordBytes = 4;

/// Where the event ended that was read from `begin` on.
std::int64_t EndOf(const lcm_eventlog_event_t& event, std::int64_t begin, std::FILE* file) {
  const std::int64_t end = begin + kHeaderBytes + event.channellen + event.datalen;
  // LCM looks for the next event's sync word, and does not go back where there is but a part of it.
  const std::int64_t at = ftello(file);
  return at > end && at < end + kSyncWordBytes ? end : at;
}

}  // namespace

EventLogExtent ReadEventLogFile(const std::filesystem::path& file, const VisitMessage& visit) {
  const std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log(
      lcm_eventlog_create(file.c_str(), "r"), [](lcm_eventlog_t* open) {
        if (open != nullptr) lcm_eventlog_destroy(open);
      });
  if (!log) {
    throw InputError(file.string() +
                     ": cannot be opened as an LCM event log: " + std::strerror(errno));
  }
  EventLogExtent extent;
  std::int64_t end = 0;
  ReceivedMessage message;
  while (lcm_eventlog_event_t* raw = lcm_eventlog_read_next_event(log.get())) {
    const std::unique_ptr<lcm_eventlog_event_t, void (*)(lcm_eventlog_event_t*)> event(
        raw, lcm_eventlog_free_event);
    end = EndOf(*event, end, log->f);
    extent.next_number = std::max(extent.next_number, event->eventnum + 1);
    message.channel.assign(event->channel, static_cast<std::size_t>(event->channellen));
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    message.bytes.assign(data, data + event->datalen);
    message.utime = event->timestamp;
    visit(message);
  }
  extent.bytes = static_cast<std::uintmax_t>(end);
  return extent;
}

std::vector<std::string> ReadEventLog(const std::filesystem::path& event_log,
                                      const VisitMessage& visit) {
  std::vector<std::string> not_read;
  for (const std::filesystem::path& file : EventLogFiles(event_log)) {
    // A live logger writes on; a device has no size.
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    const std::uintmax_t read = ReadEventLogFile(file, visit).bytes;
    if (error || read >= size) continue;
    not_read.push_back(
        fmt::format("{}: {} bytes after the last whole event are not read: an event was cut in "
                    "two, or the file is damaged",
                    file.string(), size - read));
  }
  return not_read;
}

}  // namespace planbench
