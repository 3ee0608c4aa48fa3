#include "bus_tools/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "bus_tools/traffic.h"
#include "common/error.h"
#include "common/text.h"
#include "common/version.h"
#include "messaging/any_message.h"
#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/multicast_receiver.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Finding::Kind;

constexpr std::size_t kSmallBytes = 1000;
constexpr std::size_t kLargeBytes = 1'000'000;

/// All that is heard while it lives.
class Listener {
 public:
  Listener(Bus* bus, std::string own_channel)
      : own_channel_(std::move(own_channel)),
        subscription_(
            bus->SubscribeToAll([this](const ReceivedMessage& m) { Take(m); }, kQueueCapacity)) {}

  int num_own() const { return num_own_; }

  struct Heard {
    std::map<std::string, NodeStatusMessage> nodes;  ///< By name, host and pid.
    std::map<std::string, int> foreign;              ///< Channel to messages of unknown types.
  };
  Heard heard() const {
    const std::scoped_lock lock(mutex_);
    return heard_;
  }

 private:
  void Take(const ReceivedMessage& message) {
    if (message.channel == own_channel_) {
      ++num_own_;
      return;
    }
    const std::scoped_lock lock(mutex_);
    try {
      if (!PrintAny(message.bytes, message.channel)) ++heard_.foreign[message.channel];
      if (message.channel != channel::kNodeStatus) return;
      const auto status = Decode<NodeStatusMessage>(message.bytes, message.channel);
      heard_.nodes[fmt::format("{}, pid {} on {}", status.name, status.pid, status.host)] = status;
    } catch (const MessageError&) {
      ++heard_.foreign[message.channel];
    }
  }

  std::string own_channel_;
  std::atomic<int> num_own_ = 0;
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
  return {Kind::kNote, "reach: messages leave this machine, and others' are heard",
          "put ttl=0 into the URL, unless processes run on several machines"};
}

Finding LossFinding(const Bus& bus, const std::string& what, int sent, int received) {
  if (received >= sent) {
    return {Kind::kGood, fmt::format("loss: {} of {} {} arrived", received, sent, what), ""};
  }
  const Bus::Counters counters = bus.counters();
  return {Kind::kFault,
          fmt::format("loss: {} of {} {} arrived ({} lost, {} came faster than they were read)",
                      received, sent, what, counters.lost, counters.dropped),
          "raise the receive buffer (above), or look for what keeps the machine busy"};
}

void MeasureLoss(Bus* bus, const Listener& listener, const std::string& channel, std::size_t bytes,
                 int num, const std::string& what, std::vector<Finding>* findings) {
  const std::vector<std::uint8_t> payload(bytes, 0);
  const int before = listener.num_own();
  // As fast as a busy session is: some 20 MB/s.
  const auto pause = std::chrono::microseconds(bytes / 20);
  for (int i = 0; i < num; ++i) {
    bus->PublishBytes(channel, payload);
    std::this_thread::sleep_for(pause);
  }
  const auto deadline = Clock::now() + std::chrono::seconds(1);
  while (listener.num_own() - before < num && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  findings->push_back(LossFinding(*bus, what, num, listener.num_own() - before));
}

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
    if (status.kind != NodeKind::kLogger) ++processes[status.name];
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

std::vector<Finding> NeighbourFindings(const Listener::Heard& heard) {
  std::vector<Finding> findings;
  std::vector<std::string> lines;
  int num_servers = 0;
  for (const auto& [who, status] : heard.nodes) {
    lines.push_back(fmt::format("  {} ({}), version {}", Printable(who), EnumName(status.kind),
                                Printable(status.version)));
    num_servers += status.kind == NodeKind::kSceneServer ? 1 : 0;
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

  const std::string own_channel = fmt::format("BUS_DOCTOR_{}", getpid());
  const Listener listener(bus.get(), own_channel);
  bus->Start();
  bus->Publish(channel::kDiscover, DiscoverMessage{.sender = own_channel});
  std::this_thread::sleep_for(options.listen);
  for (Finding& finding : NeighbourFindings(listener.heard())) {
    findings.push_back(std::move(finding));
  }
  MeasureLoss(bus.get(), listener, own_channel, kSmallBytes, options.num_small, "messages of 1 kB",
              &findings);
  MeasureLoss(bus.get(), listener, own_channel, kLargeBytes, options.num_large, "messages of 1 MB",
              &findings);
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
