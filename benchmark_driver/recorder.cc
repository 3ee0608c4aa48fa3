#include "benchmark_driver/recorder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/lookup.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRetry{500};
constexpr std::chrono::milliseconds kWakeUp{100};
/// Records under way at once.
constexpr std::size_t kWindow = 16;

}  // namespace

Recorder::Recorder(Bus* bus, NodeRegistry* registry, const std::filesystem::path& folder)
    : bus_(bus),
      registry_(registry),
      spool_(folder),
      record_acks_(bus->SubscribeFrom<AckMessage>(
          channel::kRunRecordAck,
          [this](const AckMessage& ack, const Origin& origin) { OnAck(ack, origin); })),
      session_acks_(bus->SubscribeFrom<AckMessage>(
          channel::kSessionAck,
          [this](const AckMessage& ack, const Origin& origin) { OnAck(ack, origin); })) {}

void Recorder::OnAck(const AckMessage& ack, const Origin& origin) {
  const std::scoped_lock lock(mutex_);
  LookAround();
  const auto of_sender = [&](const auto& entry) {
    return entry.second.sender == origin.sender && entry.second.name == ack.sender;
  };
  const auto found = std::find_if(loggers_.begin(), loggers_.end(), of_sender);
  if (found == loggers_.end()) {
    bus_->contradictions().Note(
        origin.sender, channel::kRunRecordAck,
        "acknowledges as '" + ack.sender + "', which is no logger at that address");
    return;
  }
  Logger& logger = found->second;
  // A record that cannot be decoded is refused without its repeat: ID#1 to ID#9... may be meant.
  const auto last = awaited_.upper_bound(ack.ok ? ack.id : ack.id + "#:");
  const auto record = std::find_if(awaited_.lower_bound(ack.id), last,
                                   [&](const auto& one) { return !logger.Has(one.second); });
  const std::string session = session_ ? SessionAckId(*session_) : "";
  // One that cannot be decoded is refused without its time.
  if (session_ && (ack.id == session || (!ack.ok && ack.id == session_->run_id))) {
    if (std::exchange(logger.session, session) == session) return;
    const auto refusal = ack.ok ? std::nullopt : std::optional(ack.message);
    if (std::exchange(logger.session_refusal, refusal) != refusal && refusal) {
      spdlog::error("the logger '{}' refuses the session: {}", logger.name, *refusal);
    }
  } else if (record == last) {
    return;  // what it knows, or nobody sent: whoever says no more than that is silent
  } else {
    logger.beyond.insert(record->second);
    if (!ack.ok) logger.refused[record->second] = ack.message;
    while (logger.beyond.erase(logger.next) > 0) ++logger.next;
  }
  logger.silent = false;
  ++num_acks_;
  changed_.notify_all();
}

void Recorder::Record(const RunRecordMessage& record) {
  std::unique_lock lock(mutex_);
  spool_.Add({RunRecordAckId(record), Encode(record)});
  LookAround();
  if (nobody_) bus_->Publish(channel::kRunRecord, record);  // others may watch
  Deliver(&lock, false);
}

void Recorder::Record(const SessionMessage& session) {
  std::unique_lock lock(mutex_);
  session_ = session;
  session_sent_ = Clock::now();
  bus_->Publish(channel::kSession, session);
  Deliver(&lock, false);
}

bool Recorder::Complete() {
  std::unique_lock lock(mutex_);
  Deliver(&lock, true);
  return std::any_of(loggers_.begin(), loggers_.end(), [this](const auto& entry) {
    const Logger& logger = entry.second;
    return logger.Count() == spool_.size() && !Lacks(logger) && !logger.session_refusal;
  });
}

bool Recorder::Lacks(const Logger& logger) const {
  return logger.next < spool_.size() || (session_ && logger.session != SessionAckId(*session_));
}

