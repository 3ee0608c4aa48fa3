#include "logger/session_recorder.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/file_kind.h"
#include "logger/session_json.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log_reader.h"
#include "results/bus_json.h"

namespace planbench {
namespace {

/// Where a message is acknowledged; null: it is not.
const char* AckChannel(const ReceivedMessage& message) {
  if (message.channel == channel::kRunRecord) return channel::kRunRecordAck;
  if (message.channel == channel::kSession) return channel::kSessionAck;
  return nullptr;
}

}  // namespace

SessionRecorder::SessionRecorder(const std::filesystem::path& folder, bool resume,
                                 std::string sender, Acknowledge acknowledge,
                                 Contradictions* contradictions,
                                 std::optional<std::uintmax_t> split_bytes)
    : folder_(folder, resume),
      sender_(std::move(sender)),
      acknowledge_(std::move(acknowledge)),
      contradictions_(contradictions),
      event_log_(folder_.event_log(), resume ? EventLog::Mode::kAppend : EventLog::Mode::kNew,
                 split_bytes),
      database_(folder_.results()) {
  if (!resume) return;
  // Not of a device or a pipe, which might never end.
  const bool has_log = IsFile(folder_.event_log());
  if (IsFile(folder_.run_json())) {
    bus_ = ReadBusJson(folder_.run_json());
  } else if (has_log && HoldsEvent(folder_.event_log())) {
    bus_ = kBusNotTold;
  }
  if (has_log) Restore();
}

void SessionRecorder::Restore() {
  const auto passed_over =
      ReadEventLog(folder_.event_log(), [this](const ReceivedMessage& message) {
        std::string id;
        Store(message, &id);  // what was refused when it came is again
      });
  for (const std::string& line : passed_over) spdlog::warn("{}", line);
  if (const auto lacked = tally_.runs + tally_.replacements; lacked > 0) {
    spdlog::warn("{} lacked {} run records of the event log: they are stored again",
                 folder_.results().string(), lacked);
  }
  tally_ = {};
  DescribeSessions();
}

void SessionRecorder::Record(const ReceivedMessage& message) {
  Log(message);
  Enter(message);
}

void SessionRecorder::Log(const ReceivedMessage& message) {
  event_log_.Write(message);
  // Before it is stored: wherever the process is killed, the database holds nothing that the log
  // lacks.
  if (AckChannel(message) != nullptr) Flush();
  ++tally_.events;
}

void SessionRecorder::Enter(const ReceivedMessage& message) {
  const char* ack_channel = AckChannel(message);
  if (ack_channel == nullptr) return;
  std::string id;
  const std::string refusal = Store(message, &id);
  if (refusal.empty() && message.channel == channel::kSession) DescribeSessions();
  folder_.RequireThere();
  if (refusal.empty()) {
    acknowledge_(ack_channel, AckMessage{id, sender_, true, ""});
    return;
  }
  ++tally_.failures;
  spdlog::error("{} '{}' cannot be stored: {}", message.channel, id, refusal);
  if (!id.empty()) acknowledge_(ack_channel, AckMessage{id, sender_, false, refusal});
}

void SessionRecorder::Flush() {
  event_log_.Flush();
  folder_.RequireThere();
}

void SessionRecorder::Recover() {
  folder_.RequireThere();
  event_log_.Reopen();
}

bool SessionRecorder::Report(const std::string& bus) {
  bus_ = AddBusJson(bus_, bus);
  is_bus_told_ = true;
  if (!bus.empty() || event_log_.num_files() > 1 || IsFile(folder_.run_json())) DescribeSessions();
  spdlog::info("recorded {} messages, {} runs ({} records came again, {} were replaced)",
               tally_.events, tally_.runs, tally_.repetitions, tally_.replacements);
  for (const IncompleteSession& session : database_.IncompleteSessions()) {
    spdlog::warn("session {} {} {} runs, of which {} are recorded here", session.run_id,
                 session.finished ? "finished with" : "has not finished and was to have",
                 session.num_runs, session.num_recorded);
  }
  if (tally_.failures > 0) {
    spdlog::error("{} run records or sessions could not be stored", tally_.failures);
  }
  return tally_.failures == 0;
}

void SessionRecorder::DescribeSessions() {
  WriteRunJson(folder_.run_json(), database_.Sessions(), event_log_.num_files(),
               is_bus_told_ ? bus_ : AddBusJson(bus_, kBusNotTold));
}

std::string SessionRecorder::Store(const ReceivedMessage& message, std::string* id) {
  try {
    if (message.channel == channel::kSession) {
      const auto session = Decode<SessionMessage>(message.bytes, message.channel);
      *id = SessionAckId(session);
      database_.Store(session);
    } else if (message.channel == channel::kRunRecord) {
      const auto record = Decode<RunRecordMessage>(message.bytes, message.channel);
      *id = RunRecordAckId(record);
      switch (database_.Store(record)) {
        case ResultsDatabase::Outcome::kStored:
          ++tally_.runs;
          break;
        case ResultsDatabase::Outcome::kReplaced:
          ++tally_.replacements;
          break;
        case ResultsDatabase::Outcome::kAlreadyStored:
          ++tally_.repetitions;
          break;
        case ResultsDatabase::Outcome::kContradicts:
          contradictions_->Note(message.sender, message.channel,
                                "another record of " + record.request_id + " than is stored");
          return "it contradicts the record that is stored of this run";
      }
    }
    return "";
  } catch (const MessageError& error) {
    *id = error.request_id();
    return error.what();
  } catch (const InputError& error) {
    return error.what();
  } catch (const SqliteError& error) {
    if (error.kind() != SqliteError::Kind::kConstraint) throw;
    return error.what();
  }
}

}  // namespace planbench
