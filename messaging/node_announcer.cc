#include "messaging/node_announcer.h"

#include <unistd.h>

#include <chrono>
#include <climits>
#include <tuple>

#include "common/error.h"
#include "common/utime.h"
#include "common/version.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

constexpr std::chrono::milliseconds kPeriod{500};

std::string HostName() {
  char host[HOST_NAME_MAX + 1] = {};
  return gethostname(host, HOST_NAME_MAX) == 0 ? host : "unknown";
}

bool SameProcess(const NodeStatusMessage& a, const NodeStatusMessage& b) {
  return a.pid == b.pid && a.host == b.host && a.start_utime == b.start_utime;
}

}  // namespace

NodeStatusMessage MakeNodeStatus(const std::string& name, NodeKind kind) {
  RequireNodeName(name);
  NodeStatusMessage status;
  status.start_utime = NowUtime();
  status.name = name;
  status.kind = kind;
  status.host = HostName();
  status.pid = static_cast<std::int32_t>(getpid());
  status.version = Version();
  status.commit = Commit();
  return status;
}

NodeAnnouncer::NodeAnnouncer(Bus* bus, std::function<NodeStatusMessage()> status,
                             std::function<void()> also)
    : bus_(bus),
      status_(std::move(status)),
      also_(std::move(also)),
      self_(status_()),
      discover_(bus->Subscribe<DiscoverMessage>(channel::kDiscover,
                                                [this](const DiscoverMessage&) {
                                                  Announce();
                                                  if (also_) also_();
                                                })),
      statuses_(bus->Subscribe<NodeStatusMessage>(
          channel::kNodeStatus, [this](const NodeStatusMessage& other) { OnStatus(other); })),
      beat_([this] {
        std::unique_lock lock(mutex_);
        while (!stopping_) {
          lock.unlock();
          Announce();
          lock.lock();
          changed_.wait_for(lock, kPeriod, [this] { return stopping_; });
        }
      }) {
  // Brings an older process of this name to light at once.
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

void NodeAnnouncer::OnStatus(const NodeStatusMessage& other) {
  if (other.name != self_.name || SameProcess(other, self_)) return;
  const auto age_key = [](const NodeStatusMessage& s) {
    return std::tie(s.start_utime, s.host, s.pid);
  };
  // A recording played back on this bus shows processes of the past: they do not displace anybody.
  constexpr std::int64_t kStaleAfterUs = 10'000'000;
  if (NowUtime() - other.utime > kStaleAfterUs || age_key(self_) < age_key(other)) return;
  const std::scoped_lock lock(mutex_);
  displaced_by_ = "another session is on this LCM port: the " + std::string(EnumName(other.kind)) +
                  " '" + other.name + "' is live already (host " + other.host + ", pid " +
                  std::to_string(other.pid) +
                  "); choose another --name, or another port with --lcm-url";
}

void NodeAnnouncer::ThrowIfDisplaced() const {
  const std::scoped_lock lock(mutex_);
  if (!displaced_by_.empty()) throw InputError(displaced_by_);
}

}  // namespace planbench
