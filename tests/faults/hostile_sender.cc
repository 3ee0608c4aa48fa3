#include "tests/faults/hostile_sender.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <iterator>

#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/multicast_receiver.h"
#include "messaging/node_announcer.h"

namespace planbench {
namespace {

constexpr char kPlanRequest[] = "PLAN_REQUEST_";

/// A packet of LCM's protocol as far as its first bytes go, random in the rest.
std::vector<std::uint8_t> OddPacket(std::mt19937_64* random) {
  std::vector<std::uint8_t> packet((*random)() % 200);
  for (std::uint8_t& byte : packet) byte = static_cast<std::uint8_t>((*random)());
  const std::string magic = (*random)() % 2 == 0 ? "LC02" : "LC03";
  // A fragment, the first of many, of a message of 256 MB; its place is behind magic and number.
  constexpr std::uint8_t kFragment[] = {0x0f, 0xff, 0xff, 0xff, 0,    0,   0,
                                        0,    0,    0,    0x0f, 0xff, 'A', 0};
  constexpr std::size_t kPlace = 8;
  if (packet.size() < kPlace + std::size(kFragment) || (*random)() % 3 == 0) return packet;
  std::copy(magic.begin(), magic.end(), packet.begin());
  if (magic == "LC03") {
    std::copy(std::begin(kFragment), std::end(kFragment), packet.begin() + kPlace);
  }
  return packet;
}

}  // namespace

HostileSender::HostileSender(const std::string& url, std::uint64_t seed)
    : bus_(url),
      everything_(bus_.SubscribeToAll(
          [this](const ReceivedMessage& message) { OnMessage(message); }, 10'000)),
      packets_([this, url, seed] { SendPackets(url, seed); }) {
  bus_.Start();
}

HostileSender::~HostileSender() {
  stopping_ = true;
  packets_.join();
}

template <typename Message>
void HostileSender::Forge(const std::string& channel, const Message& message) {
  bus_.Publish(channel, message);
  ++num_forged_;
}

void HostileSender::OnMessage(const ReceivedMessage& heard) {
  const auto is = [&](const char* channel) { return heard.channel == channel; };
  if (is(channel::kNodeStatus)) {
    auto status = Decode<NodeStatusMessage>(heard.bytes, heard.channel);
    if (status.instance == "forged") return;
    // A process that has just come gives way to whoever seems to have its name.
    const auto now = std::chrono::steady_clock::now();
    const auto first = first_heard_.emplace(status.instance, now).first->second;
    if (now < first + NodeAnnouncer::kNewcomer + std::chrono::seconds(2)) return;
    status.instance = "forged";
    status.start_utime = 0;
    Forge(heard.channel, status);
  } else if (is(channel::kProblemRequest)) {
    ProblemMessage denial;
    denial.request_id = Decode<ProblemRequestMessage>(heard.bytes, heard.channel).request_id;
    denial.ok = false;
    denial.message = "forged";
    Forge(channel::kProblem, denial);
  } else if (is(channel::kPathCheckRequest)) {
    PathCheckReplyMessage verdict;
    verdict.request_id = Decode<PathCheckRequestMessage>(heard.bytes, heard.channel).request_id;
    verdict.ok = true;
    verdict.verdict.emplace();
    verdict.verdict->valid = false;
    verdict.verdict->reason = "forged";
    Forge(channel::kPathCheckReply, verdict);
  } else if (heard.channel.starts_with(kPlanRequest)) {
    const auto request = Decode<PlanRequest>(heard.bytes, heard.channel);
    const std::string planner = heard.channel.substr(sizeof(kPlanRequest) - 1);
    PlanResultMessage result;
    result.planner = planner;
    result.run_id = request.run_id;
    result.request_id = request.request_id;
    result.result.status = PlanStatus::kExhausted;
    result.result.planning_time_s = kForgedTime;
    Forge("PLAN_RESULT_" + planner, result);
    Forge("PLAN_ACK_" + planner,
          PlanAckMessage{planner, request.request_id, PlanAckVerdict::kRefused, "forged"});
    Forge("PLAN_CANCEL_" + planner, PlanCancelMessage{request.request_id});
  } else if (is(channel::kRunRecord)) {
    auto record = Decode<RunRecordMessage>(heard.bytes, heard.channel);
    if (record.message == "forged") return;
    record.message = "forged";
    record.status = PlanStatus::kTimedOut;
    record.result.result.planning_time_s = kForgedTime;
    Forge(heard.channel, record);
    record.request_id += "0";  // one that was never made
    Forge(heard.channel, record);
    Forge(channel::kRunRecordAck, AckMessage{record.request_id, "logger", true, ""});
    Forge(channel::kRunRecordAck, AckMessage{record.request_id, "logger", false, "forged"});
  } else if (is(channel::kSession)) {
    auto session = Decode<SessionMessage>(heard.bytes, heard.channel);
    if (session.host == "forged") return;
    Forge(channel::kSessionAck, AckMessage{SessionAckId(session), "logger", true, ""});
    session.host = "forged";
    session.finished = true;
    session.total_time_s = 1e6;
    Forge(heard.channel, session);
  }
}

void HostileSender::SendPackets(const std::string& url, std::uint64_t seed) {
  const MulticastAddress address = MulticastAddress::Parse(url);
  sockaddr_in to = {};
  to.sin_family = AF_INET;
  to.sin_port = htons(address.port);
  inet_pton(AF_INET, address.group.c_str(), &to.sin_addr);
  const int socket_fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const unsigned char ttl = 0;
  setsockopt(socket_fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  std::mt19937_64 random(seed);
  while (!stopping_) {
    const std::vector<std::uint8_t> packet = OddPacket(&random);
    sendto(socket_fd, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof(to));
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + random() % 10));
  }
  close(socket_fd);
}

}  // namespace planbench
