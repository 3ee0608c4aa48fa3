#include "logger/rebuild.h"

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "common/file_kind.h"
#include "logger/session_recorder.h"
#include "messaging/event_log_files.h"
#include "messaging/event_log_reader.h"

namespace planbench {

bool RebuildSession(const std::filesystem::path& event_log, const LoggerOptions& options) {
  if (!IsFile(event_log)) {
    throw InputError(event_log.string() + ": there is no such event log");
  }
  EventLogFiles(event_log);  // complete, before a folder is made
  Contradictions contradictions;
  SessionRecorder recorder(
      options.out, options.resume, options.name, [](const std::string&, const AckMessage&) {},
      &contradictions, options.split_bytes);
  const std::vector<std::string> not_read =
      ReadEventLog(event_log, [&](const ReceivedMessage& message) { recorder.Record(message); });
  recorder.Flush();
  for (const std::string& line : not_read) spdlog::warn("{}", line);
  return recorder.Report();
}

}  // namespace planbench
