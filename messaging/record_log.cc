#include "messaging/record_log.h"

#include <map>
#include <string>
#include <utility>

#include "common/error.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/decoded.h"
#include "messaging/event_log_reader.h"

namespace planbench {

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  RecordedSession recorded;
  std::map<std::string, std::size_t> places;  // by request id
  Decoded<SessionMessage> sessions(event_log, channel::kSession);
  Decoded<RunRecordMessage> runs(event_log, channel::kRunRecord);
  recorded.passed_over = ReadEventLog(event_log, [&](const ReceivedMessage& message) {
    if (auto session = sessions.Take(message)) recorded.sessions.push_back(*std::move(session));
    auto run = runs.Take(message);
    if (!run) return;
    const auto [place, is_new] = places.try_emplace(run->request_id, recorded.runs.size());
    if (is_new) {
      recorded.runs.push_back(*std::move(run));
    } else if (RunRecordMessage& known = recorded.runs[place->second]; Replaces(*run, known)) {
      known = *std::move(run);
    }
  });
  sessions.RequireAny();
  runs.RequireAny();
  sessions.TellPassedOver(&recorded.passed_over);
  runs.TellPassedOver(&recorded.passed_over);
  return recorded;
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