void Recorder::LookAround() {
  for (auto& [place, logger] : loggers_) logger.live = false;
  for (const NodeRegistry::Node& node : registry_->LiveNodes(NodeKind::kLogger)) {
    const NodeStatusMessage& status = node.status;
    const std::string place =
        fmt::format("{}:{}", status.host, Lookup(status.settings, "out").value_or(status.name));
    Logger& logger = loggers_[place];
    // Of two that write to one folder the one that came first is dead, though not yet given up.
    if (logger.live && node.since < logger.since) continue;
    logger.since = node.since;
    logger.name = status.name;
    logger.place = place;
    if (!(logger.sender == node.sender)) logger.silent = false;  // it was started again
    logger.sender = node.sender;
    logger.live = true;
    logger.trouble = status.trouble;
  }
  const bool somebody = std::any_of(loggers_.begin(), loggers_.end(), [](const auto& entry) {
    return entry.second.Takes() && !entry.second.silent;
  });
  if (somebody == !nobody_) return;
  nobody_ = !somebody;
  if (somebody) {
    spdlog::info("a logger records again");
    return;
  }
  std::string why = "no logger is live";
  for (const auto& [place, logger] : loggers_) {
    if (!logger.live) continue;
    why = fmt::format("the logger '{}' {}", logger.name,
                      logger.trouble.empty() ? "does not answer" : "cannot: " + logger.trouble);
  }
  spdlog::error("NOBODY RECORDS: {}; runs are kept for a logger that comes (back)", why);
}

bool Recorder::SendDue(TimePoint now) {
  bool lacking = false;
  std::size_t first = spool_.size();
  std::set<std::size_t> wanted;
  for (const auto& [place, logger] : loggers_) {
    if (!logger.Takes() || !Lacks(logger)) continue;
    lacking = lacking || !logger.silent;
    first = std::min(first, logger.next);
    if (session_ && logger.session != SessionAckId(*session_) && now - session_sent_ >= kRetry) {
      session_sent_ = now;
      bus_->Publish(channel::kSession, *session_);
    }
    std::size_t left = logger.silent ? 1 : kWindow;
    for (std::size_t i = logger.next; i < spool_.size() && left > 0; ++i) {
      if (logger.Has(i)) continue;
      wanted.insert(i);
      --left;
    }
  }
  std::erase_if(awaited_, [&](const auto& entry) { return entry.second < first; });
  std::erase_if(sent_, [&](const auto& entry) { return entry.first < first; });
  for (const std::size_t i : wanted) {
    const auto [sent, is_new] = sent_.try_emplace(i, now);
    if (!is_new && now - sent->second < kRetry) continue;
    sent->second = now;
    const RecordSpool::Record record = spool_.At(i);
    awaited_[record.id] = i;
    bus_->PublishBytes(channel::kRunRecord, record.bytes);
  }
  return lacking;
}

void Recorder::Deliver(std::unique_lock<std::mutex>* lock, bool wait_for_return) {
  TimePoint progress = Clock::now();
  std::uint64_t acks = num_acks_;
  while (true) {
    LookAround();
    const TimePoint now = Clock::now();
    if (std::exchange(acks, num_acks_) != num_acks_) progress = now;
    if (SendDue(now)) {
      if (now - progress >= silence_patience) {
        for (auto& [place, logger] : loggers_) {
          if (logger.Takes() && Lacks(logger)) logger.silent = true;
        }
        continue;
      }
    } else {
      const Logger* best = Best();
      const bool lost = best != nullptr && Lacks(*best);
      if (!wait_for_return || !lost || now - progress >= return_patience) return;
    }
    changed_.wait_for(*lock, kWakeUp);
  }
}

const Recorder::Logger* Recorder::Best() const {
  const Logger* best = nullptr;
  for (const auto& [place, logger] : loggers_) {
    if (best == nullptr || logger.Count() > best->Count()) best = &logger;
  }
  return best;
}

std::size_t Recorder::num_unrecorded() const {
  const std::scoped_lock lock(mutex_);
  const Logger* best = Best();
  return spool_.size() - (best == nullptr ? 0 : best->Count());
}

std::vector<std::string> Recorder::Shortcomings() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> lines;
  if (loggers_.empty() && spool_.size() > 0) {
    lines.push_back(
        fmt::format("none of {} run records is stored: no logger was live", spool_.size()));
  }
  for (const auto& [place, logger] : loggers_) {
    if (logger.session_refusal) {
      lines.push_back(fmt::format("the session is not stored by the logger '{}' ({}): {}",
                                  logger.name, logger.place, *logger.session_refusal));
    }
    const std::size_t missing = spool_.size() - logger.Count();
    if (missing == 0) continue;
    const std::string why = !logger.refused.empty()   ? logger.refused.begin()->second
                            : !logger.trouble.empty() ? logger.trouble
                            : !logger.live            ? "it has left the bus"
                                                      : "it does not answer";
    lines.push_back(fmt::format("{} of {} run records are not stored by the logger '{}' ({}): {}",
                                missing, spool_.size(), logger.name, logger.place, why));
  }
  return lines;
}

}  // namespace planbench
