#include "bus_tools/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "bus_tools/traffic.h"
#include "common/error.h"
#include "common/text.h"
#include "common/utf8.h"
#include "common/version.h"
#include "messaging/any_message.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/lcm_url.h"
#include "messaging/multicast_receiver.h"
#include "messaging/network_interfaces.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Finding::Kind;

constexpr std::size_t kSmallBytes = 1000;
constexpr std::size_t kLargeBytes = 1'000'000;
/// What goes over any network in one piece.
constexpr std::size_t kOnePacketBytes = 1400;

/// How often everybody is asked to announce himself while the doctor listens, as a driver does that
/// waits for others: so there is something to lose.
constexpr std::chrono::milliseconds kAskPeriod{200};

/// All that is heard while it lives.
class Listener {
 public:
  /// `own_name`: by which this process asks others to announce themselves.
  Listener(Bus* bus, std::string own_name)
      : own_name_(std::move(own_name)),
        subscription_(
            bus->SubscribeToAll([this](const ReceivedMessage& m) { Take(m); }, kQueueCapacity)) {}

  struct Sender {
    std::string name;  ///< As announced; empty: not.
    std::size_t largest_bytes = 0;
  };
  struct Heard {
    /// By name, pid, host and address: hosts may have the same name, and containers the same pids.
    std::map<std::string, NodeStatusMessage> nodes;
    std::map<std::string, int> foreign;  ///< Channel to messages of unknown types.
    std::map<PacketSender, Sender> senders;
    std::optional<PacketSender> self;
  };
  Heard heard() const {
    const std::scoped_lock lock(mutex_);
    return heard_;
  }

 private:
  void Take(const ReceivedMessage& message) {
    const std::scoped_lock lock(mutex_);
    Sender& sender = heard_.senders[message.sender];
    sender.largest_bytes = std::max(sender.largest_bytes, message.bytes.size());
    try {
      if (!PrintAny(message.bytes, message.channel)) ++heard_.foreign[message.channel];
      if (message.channel == channel::kDiscover &&
          Decode<DiscoverMessage>(message.bytes, message.channel).sender == own_name_) {
        heard_.self = message.sender;
      }
      if (message.channel != channel::kNodeStatus) return;
      const auto status = Decode<NodeStatusMessage>(message.bytes, message.channel);
      sender.name = status.name;
      heard_.nodes[fmt::format("{}, pid {} on {}, {}", status.name, status.pid, status.host,
                               message.sender.Text())] = status;
    } catch (const MessageError&) {
      ++heard_.foreign[message.channel];
    }
  }

  std::string own_name_;
  mutable std::mutex mutex_;
  Heard heard_;
  Subscription subscription_;
};

Finding BufferFinding(const MulticastAddress& address, const std::string& url) {
  int most = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> most;
  const std::string mend = fmt::format("put recv_buf_size={} into the URL", kReceiveBufferBytes);
  if (address.receive_buffer_bytes < kReceiveBufferBytes) {
    return {Kind::kFault,
            fmt::format("receive buffer: {} asks for {} bytes, where messages of 1 MB need {}", url,
                        address.receive_buffer_bytes, kReceiveBufferBytes),
            mend};
  }
  if (most > 0 && most < address.receive_buffer_bytes) {
    return {Kind::kFault,
            fmt::format("receive buffer: the kernel grants {} of {} bytes", most,
                        address.receive_buffer_bytes),
            fmt::format("as root: sysctl -w net.core.rmem_max={}", address.receive_buffer_bytes)};
  }
  if (url.find("recv_buf_size=") == std::string::npos) {
    return {Kind::kNote,
            fmt::format("receive buffer: {} names none; planbench's processes ask for {} bytes, "
                        "other programs of LCM get the system's default",
                        url, kReceiveBufferBytes),
            mend};
  }
  return {Kind::kGood, fmt::format("receive buffer: {} bytes", address.receive_buffer_bytes), ""};
}

