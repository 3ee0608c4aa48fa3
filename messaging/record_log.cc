#include "messaging/record_log.h"

#include <map>
#include <string>
#include <utility>

#include "common/error.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log_reader.h"

namespace planbench {
namespace {

/// ReadEventLog, where a message that cannot be decoded is an error of the log.
template <typename Visit>
void ReadMessages(const std::filesystem::path& event_log, Visit visit) {
  ReadEventLog(event_log, [&](const ReceivedMessage& message) {
    try {
      visit(message);
    } catch (const MessageError& error) {
      throw InputError(event_log.string() + ": " + error.what());
    }
  });
}

}  // namespace

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  RecordedSession recorded;
  std::map<std::string, std::size_t> places;  // by request id
  ReadMessages(event_log, [&](const ReceivedMessage& message) {
    if (message.channel == channel::kSession) {
      recorded.sessions.push_back(Decode<SessionMessage>(message.bytes, message.channel));
    } else if (message.channel == channel::kRunRecord) {
      auto run = Decode<RunRecordMessage>(message.bytes, message.channel);
      const auto [place, is_new] = places.try_emplace(run.request_id, recorded.runs.size());
      if (is_new) {
        recorded.runs.push_back(std::move(run));
      } else if (RunRecordMessage& known = recorded.runs[place->second]; Replaces(run, known)) {
        known = std::move(run);
      }
    }
  });
  return recorded;
}

std::map<std::string, Scene> ReadScenes(const std::filesystem::path& event_log) {
  std::map<std::string, Scene> scenes;
  ReadMessages(event_log, [&](const ReceivedMessage& message) {
    if (message.channel != channel::kScene) return;
    auto answer = Decode<SceneMessage>(message.bytes, message.channel);
    if (answer.ok) scenes.emplace(answer.scene_id, std::move(answer.scene));
  });
  return scenes;
}

std::vector<std::filesystem::path> EventLogsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> logs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".lcmlog") logs.push_back(entry.path());
  }
  return logs;
}

std::filesystem::path FindEventLog(const std::filesystem::path& session_folder) {
  const auto fail = [&](const char* what) {
    throw InputError(session_folder.string() + " " + what);
  };
  if (!std::filesystem::is_directory(session_folder)) fail("is no folder");
  const std::vector<std::filesystem::path> logs = EventLogsIn(session_folder);
  if (logs.size() > 1) fail("holds several .lcmlog files");
  if (logs.empty()) fail("holds no .lcmlog file");
  return logs.front();
}

}  // namespace planbench
