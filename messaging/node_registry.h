#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "messaging/bus.h"
#include "messaging/messages.h"

namespace planbench {

/// Which nodes are live, by what they announce. A node unheard of for kLostAfter is gone.
/// Thread-safe.
class NodeRegistry {
 public:
  static constexpr std::chrono::milliseconds kLostAfter{3000};

  explicit NodeRegistry(Bus* bus);

  /// The live node of that name and kind.
  std::optional<NodeStatusMessage> Find(const std::string& name, NodeKind kind) const;
  std::vector<NodeStatusMessage> Live() const;
  std::vector<NodeStatusMessage> Live(NodeKind kind) const;
  /// What the scene server announced last.
  std::optional<ProblemSetsMessage> ProblemSets() const;

  /// Asks every node to announce itself.
  void Discover(const std::string& sender);
  /// Waits until `condition` holds (asked at every announcement and every 100 ms); false after
  /// `timeout`.
  bool WaitUntil(const std::function<bool()>& condition, std::chrono::milliseconds timeout);

 private:
  struct Entry {
    NodeStatusMessage status;
    std::chrono::steady_clock::time_point heard;
  };
  Bus* bus_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Entry> nodes_;  // by name
  std::optional<ProblemSetsMessage> problem_sets_;
  Subscription statuses_;
  Subscription sets_;
};

}  // namespace planbench
