#include "messaging/record_log.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/error.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log_reader.h"

namespace planbench {
namespace {

/// Decodes what a log holds of a channel, and counts what it cannot.
template <typename Message>
class Decoded {
 public:
  explicit Decoded(const char* channel) : channel_(channel) {}

  /// Nothing for a message of another channel, or one that is passed over.
  std::optional<Message> Take(const ReceivedMessage& message) {
    if (message.channel != channel_) return std::nullopt;
    try {
      auto decoded = Decode<Message>(message.bytes, message.channel);
      ++num_decoded_;
      return decoded;
    } catch (const MessageError& error) {
      if (num_passed_over_++ == 0) fault_ = error.what();
      return std::nullopt;
    }
  }

  /// Adds a line if anything was passed over. Throws InputError if everything was.
  void TellPassedOver(const std::filesystem::path& event_log,
                      std::vector<std::string>* lines) const {
    if (num_passed_over_ == 0) return;
    if (num_decoded_ == 0) throw InputError(event_log.string() + ": " + fault_);
    lines->push_back(
        num_passed_over_ == 1
            ? fmt::format("{}: one message is passed over: {}", event_log.string(), fault_)
            : fmt::format("{}: {} messages are passed over, the first: {}", event_log.string(),
                          num_passed_over_, fault_));
  }

 private:
  const char* channel_;
  int num_decoded_ = 0;
  int num_passed_over_ = 0;
  std::string fault_;  ///< Of the first.
};

}  // namespace

RecordedSession ReadRecords(const std::filesystem::path& event_log) {
  RecordedSession recorded;
  std::map<std::string, std::size_t> places;  // by request id
  Decoded<SessionMessage> sessions(channel::kSession);
  Decoded<RunRecordMessage> runs(channel::kRunRecord);
  ReadEventLog(event_log, [&](const ReceivedMessage& message) {
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
  sessions.TellPassedOver(event_log, &recorded.passed_over);
  runs.TellPassedOver(event_log, &recorded.passed_over);
  return recorded;
}

std::map<std::string, Scene> ReadScenes(const std::filesystem::path& event_log) {
  std::map<std::string, Scene> scenes;
  ReadEventLog(event_log, [&](const ReceivedMessage& message) {
    if (message.channel != channel::kScene) return;
    try {
      auto answer = Decode<SceneMessage>(message.bytes, message.channel);
      if (answer.ok) scenes.emplace(answer.scene_id, std::move(answer.scene));
    } catch (const MessageError& error) {
      throw InputError(event_log.string() + ": " + error.what());
    }
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
