#include "messaging/node_announcer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <cmath>
#include <tuple>

#include "common/error.h"
#include "common/random_id.h"
#include "common/utime.h"
#include "common/version.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod{500};
/// Times of day that are further apart are of different clocks, us. Less than kNewcomer, so that
/// whoever is established when a newcomer comes is older by either measure.
constexpr double kClocksAgree = 2e6;
/// How long a rival whose clock tells another time has to be heard: in a recording every other
/// process, which the same sender would announce, is heard meanwhile.
constexpr std::chrono::milliseconds kTrial = kPeriod + std::chrono::milliseconds(100);
/// By how much his age may then differ from what has passed here, us.
constexpr double kDelay = 3e5;

/// Whether only one of them can be on a bus.
bool AreRivals(const NodeStatusMessage& a, const NodeStatusMessage& b) {
  if (a.kind == b.kind && a.kind == NodeKind::kLogger) return false;
  return a.name == b.name || (a.kind == b.kind && a.kind == NodeKind::kSceneServer);
}

/// Where one of two rivals can be beside the other.
std::string AnotherPlace(const NodeStatusMessage& node) {
  const bool is_one_of_a_kind =
      node.kind == NodeKind::kDriver || node.kind == NodeKind::kSceneServer;
  return std::string(is_one_of_a_kind ? "" : "another --name, or ") + "another port with --lcm-url";
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
         std::to_string(older.pid) + "); choose " + AnotherPlace(self);
}

/// What one that stays tells of a rival, or of a recording of one.
std::string Claims(const NodeStatusMessage& self, const NodeStatusMessage& other) {
  return fmt::format(
      "claims to be the {} '{}' (host {}, pid {}), which this process is{}; unless it ends by "
      "itself, end it, and choose {} for it, as for a recording that is played back",
      EnumName(other.kind), other.name, other.host, other.pid,
      other.name == self.name ? "" : fmt::format(", as '{}'", self.name), AnotherPlace(self));
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
      begun_utime_(NowUtime()),
      established_(begun_ + newcomer),
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
  status.utime = Utime(Clock::now());
  bus_->Publish(channel::kNodeStatus, status);
}

std::int64_t NodeAnnouncer::Utime(TimePoint time) const {
  return begun_utime_ +
         std::chrono::duration_cast<std::chrono::microseconds>(time - begun_).count();
}

void NodeAnnouncer::OnStatus(const NodeStatusMessage& other, const PacketSender& sender) {
  const TimePoint now = Clock::now();
  const bool is_established = now >= established_;
  if (!is_established) {
    std::string& instance = instances_.try_emplace(sender, other.instance).first->second;
    if (instance != other.instance) instance.clear();
  }
  if (!AreRivals(other, self_) || other.instance == self_.instance) return;
  if (is_established) {
    bus_->contradictions().Note(sender, channel::kNodeStatus, Claims(self_, other));
    return;
  }
  // In double, which whatever a stranger tells does not overflow.
  const auto utime = static_cast<double>(Utime(now)), others = static_cast<double>(other.utime);
  const bool clocks_agree = std::abs(utime - others) <= kClocksAgree;
  const bool is_older = clocks_agree ? std::tie(other.start_utime, other.instance) <
                                           std::tie(self_.start_utime, self_.instance)
                                     : others - static_cast<double>(other.start_utime) >
                                           utime - static_cast<double>(self_.start_utime);
  if (!is_older) return;  // it will go
  std::unique_lock lock(mutex_);
  if (!rival_ || rival_->status.instance != other.instance) {
    rival_ = {other, now};
    lock.unlock();
    bus_->Publish(channel::kDiscover, DiscoverMessage{self_.name});
    return;
  }
  if (!IsAnswer(other, sender, now, clocks_agree)) return;
  displaced_by_ = Displaced(self_, other);
  changed_.notify_all();
}

bool NodeAnnouncer::IsAnswer(const NodeStatusMessage& status, const PacketSender& sender,
                             TimePoint now, bool clocks_agree) {
  if (clocks_agree) return status.utime > rival_->status.utime;
  const double passed = std::chrono::duration<double, std::micro>(now - rival_->heard).count();
  const double aged = static_cast<double>(status.utime) - static_cast<double>(rival_->status.utime);
  if (std::abs(aged - passed) > kDelay) {
    rival_ = {status, now};
    return false;
  }
  return now - rival_->heard >= kTrial && !instances_.at(sender).empty();
}

void NodeAnnouncer::ThrowIfDisplaced() const {
  const std::scoped_lock lock(mutex_);
  if (!displaced_by_.empty()) throw InputError(displaced_by_);
}

void NodeAnnouncer::AwaitPlace() const {
  {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, established_, [this] { return !rival_ || !displaced_by_.empty(); });
  }
  ThrowIfDisplaced();
}

}  // namespace planbench
