#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messaging/bus.h"
#include "messaging/messages.h"

namespace planbench {

/// Which nodes are live, by what they announce. A node unheard of for kLostAfter is gone.
///
/// A node is the process that sends its announcements, whatever these say: while it is live nobody
/// else takes its name (for the scene server, of which there is one: its place). One who announces
/// himself under it is a rival, who takes it once the other has been silent for kRivalPatience
/// though everybody was asked: a process that was started again. Of one that is known to have ended
/// nobody need wait for that. Loggers do not stand in each
/// other's way. Thread-safe.
class NodeRegistry {
 public:
  static constexpr std::chrono::milliseconds kLostAfter{3000};
  static constexpr std::chrono::milliseconds kRivalPatience{750};

  using TimePoint = std::chrono::steady_clock::time_point;

  /// A live node, whom it sends from, and when he was first heard here: of several processes the
  /// order in which they came, which times of day, as they are announced, do not tell.
  struct Node {
    NodeStatusMessage status;
    PacketSender sender;
    TimePoint since;
  };

  explicit NodeRegistry(Bus* bus);

  /// The live node of that name and kind.
  std::optional<NodeStatusMessage> Find(const std::string& name, NodeKind kind) const;
  std::optional<Node> FindNode(const std::string& name, NodeKind kind) const;
  std::vector<NodeStatusMessage> Live() const;
  std::vector<NodeStatusMessage> Live(NodeKind kind) const;
  std::vector<Node> LiveNodes(NodeKind kind) const;
  /// What the scene server announced last.
  std::optional<ProblemSetsMessage> ProblemSets() const;

  /// Whether `sender` is the node of that kind and name, so that what it sent on `channel` is to be
  /// believed. Where it is neither that node nor its rival, that is noted as a contradiction.
  bool Believes(const PacketSender& sender, NodeKind kind, const std::string& name,
                const std::string& channel) const;

  /// That process is known to have ended: who comes in its place has its name at once. What it sent
  /// before may still bring it back, until it has been silent for kLostAfter.
  void Forget(const NodeStatusMessage& process);

  /// Asks every node to announce itself.
  void Discover(const std::string& sender);
  /// Waits until `condition` holds (asked at every announcement and every 100 ms); false after
  /// `timeout`.
  bool WaitUntil(const std::function<bool()>& condition, std::chrono::milliseconds timeout);

 private:
  using Key = std::pair<NodeKind, std::string>;
  struct Heard {
    Node node;
    TimePoint last;
  };
  struct Entry {
    Heard holder;
    std::optional<Heard> rival;
  };
  static Key KeyOf(NodeKind kind, const std::string& name, const std::string& instance);
  void OnStatus(const NodeStatusMessage& status, const PacketSender& sender);
  void OnProblemSets(const ProblemSetsMessage& sets, const PacketSender& sender);
  void ForgetTheDead(TimePoint now);
  /// The entry, in which the rival has taken the name if it is his by now; null if there is none.
  Entry* Settle(const Key& key, TimePoint now) const;

  Bus* bus_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  mutable std::map<Key, Entry> nodes_;
  std::optional<ProblemSetsMessage> problem_sets_;
  TimePoint asked_;  // when a rival last made us ask everybody
  Subscription statuses_;
  Subscription sets_;
};

}  // namespace planbench