Finding ReachFinding(const MulticastAddress& address) {
  if (address.ttl == 0) return {Kind::kGood, "reach: ttl=0, messages stay on this machine", ""};
  const auto interface = InterfaceOfRoute(address.group);
  if (interface && interface->is_loopback) {
    return {Kind::kFault,
            fmt::format("reach: ttl={}, but the multicast route goes by '{}': messages stay on "
                        "this machine, and no other's are heard",
                        address.ttl, interface->name),
            MulticastRouteAdvice(address.ttl)};
  }
  const std::string way =
      interface ? fmt::format(" by '{}' (MTU {} bytes)", interface->name, interface->mtu_bytes)
                : "";
  return {Kind::kNote,
          fmt::format("reach: messages leave this machine{}, and others' can be heard", way),
          "put ttl=0 into the URL, unless processes run on several machines: on all of them it has "
          "to be the session's network, and the same MTU"};
}

/// What the senders' sequence numbers tell of the way from them to here, and what they do not.
std::vector<Finding> WayFindings(const Bus& bus, const MulticastAddress& address,
                                 const Listener::Heard& heard) {
  std::vector<Finding> findings;
  if (!heard.self) {
    findings.push_back({Kind::kFault, "way: what this process sends does not come back to it",
                        fmt::format("see that no firewall drops what is sent to {}:{}",
                                    address.group, address.port)});
  }
  std::int64_t num_received = 0;
  std::int64_t num_lost = 0;
  std::size_t largest_bytes = 0;
  int num_far = 0;
  int num_senders = 0;
  for (const auto& [sender, counters] : bus.senders()) {
    if (heard.self == sender) continue;
    const auto known = heard.senders.find(sender);
    const Listener::Sender said = known == heard.senders.end() ? Listener::Sender{} : known->second;
    const std::string who = said.name.empty()
                                ? sender.Text()
                                : fmt::format("{} ({})", Printable(said.name), sender.Text());
    const bool is_far = !IsOfThisMachine(sender.address);
    if (is_far && address.ttl == 0) {
      findings.push_back({Kind::kFault,
                          fmt::format("reach: {} is on another machine, which does not hear this "
                                      "one: ttl=0",
                                      who),
                          "put ttl=1 into the URL, or take another port"});
    }
    if (counters.lost > 0) {
      findings.push_back(
          {Kind::kFault,
           fmt::format("way: {} of {} messages from {} did not come", counters.lost,
                       counters.received + counters.lost, who),
           is_far ? "look for what loses packets on the way from that machine: Wi-Fi, a full link, "
                    "MTUs that differ (each machine's doctor tells its own)"
                  : "raise the receive buffer (above), or look for what keeps the machine busy"});
    }
    num_received += counters.received;
    num_lost += counters.lost;
    ++num_senders;
    if (!is_far) continue;
    ++num_far;
    largest_bytes = std::max(largest_bytes, said.largest_bytes);
  }
  if (num_senders > 0 && num_lost == 0) {
    findings.push_back({Kind::kGood,
                        fmt::format("way: none of {} messages from {} other processes was lost, {} "
                                    "of them on other machines",
                                    num_received, num_senders, num_far),
                        ""});
  }
  if (address.ttl == 0) return findings;
  if (num_far == 0) {
    findings.push_back(
        {Kind::kNote, "way: nobody on another machine was heard: nothing is known of the network",
         "if a process is live there, its doctor is to say the same ttl and the session's network "
         "(reach); a firewall may be in the way, or a switch that snoops IGMP and has no querier"});
  } else if (largest_bytes <= kOnePacketBytes) {
    findings.push_back({Kind::kNote,
                        fmt::format("way: from other machines came nothing larger than {} bytes: "
                                    "nothing is known of larger messages, as scenes are",
                                    largest_bytes),
                        "look once more while a session begins"});
  }
  return findings;
}

/// How many of its own messages a process of this machine gets: that tells of receive buffers and
/// of the processor, and of no network. On a port of its own, so that no session has to do with it.
class LoopBack {
 public:
  explicit LoopBack(const MulticastAddress& address)
      : bus_(fmt::format("udpm://{}:{}?ttl=0&recv_buf_size={}", address.group, FreeUdpPort(),
                         address.receive_buffer_bytes)) {
    bus_.Start();
  }

