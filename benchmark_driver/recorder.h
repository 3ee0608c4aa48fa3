#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "benchmark_driver/record_spool.h"
#include "messaging/bus.h"
#include "messaging/node_registry.h"

namespace planbench {

/// Hands a session and its run records to the loggers, to each all of them: repeats what one has
/// not acknowledged, keeps it while none is live, and brings up to date whoever comes later. Says
/// once that nobody records, and once that somebody does again. Thread-safe.
class Recorder {
 public:
  /// How long a live logger may acknowledge nothing new before it is no longer waited for.
  std::chrono::milliseconds silence_patience{10'000};
  /// How long it is waited at the end for a logger that was there to come back.
  std::chrono::milliseconds return_patience{15'000};

  /// `folder`: RecordSpool's.
  Recorder(Bus* bus, NodeRegistry* registry, const std::filesystem::path& folder);

  /// Returns once every live logger has stored the record and all before it, or is in trouble or
  /// silent. Throws std::runtime_error if one that was kept in a file cannot be read.
  void Record(const RunRecordMessage& record);
  /// The session as it is now; returns as above.
  void Record(const SessionMessage& session);
  /// Delivers what is left, waiting for loggers to come back. True if one has every record and the
  /// session as it is.
  bool Complete();

  /// Records that the logger with the most of them does not have; for tests.
  std::size_t num_unrecorded() const;
  /// What is not recorded and why, in lines for each logger that lacks something; empty if nothing
  /// is. In records, of which a run that was repeated has several.
  std::vector<std::string> Shortcomings() const;

 private:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// One who writes to a folder: a logger that is started again there goes on where it was.
  struct Logger {
    std::string name;
    std::string place;
    PacketSender sender;
    TimePoint since;  ///< NodeRegistry::Node's.
    bool live = false;
    bool silent = false;
    std::string trouble;
    std::size_t next = 0;          ///< It has all records before, ...
    std::set<std::size_t> beyond;  ///< ... and these.
    std::map<std::size_t, std::string> refused;
    std::string session;  ///< SessionAckId of the last that it has, or has refused.
    std::optional<std::string> session_refusal;  ///< Why, if it has.

    bool Takes() const { return live && trouble.empty(); }
    bool Has(std::size_t index) const { return index < next || beyond.contains(index); }
    std::size_t Count() const { return next + beyond.size() - refused.size(); }
  };

  void OnAck(const AckMessage& ack, const Origin& origin);
  /// Waits until the loggers have everything; `wait_for_return`: also for those that have gone.
  void Deliver(std::unique_lock<std::mutex>* lock, bool wait_for_return);
  void LookAround();
  /// Sends what a logger lacks and is due; false if none lacks anything.
  bool SendDue(TimePoint now);
  bool Lacks(const Logger& logger) const;
  const Logger* Best() const;

  Bus* bus_;
  NodeRegistry* registry_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  RecordSpool spool_;
  std::map<std::string, Logger> loggers_;       // by host and folder
  std::map<std::size_t, TimePoint> sent_;       // records that somebody lacks: when last
  std::map<std::string, std::size_t> awaited_;  // their ids
  std::optional<SessionMessage> session_;
  TimePoint session_sent_;
  std::uint64_t num_acks_ = 0;
  bool nobody_ = false;  // records, and that has been said
  Subscription record_acks_;
  Subscription session_acks_;
};

}  // namespace planbench
