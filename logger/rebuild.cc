#include "logger/rebuild.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <string>
#include <system_error>
#include <vector>

#include "common/file_kind.h"
#include "logger/session_recorder.h"
#include "messaging/event_log_reader.h"
#include "messaging/record_log.h"
#include "results/bus_json.h"

namespace planbench {
namespace {

/// Whether the log is in the folder that it is to be added to: it would grow by what is read of it,
/// without end.
bool IsAddedToItself(const std::filesystem::path& event_log, const LoggerOptions& options) {
  if (!options.resume) return false;
  std::error_code ignored;  // a folder that is yet to be made
  return std::filesystem::equivalent(std::filesystem::canonical(event_log).parent_path(),
                                     options.out, ignored);
}

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
  if (IsAddedToItself(event_log, options)) {
    throw InputError(
        fmt::format("{}: is that of --out itself; what the database there lacks of it "
                    "is stored by logger --out {} --resume",
                    event_log.string(), options.out.string()));
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