  Finding Measure(std::size_t bytes, int num, const std::string& what) {
    const std::vector<std::uint8_t> payload(bytes, 0);
    num_received_ = 0;
    // As fast as a busy session is: some 20 MB/s.
    const auto pause = std::chrono::microseconds(bytes / 20);
    for (int i = 0; i < num; ++i) {
      bus_.PublishBytes("BUS_DOCTOR", payload);
      std::this_thread::sleep_for(pause);
    }
    const auto deadline = Clock::now() + std::chrono::seconds(1);
    while (num_received_ < num && Clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const std::string text = fmt::format("loss within this machine: {} of {} {} arrived",
                                         num_received_.load(), num, what);
    if (num_received_ >= num) return {Kind::kGood, text, ""};
    const Bus::Counters counters = bus_.counters();
    return {Kind::kFault,
            fmt::format("{} ({} lost, {} came faster than they were read)", text, counters.lost,
                        counters.dropped),
            "raise the receive buffer (above), or look for what keeps the machine busy"};
  }

 private:
  std::atomic<int> num_received_ = 0;
  Bus bus_;
  Subscription subscription_ =
      bus_.SubscribeToAll([this](const ReceivedMessage&) { ++num_received_; }, kQueueCapacity);
};

/// Planners tell a version of their own, unless they are planbench's.
std::vector<Finding> VersionFindings(const std::map<std::string, NodeStatusMessage>& nodes) {
  std::set<std::string> programs;
  std::set<std::string> planners;
  for (const auto& [who, status] : nodes) {
    if (status.version == Version()) continue;
    const std::string version = Printable(status.version);
    if (status.kind == NodeKind::kPlanner) {
      planners.insert(fmt::format("{} ({})", Printable(status.name), version));
    } else {
      programs.insert(version);
    }
  }
  std::vector<Finding> findings;
  if (!programs.empty()) {
    findings.push_back({Kind::kFault,
                        fmt::format("versions: this is planbench {}, on the bus are also {}",
                                    Version(), fmt::join(programs, ", ")),
                        "run one version; messages of another are refused"});
  }
  if (!planners.empty()) {
    findings.push_back(
        {Kind::kNote,
         fmt::format("versions: planners not of planbench {}: {}", Version(),
                     fmt::join(planners, ", ")),
         "nothing, if they are planners of your own; those of planbench must be of one version"});
  }
  return findings;
}

/// Processes that stand in each other's way by their names, but loggers, which may be several.
std::vector<Finding> NameFindings(const std::map<std::string, NodeStatusMessage>& nodes) {
  std::map<std::string, int> processes;                   // by name
  std::map<std::string, std::set<std::string>> planners;  // by their channel
  for (const auto& [who, status] : nodes) {
    const bool may_be_several = status.kind == NodeKind::kLogger;
    const bool is_told_below = status.kind == NodeKind::kDriver;
    if (!may_be_several && !is_told_below) ++processes[status.name];
    if (status.kind != NodeKind::kPlanner) continue;
    planners[PlannerChannels(status.name).request].insert("'" + status.name + "'");
  }
  const std::string mend = "give each a --name of its own, or each session a port";
  std::vector<Finding> findings;
  for (const auto& [name, count] : processes) {
    if (count < 2) continue;
    findings.push_back(
        {Kind::kFault, fmt::format("names: {} processes are called '{}'", count, name), mend});
  }
  for (const auto& [channel, names] : planners) {
    if (names.size() < 2) continue;
    findings.push_back({Kind::kFault,
                        fmt::format("names: the planners {} share their channels ({}, ...)",
                                    fmt::join(names, " and "), channel),
                        mend});
  }
  return findings;
}

/// Robots that are not one and the same, though a session has one.
std::vector<Finding> RobotFindings(const std::map<std::string, NodeStatusMessage>& nodes) {
  std::map<std::string, std::set<std::string>> holders;  // by robot
  for (const auto& [who, status] : nodes) {
    if (status.robot_id.empty()) continue;
    holders[fmt::format("{} [{}]", Printable(status.robot_name),
                        Printable(FirstCharacters(status.robot_id, 8)))]
        .insert(fmt::format("{} on {}", Printable(status.name), Printable(status.host)));
  }
  if (holders.size() < 2) return {};
  std::vector<std::string> robots;
  for (const auto& [robot, names] : holders) {
    robots.push_back(fmt::format("{} of {}", robot, fmt::join(names, ", ")));
  }
  return {
      {Kind::kFault,
       fmt::format("robots: {} on one bus: {}", robots.size(), fmt::join(robots, "; ")),
       "start all with one --robot; where folders of one name differ in what they hold, copy one"}};
}

std::vector<Finding> NeighbourFindings(const Listener::Heard& heard) {
  std::vector<Finding> findings;
  std::vector<std::string> lines;
  int num_servers = 0;
  int num_drivers = 0;
  for (const auto& [who, status] : heard.nodes) {
    lines.push_back(fmt::format("  {} ({}), version {}", Printable(who), EnumName(status.kind),
                                Printable(status.version)));
    num_servers += status.kind == NodeKind::kSceneServer ? 1 : 0;
    num_drivers += status.kind == NodeKind::kDriver ? 1 : 0;
  }
  if (lines.empty()) {
    findings.push_back({Kind::kGood, "port: nobody of planbench is on it", ""});
  } else {
    findings.push_back(
        {Kind::kNote,
         fmt::format("port: {} processes on it:\n{}", lines.size(), fmt::join(lines, "\n")),
         "a session of your own wants another port (--lcm-url, or the driver's "
         "--launch, which takes a free one)"});
  }
  for (Finding& finding : NameFindings(heard.nodes)) findings.push_back(std::move(finding));
  if (num_servers > 1) {
    findings.push_back({Kind::kFault, fmt::format("scene servers: {} on one bus", num_servers),
                        "stop all but one: every session needs a port of its own"});
  }
  if (num_drivers > 1) {
    findings.push_back({Kind::kFault, fmt::format("drivers: {} on one bus", num_drivers),
                        "interrupt all but one (Ctrl-C): each session needs a port of its own "
                        "(--lcm-url), on which --resume goes on with it"});
  }
  for (Finding& finding : RobotFindings(heard.nodes)) findings.push_back(std::move(finding));
  for (Finding& finding : VersionFindings(heard.nodes)) findings.push_back(std::move(finding));
  for (const auto& [channel, count] : heard.foreign) {
    findings.push_back({Kind::kFault,
                        fmt::format("types: {} messages on {} are of no type of this version, or "
                                    "damaged",
                                    count, Printable(channel)),
                        "somebody speaks another version, or something else, on this port: take "
                        "another port"});
  }
  if (heard.foreign.empty()) {
    findings.push_back({Kind::kGood, "types: all messages heard are of this version", ""});
  }
  return findings;
}

}  // namespace

