#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "messaging/bus.h"
#include "messaging/messages.h"

namespace planbench {

/// Of this machine, as processes announce it.
const std::string& HostName();

/// Who this process is: host, pid, version, commit, start time and a new instance id filled in, the
/// rest as given.
NodeStatusMessage MakeNodeStatus(const std::string& name, NodeKind kind);

/// Announces this process on NODE_STATUS at 2 Hz and whenever asked on DISCOVER, and watches for
/// rivals: other processes of the same name, or other scene servers. Of two, the older stays: only
/// who has just come may be displaced, and only by one that answers when asked, so that no forged
/// or replayed status ends a process at work.
class NodeAnnouncer {
 public:
  /// How long after it has come a process may be displaced.
  static constexpr std::chrono::seconds kNewcomer{3};

  /// Announces at once. `status` is called on the announcer's threads; it must be thread-safe.
  /// `also`, if given, is called after every DISCOVER (to announce more).
  NodeAnnouncer(Bus* bus, std::function<NodeStatusMessage()> status,
                std::function<void()> also = nullptr,
                std::chrono::milliseconds newcomer = kNewcomer);
  ~NodeAnnouncer();

  /// Announces now (on a change of state).
  void Announce();
  /// Throws InputError once an older rival has been heard.
  void ThrowIfDisplaced() const;

 private:
  void OnStatus(const NodeStatusMessage& other, const PacketSender& sender);

  Bus* bus_;
  std::function<NodeStatusMessage()> status_;
  std::function<void()> also_;
  NodeStatusMessage self_;
  const std::chrono::steady_clock::time_point established_;
  std::optional<NodeStatusMessage> rival_;  // heard once; for handlers only
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::string displaced_by_;
  Subscription discover_;
  Subscription statuses_;
  std::thread beat_;  // last: it may not be left running if the rest cannot be made
};

}  // namespace planbench
