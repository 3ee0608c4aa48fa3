#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "messaging/bus.h"
#include "messaging/node_registry.h"

namespace planbench {

/// Hands sessions and run records to the logger: repeats each until it is acknowledged, and says
/// loudly when nobody records. Thread-safe.
class Recorder {
 public:
  Recorder(Bus* bus, NodeRegistry* registry);

  /// Returns once the logger has stored it, or refused it, or while no logger is live, or after
  /// kPatience of silence. The last three count as not recorded.
  static constexpr std::chrono::seconds kPatience{30};
  void Record(const RunRecordMessage& record);
  void Record(const SessionMessage& session);

  int num_unrecorded() const { return num_unrecorded_; }

 private:
  void Deliver(const std::string& id, const std::function<void()>& send);
  void OnAck(const AckMessage& ack);

  Bus* bus_;
  NodeRegistry* registry_;
  std::atomic<int> num_unrecorded_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::optional<AckMessage>> pending_;  // by id
  Subscription record_acks_;
  Subscription session_acks_;
};

}  // namespace planbench
