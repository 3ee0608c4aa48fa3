#include "messaging/record_log.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/decoded.h"

namespace planbench {

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  RecordedSession recorded;
  std::map<std::string, std::size_t> indices;  // by request id
  Decoded<SessionMessage> sessions(event_log, channel::kSession);
  Decoded<RunRecordMessage> runs(event_log, channel::kRunRecord);
  recorded.passed_over = ReadEventLog(event_log, [&](const LoggedMessage& message) {
    if (auto session = sessions.Take(message)) recorded.sessions.push_back(*std::move(session));
    const auto record = runs.Take(message);
    if (!record) return;
    RecordedRun run = {record->run_id, record->request_id, StandingOf(*record), message.place};
    const auto [index, is_new] = indices.try_emplace(run.request_id, recorded.runs.size());
    if (is_new) {
      recorded.runs.push_back(std::move(run));
    } else if (RecordedRun& known = recorded.runs[index->second];
               Replaces(run.standing, known.standing)) {
      known = std::move(run);
    }
  });
  sessions.RequireAny();
  runs.RequireAny();
  sessions.TellPassedOver(&recorded.passed_over);
  runs.TellPassedOver(&recorded.passed_over);
  return recorded;
}

RunRecordMessage ReadRecord(const EventPlace& place) {
  try {
    return Decode<RunRecordMessage>(ReadEventBytes(place), channel::kRunRecord);
  } catch (const MessageError& error) {
    throw InputError(
        fmt::format("{}: was changed while it was read: {}", place.file->string(), error.what()));
  }
}

SessionMessage LastTold(const RecordedSession& recorded, const std::string& run_id) {
  SessionMessage last;
  for (const SessionMessage& session : recorded.sessions) {
    if (session.run_id == run_id) last = session;
  }
  return last;
}

std::map<std::string, Scene> ReadScenes(const std::filesystem::path& event_log,
                                        std::vector<std::string>* passed_over) {
  std::map<std::string, Scene> scenes;
  Decoded<SceneMessage> answers(event_log, channel::kScene);
  ReadEventLog(event_log, [&](const ReceivedMessage& message) {
    auto answer = answers.Take(message);
    if (answer && answer->ok) scenes.emplace(answer->scene_id, std::move(answer->scene));
  });
  answers.RequireAny();
  answers.TellPassedOver(passed_over);
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
