#include "logger/rebuild.h"

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "common/file_kind.h"
#include "logger/session_recorder.h"
#include "messaging/event_log_reader.h"

namespace planbench {

bool RebuildSession(const std::filesystem::path& event_log, const LoggerOptions& options) {
  if (!IsFile(event_log)) {
    throw InputError(event_log.string() + ": there is no such event log");
  }
  // Before a folder is made.
  if (!HoldsEvent(event_log)) {
    throw InputError(event_log.string() + ": there is no event of an LCM event log in it");
  }
  Contradictions contradictions;
  SessionRecorder recorder(
      options.out, options.resume, options.name, [](const std::string&, const AckMessage&) {},
      &contradictions, options.split_bytes);
  const std::vector<std::string> passed_over =
      ReadEventLog(event_log, [&](const ReceivedMessage& message) { recorder.Record(message); });
  recorder.Flush();
  for (const std::string& line : passed_over) spdlog::warn("{}", line);
  return recorder.Report();
}

}  // namespace planbench
