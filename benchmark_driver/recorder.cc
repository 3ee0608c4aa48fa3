#include "benchmark_driver/recorder.h"

#include <spdlog/spdlog.h>

#include "messaging/channels.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRetry{500};

}  // namespace

Recorder::Recorder(Bus* bus, NodeRegistry* registry)
    : bus_(bus),
      registry_(registry),
      record_acks_(bus->Subscribe<AckMessage>(channel::kRunRecordAck,
                                              [this](const AckMessage& ack) { OnAck(ack); })),
      session_acks_(bus->Subscribe<AckMessage>(channel::kSessionAck,
                                               [this](const AckMessage& ack) { OnAck(ack); })) {}

void Recorder::OnAck(const AckMessage& ack) {
  const std::scoped_lock lock(mutex_);
  const auto found = pending_.find(ack.id);
  if (found == pending_.end()) return;
  found->second = ack;
  changed_.notify_all();
}

void Recorder::Record(const RunRecordMessage& record) {
  Deliver(record.request_id, [&] { bus_->Publish(channel::kRunRecord, record); });
}

void Recorder::Record(const SessionMessage& session) {
  Deliver(session.run_id, [&] { bus_->Publish(channel::kSession, session); });
}

void Recorder::Deliver(const std::string& id, const std::function<void()>& send) {
  const Clock::time_point begin = Clock::now();
  std::unique_lock lock(mutex_);
  pending_[id].reset();
  std::string failure;
  while (true) {
    lock.unlock();
    // Published even when no logger is live: others may watch.
    send();
    const bool anybody = !registry_->Live(NodeKind::kLogger).empty();
    lock.lock();
    changed_.wait_for(lock, kRetry, [&] { return !anybody || pending_[id].has_value(); });
    if (const auto& ack = pending_[id]) {
      if (!ack->ok) failure = "the logger refused it: " + ack->message;
      break;
    }
    if (!anybody) {
      failure = "NO LOGGER IS LIVE";
      break;
    }
    if (Clock::now() - begin > kPatience) {
      failure = "the logger is live but did not acknowledge it";
      break;
    }
  }
  pending_.erase(id);
  lock.unlock();
  if (!failure.empty()) {
    ++num_unrecorded_;
    spdlog::error("{} IS NOT RECORDED: {}", id, failure);
  }
}

}  // namespace planbench
