#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "messaging/bus.h"
#include "messaging/messages.h"

namespace planbench {

/// Who this process is: host, pid, version, commit and start time filled in, the rest as given.
NodeStatusMessage MakeNodeStatus(const std::string& name, NodeKind kind);

/// Announces this process on NODE_STATUS at 2 Hz and whenever asked on DISCOVER, and watches for
/// another process of the same name: of two, the older stays.
class NodeAnnouncer {
 public:
  /// `status` is called on the announcer's threads; it must be thread-safe. `also`, if given, is
  /// called after every DISCOVER (to announce more).
  NodeAnnouncer(Bus* bus, std::function<NodeStatusMessage()> status,
                std::function<void()> also = nullptr);
  ~NodeAnnouncer();

  /// Announces now (on a change of state).
  void Announce();
  /// Throws InputError once an older process of the same name has been heard.
  void ThrowIfDisplaced() const;

 private:
  void OnStatus(const NodeStatusMessage& other);

  Bus* bus_;
  std::function<NodeStatusMessage()> status_;
  std::function<void()> also_;
  NodeStatusMessage self_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::string displaced_by_;
  Subscription discover_;
  Subscription statuses_;
  std::thread beat_;  // last: it may not be left running if the rest cannot be made
};

}  // namespace planbench
