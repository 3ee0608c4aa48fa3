#include "messaging/node_announcer.h"

#include <unistd.h>

#include <chrono>
#include <climits>
#include <tuple>

#include "common/error.h"
#include "common/random_id.h"
#include "common/utime.h"
#include "common/version.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

constexpr std::chrono::milliseconds kPeriod{500};

/// Whether only one of them can be on a bus.
bool AreRivals(const NodeStatusMessage& a, const NodeStatusMessage& b) {
  if (a.kind == b.kind && a.kind == NodeKind::kLogger) return false;
  return a.name == b.name || (a.kind == b.kind && a.kind == NodeKind::kSceneServer);
}

/// How one that has to go is told so.
std::string Displaced(const NodeStatusMessage& self, const NodeStatusMessage& older) {
  if (older.name != self.name) {
    return "another scene server, '" + older.name +
           "', is live on this bus; give it all folders of problems, or choose another port with "
           "--lcm-url";
  }
  return "another session is on this LCM port: the " + std::string(EnumName(older.kind)) + " '" +
         older.name + "' is live already (host " + older.host + ", pid " +
         std::to_string(older.pid) + "); choose " +
         (self.kind == NodeKind::kDriver ? "" : "another --name, or ") +
         "another port with --lcm-url";
}

}  // namespace

const std::string& HostName() {
  static const std::string name = [] {
    char host[HOST_NAME_MAX + 1] = {};
    return std::string(gethostname(host, HOST_NAME_MAX) == 0 ? host : "unknown");
  }();
  return name;
}

NodeStatusMessage MakeNodeStatus(const std::string& name, NodeKind kind) {
  RequireNodeName(name);
  NodeStatusMessage status;
  status.start_utime = NowUtime();
  status.instance = RandomId();
  status.name = name;
  status.kind = kind;
  status.host = HostName();
  status.pid = static_cast<std::int32_t>(getpid());
  status.version = Version();
  status.commit = Commit();
  return status;
}

NodeAnnouncer::NodeAnnouncer(Bus* bus, std::function<NodeStatusMessage()> status,
                             std::function<void()> also, std::chrono::milliseconds newcomer)
    : bus_(bus),
      status_(std::move(status)),
      also_(std::move(also)),
      self_(status_()),
      established_(std::chrono::steady_clock::now() + newcomer),
      discover_(bus->Subscribe<DiscoverMessage>(channel::kDiscover,
                                                [this](const DiscoverMessage&) {
                                                  Announce();
                                                  if (also_) also_();
                                                })),
      statuses_(bus->SubscribeFrom<NodeStatusMessage>(
          channel::kNodeStatus, [this](const NodeStatusMessage& other,
                                       const Origin& origin) { OnStatus(other, origin.sender); })),
      beat_([this] {
        std::unique_lock lock(mutex_);
        while (!stopping_) {
          changed_.wait_for(lock, kPeriod, [this] { return stopping_; });
          if (stopping_) return;
          lock.unlock();
          Announce();
          lock.lock();
        }
      }) {
  // Whatever else this process says comes after it has said who it is.
  Announce();
  // Brings an older rival to light at once.
  bus_->Publish(channel::kDiscover, DiscoverMessage{self_.name});
}

NodeAnnouncer::~NodeAnnouncer() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  beat_.join();
}

void NodeAnnouncer::Announce() {
  NodeStatusMessage status = status_();
  status.utime = NowUtime();
  bus_->Publish(channel::kNodeStatus, status);
}

void NodeAnnouncer::OnStatus(const NodeStatusMessage& other, const PacketSender& sender) {
  if (!AreRivals(other, self_) || other.instance == self_.instance) return;
  const auto age_key = [](const NodeStatusMessage& s) {
    return std::tie(s.start_utime, s.instance);
  };
  // A recording played back on this bus shows processes of the past: they do not displace anybody.
  constexpr std::int64_t kStaleAfterUs = 10'000'000;
  const bool is_established = std::chrono::steady_clock::now() >= established_;
  if (is_established || other.utime < NowUtime() - kStaleAfterUs) {
    bus_->contradictions().Note(sender, channel::kNodeStatus,
                                "claims to be the " + std::string(EnumName(other.kind)) + " '" +
                                    other.name + "', which this process is");
    return;
  }
  if (age_key(self_) < age_key(other)) return;  // it will go
  if (!rival_ || rival_->instance != other.instance) {
    rival_ = other;
    bus_->Publish(channel::kDiscover, DiscoverMessage{self_.name});
    return;
  }
  if (other.utime <= rival_->utime) return;
  const std::scoped_lock lock(mutex_);
  displaced_by_ = Displaced(self_, other);
}

void NodeAnnouncer::ThrowIfDisplaced() const {
  const std::scoped_lock lock(mutex_);
  if (!displaced_by_.empty()) throw InputError(displaced_by_);
}

}  // namespace planbench
