#include "messaging/record_log.h"

#include <lcm/eventlog.h>

#include <memory>
#include <set>
#include <string>

#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/codec.h"

namespace planbench {
namespace {

/// Calls visit(channel, bytes) for every event.
template <typename Visit>
void ForEachEvent(const std::filesystem::path& event_log, Visit visit) {
  const std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log(
      lcm_eventlog_create(event_log.c_str(), "r"), [](lcm_eventlog_t* open) {
        if (open != nullptr) lcm_eventlog_destroy(open);
      });
  if (!log) throw InputError(event_log.string() + ": cannot be opened as an LCM event log");
  while (lcm_eventlog_event_t* raw = lcm_eventlog_read_next_event(log.get())) {
    const std::unique_ptr<lcm_eventlog_event_t, void (*)(lcm_eventlog_event_t*)> event(
        raw, lcm_eventlog_free_event);
    const std::string channel(event->channel, static_cast<std::size_t>(event->channellen));
    const std::span bytes(static_cast<const std::uint8_t*>(event->data),
                          static_cast<std::size_t>(event->datalen));
    try {
      visit(channel, bytes);
    } catch (const MessageError& error) {
      throw InputError(event_log.string() + ": " + error.what());
    }
  }
}

}  // namespace

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  RecordedSession recorded;
  std::set<std::string> seen;
  ForEachEvent(event_log, [&](const std::string& channel, std::span<const std::uint8_t> bytes) {
    if (channel == channel::kSession) {
      recorded.sessions.push_back(Decode<SessionMessage>(bytes, channel));
    } else if (channel == channel::kRunRecord) {
      auto run = Decode<RunRecordMessage>(bytes, channel);
      if (seen.insert(run.request_id).second) recorded.runs.push_back(std::move(run));
    }
  });
  return recorded;
}

std::map<std::string, Scene> ReadScenes(const std::filesystem::path& event_log) {
  std::map<std::string, Scene> scenes;
  ForEachEvent(event_log, [&](const std::string& channel, std::span<const std::uint8_t> bytes) {
    if (channel != channel::kScene) return;
    auto message = Decode<SceneMessage>(bytes, channel);
    if (message.ok) scenes.emplace(message.scene_id, std::move(message.scene));
  });
  return scenes;
}

std::filesystem::path FindEventLog(const std::filesystem::path& session_folder) {
  const auto fail = [&](const char* what) {
    throw InputError(session_folder.string() + " " + what);
  };
  if (!std::filesystem::is_directory(session_folder)) fail("is no folder");
  std::filesystem::path log;
  for (const auto& entry : std::filesystem::directory_iterator(session_folder)) {
    if (entry.path().extension() != ".lcmlog") continue;
    if (!log.empty()) fail("holds several .lcmlog files");
    log = entry.path();
  }
  if (log.empty()) fail("holds no .lcmlog file");
  return log;
}

}  // namespace planbench
