#include "logger/rebuild.h"

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "common/file_kind.h"
#include "logger/session_recorder.h"
#include "messaging/event_log_reader.h"
#include "messaging/record_log.h"
#include "results/bus_json.h"

namespace planbench {
namespace {

/// What run.json tells of the bus of a log that is the one of its folder (results/bus_json.h).
std::string BusOf(const std::filesystem::path& event_log) {
  const auto file = std::filesystem::absolute(event_log);
  const auto run_json = std::filesystem::path(file).replace_filename("run.json");
  if (!IsFile(run_json) || EventLogsIn(file.parent_path()) != std::vector{file}) return kBusNotTold;
  try {
    return ReadBusJson(run_json);
  } catch (const InputError& error) {
    spdlog::warn("what was lost on the bus is not known: {}", error.what());
    return kBusNotTold;
  }
}

}  // namespace

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
  return recorder.Report(BusOf(event_log));
}

}  // namespace planbench
