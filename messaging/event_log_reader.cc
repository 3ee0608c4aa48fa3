#include "messaging/event_log_reader.h"

#include <lcm/eventlog.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "common/error.h"
#include "messaging/event_log_files.h"

namespace planbench {
namespace {

void ReadFile(const std::filesystem::path& file,
              const std::function<void(const ReceivedMessage& message)>& visit) {
  const std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log(
      lcm_eventlog_create(file.c_str(), "r"), [](lcm_eventlog_t* open) {
        if (open != nullptr) lcm_eventlog_destroy(open);
      });
  if (!log) {
    throw InputError(file.string() +
                     ": cannot be opened as an LCM event log: " + std::strerror(errno));
  }
  ReceivedMessage message;
  while (lcm_eventlog_event_t* raw = lcm_eventlog_read_next_event(log.get())) {
    const std::unique_ptr<lcm_eventlog_event_t, void (*)(lcm_eventlog_event_t*)> event(
        raw, lcm_eventlog_free_event);
    message.channel.assign(event->channel, static_cast<std::size_t>(event->channellen));
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    message.bytes.assign(data, data + event->datalen);
    message.utime = event->timestamp;
    visit(message);
  }
}

}  // namespace

void ReadEventLog(const std::filesystem::path& event_log,
                  const std::function<void(const ReceivedMessage& message)>& visit) {
  for (const std::filesystem::path& file : EventLogFiles(event_log)) ReadFile(file, visit);
}

}  // namespace planbench
