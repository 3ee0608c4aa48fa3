#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "logger/message_queue.h"
#include "logger/results_database.h"
#include "logger/session_folder.h"
#include "messaging/contradictions.h"
#include "messaging/event_log.h"

namespace planbench {

/// What a logger has done.
struct RecorderTally {
  std::int64_t events = 0;        ///< Written to the event log.
  std::int64_t runs = 0;          ///< Of which the database had no record.
  std::int64_t replacements = 0;  ///< Run records that took the place of others.
  std::int64_t repetitions = 0;   ///< Run records that were stored already.
  std::int64_t failures = 0;      ///< Run records and sessions that could not be stored.
};

/// Writes messages into a session folder: each into the event log; run records and sessions,
/// wherever they come from (a live driver or a replay), into results.sqlite and run.json. Not
/// thread-safe.
class SessionRecorder {
 public:
  /// Publishes an acknowledgement on a channel.
  using Acknowledge = std::function<void(const std::string& channel, const AckMessage& ack)>;

  /// `sender`: name in the acknowledgements. `contradictions` is told of records that contradict
  /// what is stored. `split_bytes`: EventLog's. With `resume`, the database is brought up to date
  /// with the event log. Throws InputError if the folder cannot be used.
  SessionRecorder(const std::filesystem::path& folder, bool resume, std::string sender,
                  Acknowledge acknowledge, Contradictions* contradictions,
                  std::optional<std::uintmax_t> split_bytes = {});

  /// Log, then Enter.
  void Record(const ReceivedMessage& message);
  /// Writes a message into the event log, flushed if there is more to do with it. Throws
  /// std::runtime_error if the folder cannot be written (disk full, removed).
  void Log(const ReceivedMessage& message);
  /// Stores what was logged, if it is a run record or session, and acknowledges it once the
  /// database is committed, or with ok = false if it can never be stored. Throws like Log, also
  /// while another program keeps the database locked; then nothing is acknowledged, and it may be
  /// called again.
  void Enter(const ReceivedMessage& message);
  /// Hands what was written to the operating system. Throws like Log.
  void Flush();
  /// To be called after a failure, before anything else. Throws like Log.
  void Recover();

  /// Logs what was recorded, and which sessions have fewer runs here than they tell of. `bus`: what
  /// was odd on it since the recorder began (results/bus_json.h); until then run.json tells that it
  /// is not known, which stands if the process is killed. True if every run record and session that
  /// came could be stored.
  bool Report(const std::string& bus = "");

  const SessionFolder& folder() const { return folder_; }
  const RecorderTally& tally() const { return tally_; }

 private:
  /// Stores what the database lacks of the event log: that of a session that is resumed may have
  /// been lost or removed.
  void Restore();
  /// Puts a run record or session into the database; nothing of another message. `id`: that of its
  /// acknowledgement, as far as it could be read. Returns why it can never be stored, "" if it is.
  /// Throws SqliteError if the database fails.
  std::string Store(const ReceivedMessage& message, std::string* id);
  void DescribeSessions();

  SessionFolder folder_;
  std::string sender_;
  Acknowledge acknowledge_;
  Contradictions* contradictions_;
  EventLog event_log_;
  ResultsDatabase database_;
  RecorderTally tally_;
  std::string bus_;           ///< Of the parts of the session before, and of this one at its end.
  bool is_bus_told_ = false;  ///< Of this one.
};

}  // namespace planbench
