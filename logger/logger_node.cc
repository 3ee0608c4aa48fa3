#include "logger/logger_node.h"

#include <spdlog/spdlog.h>

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
      recorder_(options.out, options.resume, options.name,
                [bus](const std::string& channel, const AckMessage& ack) {
                  bus->Publish(channel, ack);
                }) {
  writer_ = std::thread([this] { Write(); });
  constexpr int kUnbounded = 0;
  try {
    everything_ = bus->SubscribeToAll(
        [this](const ReceivedMessage& message) { OnMessage(message); }, kUnbounded);
    announcer_ = std::make_unique<NodeAnnouncer>(bus, [this] { return status_; });
  } catch (...) {
    Stop();
    throw;
  }
  spdlog::info("recording to {}", recorder_.folder().path().string());
}

LoggerNode::~LoggerNode() { Stop(); }

bool LoggerNode::Run(const std::function<bool()>& stop) {
  // Another logger of this name is no reason to leave: it writes elsewhere (the folder is locked),
  // and in the replay of a recording just made it is the one that made it.
  while (!stop() && !failed_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  Stop();
  if (failure_) std::rethrow_exception(failure_);
  const bool complete = recorder_.Report();
  if (const std::int64_t lost = bus_->counters().lost; lost > 0) {
    spdlog::warn("{} messages that others sent did not come: the event log is incomplete", lost);
  }
  if (num_dropped() > 0) {
    spdlog::error("{} messages were dropped: the event log is incomplete", num_dropped());
  }
  return complete && num_dropped() == 0;
}

void LoggerNode::OnMessage(const ReceivedMessage& message) {
  if (queue_.Push(message)) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_complaint_ < std::chrono::seconds(1)) return;
  last_complaint_ = now;
  spdlog::error("messages come faster than they can be written: {} dropped so far",
                queue_.num_dropped());
}

void LoggerNode::Write() {
  constexpr std::chrono::milliseconds kPatience{500};
  try {
    while (true) {
      const std::optional<ReceivedMessage> message = queue_.Pop(kPatience);
      if (message) recorder_.Record(*message);
      if (!queue_.empty()) continue;
      recorder_.Flush();
      if (queue_.closed()) return;
    }
  } catch (const std::exception& error) {
    spdlog::critical("cannot record any more: {}", error.what());
    failure_ = std::current_exception();
    failed_ = true;
  }
}

void LoggerNode::Stop() {
  announcer_.reset();
  everything_ = Subscription();
  queue_.Close();
  if (writer_.joinable()) writer_.join();
}

}  // namespace planbench