std::vector<Finding> Diagnose(const DiagnosisOptions& options) {
  const MulticastAddress address = MulticastAddress::Parse(options.lcm_url);
  std::vector<Finding> findings;
  std::unique_ptr<Bus> bus;
  try {
    bus = std::make_unique<Bus>(options.lcm_url);
  } catch (const InputError& error) {
    return {{Kind::kFault, error.what(), "see above: nothing else can be looked at before that"}};
  }
  findings.push_back({Kind::kGood, fmt::format("route: {} can be joined", options.lcm_url), ""});
  findings.push_back(ReachFinding(address));
  findings.push_back(BufferFinding(address, options.lcm_url));

  const std::string own_name = fmt::format("bus_doctor_{}", getpid());
  const Listener listener(bus.get(), own_name);
  bus->Start();
  for (const auto end = Clock::now() + options.listen; Clock::now() < end;) {
    bus->Publish(channel::kDiscover, DiscoverMessage{.sender = own_name});
    std::this_thread::sleep_for(std::min<Clock::duration>(kAskPeriod, end - Clock::now()));
  }
  const Listener::Heard heard = listener.heard();
  for (Finding& finding : NeighbourFindings(heard)) findings.push_back(std::move(finding));
  for (Finding& finding : WayFindings(*bus, address, heard)) findings.push_back(std::move(finding));
  LoopBack loop_back(address);
  findings.push_back(loop_back.Measure(kSmallBytes, options.num_small, "messages of 1 kB"));
  findings.push_back(loop_back.Measure(kLargeBytes, options.num_large, "messages of 1 MB"));
  return findings;
}

std::string FindingText(const Finding& finding) {
  const char* kind = finding.kind == Kind::kGood   ? "good "
                     : finding.kind == Kind::kNote ? "note "
                                                   : "FAULT";
  std::string text = fmt::format("{}  {}\n", kind, finding.text);
  if (!finding.mend.empty()) text += fmt::format("       -> {}\n", finding.mend);
  return text;
}

}  // namespace planbench
