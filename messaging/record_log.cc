#include "messaging/record_log.h"

#include <lcm/eventlog.h>

#include <memory>
#include <set>
#include <string>

#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/codec.h"

namespace planbench {

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  const std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log(
      lcm_eventlog_create(event_log.c_str(), "r"), [](lcm_eventlog_t* open) {
        if (open != nullptr) lcm_eventlog_destroy(open);
      });
  if (!log) throw InputError(event_log.string() + ": cannot be opened as an LCM event log");
  RecordedSession recorded;
  std::set<std::string> seen;
  while (lcm_eventlog_event_t* raw = lcm_eventlog_read_next_event(log.get())) {
    const std::unique_ptr<lcm_eventlog_event_t, void (*)(lcm_eventlog_event_t*)> event(
        raw, lcm_eventlog_free_event);
    const std::string channel(event->channel, static_cast<std::size_t>(event->channellen));
    const std::span bytes(static_cast<const std::uint8_t*>(event->data),
                          static_cast<std::size_t>(event->datalen));
    try {
      if (channel == channel::kSession) {
        recorded.sessions.push_back(Decode<SessionMessage>(bytes, channel));
      } else if (channel == channel::kRunRecord) {
        auto run = Decode<RunRecordMessage>(bytes, channel);
        if (seen.insert(run.request_id).second) recorded.runs.push_back(std::move(run));
      }
    } catch (const MessageError& error) {
      throw InputError(event_log.string() + ": " + error.what());
    }
  }
  return recorded;
}

}  // namespace planbench
