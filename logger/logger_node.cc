#include "logger/logger_node.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <vector>

#include "logger/session_json.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

NodeStatusMessage Describe(const LoggerOptions& options) {
  NodeStatusMessage status = MakeNodeStatus(options.name, NodeKind::kLogger);
  status.settings["out"] = SessionFolder::AbsolutePath(options.out).string();
  return status;
}

}  // namespace

LoggerNode::LoggerNode(Bus* bus, const LoggerOptions& options)
    : bus_(bus),
      status_(Describe(options)),
      queue_(options.queue_bytes),
      recorder_(
          options.out, options.resume, options.name,
          [bus](const std::string& channel, const AckMessage& ack) { bus->Publish(channel, ack); },
          &bus->contradictions(), options.split_bytes),
      registry_(bus) {
  constexpr int kUnbounded = 0;
  everything_ = bus->SubscribeToAll([this](const ReceivedMessage& message) { OnMessage(message); },
                                    kUnbounded);
  announcer_ = std::make_unique<NodeAnnouncer>(bus, [this] {
    const std::scoped_lock lock(status_mutex_);
    return status_;
  });
  // Last: it may not be left running if the rest cannot be made.
  writer_ = std::thread([this] { Write(); });
  spdlog::info("recording to {}", recorder_.folder().path().string());
}

LoggerNode::~LoggerNode() { Stop(); }

bool LoggerNode::Run(const std::function<bool()>& stop) {
  // Another logger of this name is no reason to leave: it writes elsewhere (the folder is locked),
  // and in the replay of a recording just made it is the one that made it.
  while (!stop()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  Stop();
  if (failure_) std::rethrow_exception(failure_);
  Bus::Counters counters = bus_->counters();
  counters.dropped += num_dropped();
  const bool complete = recorder_.Report(BusJson(counters, bus_->contradictions().entries()));
  if (counters.lost > 0) {
    spdlog::warn("{} messages that others sent did not come: the event log is incomplete",
                 counters.lost);
  }
  if (num_dropped() > 0) {
    spdlog::error("{} messages were dropped: the event log is incomplete", num_dropped());
  }
  return complete && num_dropped() == 0;
}

bool LoggerNode::IsForged(const ReceivedMessage& message) const {
  if (message.channel != channel::kRunRecord && message.channel != channel::kSession) return false;
  const std::vector<NodeRegistry::Node> drivers = registry_.LiveNodes(NodeKind::kDriver);
  const bool is_drivers = std::any_of(drivers.begin(), drivers.end(), [&](const auto& driver) {
    return driver.sender == message.sender;
  });
  return !drivers.empty() && !is_drivers &&
         !registry_.Believes(message.sender, NodeKind::kDriver, drivers.front().status.name,
                             message.channel);
}

void LoggerNode::OnMessage(const ReceivedMessage& message) {
  bool taken = false;
  if (IsForged(message)) {
    ReceivedMessage refused = message;
    refused.channel = "REFUSED_" + message.channel;
    taken = queue_.Push(refused);
  } else {
    taken = queue_.Push(message);
  }
  if (taken) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_complaint_ < std::chrono::seconds(1)) return;
  last_complaint_ = now;
  spdlog::error("messages come faster than they can be written: {} dropped so far",
                queue_.num_dropped());
}

void LoggerNode::Write() {
  constexpr std::chrono::milliseconds kPatience{500};
  // What the database has not taken when there is to be an end, and all that follows it, is in the
  // event log alone, of which the database can be brought up to date.
  const auto enter = [&](const ReceivedMessage& message) {
    if (failure_) return;
    try {
      Persist([&] { recorder_.Enter(message); });
    } catch (const std::exception&) {
      failure_ = std::current_exception();
      spdlog::error("what came last is in the event log alone: --resume stores it");
    }
  };
  try {
    while (true) {
      const std::optional<ReceivedMessage> message = queue_.Pop(kPatience);
      if (message) {
        // Each until it succeeds: what is tried again must not be logged again.
        Persist([&] { recorder_.Log(*message); });
        enter(*message);
      }
      if (!queue_.empty()) continue;
      Persist([&] { recorder_.Flush(); });
      if (queue_.closed()) return;
    }
  } catch (const std::exception&) {
    if (!failure_) failure_ = std::current_exception();
  }
}

void LoggerNode::Persist(const std::function<void()>& work) {
  constexpr int kRetryAfter = 20;  // times kPause
  constexpr std::chrono::milliseconds kPause{50};
  std::exception_ptr failed;
  while (true) {
    try {
      if (failed) recorder_.Recover();
      work();
      if (failed) {
        spdlog::info("recording again");
        SetTrouble("");
      }
      return;
    } catch (const std::exception& error) {
      if (queue_.closed()) throw;
      if (!failed) spdlog::critical("cannot record: {}; trying again", error.what());
      failed = std::current_exception();
      SetTrouble(error.what());
    }
    for (int i = 0; i < kRetryAfter && !queue_.closed(); ++i) std::this_thread::sleep_for(kPause);
    // What recovering gives up nobody would send again.
    if (queue_.closed()) std::rethrow_exception(failed);
  }
}

void LoggerNode::SetTrouble(const std::string& trouble) {
  {
    const std::scoped_lock lock(status_mutex_);
    if (status_.trouble == trouble) return;
    status_.trouble = trouble;
  }
  announcer_->Announce();
}

void LoggerNode::Stop() {
  everything_ = Subscription();
  queue_.Close();
  if (writer_.joinable()) writer_.join();
  announcer_.reset();
}

}  // namespace planbench
