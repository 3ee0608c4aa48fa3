#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
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
/// or replayed status ends a process at work. Where the rival's clock tells another time than this
/// process's, how long each has been up decides, which their steady clocks tell. Such a status may
/// also be of a recording that is played back; but that goes at another speed, or comes from one
/// sender with those of others.
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
  /// Waits, while this process may still be displaced, as long as it is not known whether an older
  /// one that was heard lives; throws as ThrowIfDisplaced does.
  void AwaitPlace() const;

 private:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// An older process, as first heard.
  struct Rival {
    NodeStatusMessage status;
    TimePoint heard;
  };

  /// us since the Unix epoch, as when this process began to announce itself: of its steady clock,
  /// so that setting the time of day changes nobody's age.
  std::int64_t Utime(TimePoint time) const;
  void OnStatus(const NodeStatusMessage& other, const PacketSender& sender);
  /// Whether that, of the rival, tells that he lives; if not, he may be known anew by it. Holds
  /// mutex_.
  bool IsAnswer(const NodeStatusMessage& status, const PacketSender& sender, TimePoint now,
                bool clocks_agree);

  Bus* bus_;
  std::function<NodeStatusMessage()> status_;
  std::function<void()> also_;
  NodeStatusMessage self_;
  const TimePoint begun_ = std::chrono::steady_clock::now();
  const std::int64_t begun_utime_;
  const TimePoint established_;
  /// By sender the instance that it announces, "" if there are several: a player of recordings. For
  /// handlers only.
  std::map<PacketSender, std::string> instances_;
  std::optional<Rival> rival_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool stopping_ = false;
  std::string displaced_by_;
  Subscription discover_;
  Subscription statuses_;
  std::thread beat_;  // last: it may not be left running if the rest cannot be made
};

}  // namespace planbench
