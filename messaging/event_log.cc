#include "messaging/event_log.h"

#include <lcm/eventlog.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "common/error.h"
#include "messaging/event_log_files.h"
#include "messaging/event_log_reader.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

InputError CannotOpen(const fs::path& file) {
  return InputError("cannot open event log " + file.string() + ": " + std::strerror(errno));
}

EventLogExtent Scan(const fs::path& file) {
  return ReadEventLogFile(file, [](const ReceivedMessage&) {});
}

/// Cuts off a torn last event; what is damaged before whole ones stays. Of a file that may be
/// anything nothing is cut off.
EventLogExtent PrepareToAppend(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size == 0) return {};
  const EventLogExtent extent = Scan(file);
  if (extent.bytes == 0 && !BeginsAsEventLog(file)) {
    throw InputError(file.string() +
                     ": cannot be continued: there is no event of an LCM event log in it");
  }
  if (extent.bytes < size) {
    spdlog::warn("{}: {} bytes after the last whole event cut off", file.string(),
                 size - extent.bytes);
    fs::resize_file(file, extent.bytes, error);
    if (error) throw InputError("cannot shorten " + file.string() + ": " + error.message());
  }
  return extent;
}

}  // namespace

EventLog::EventLog(const fs::path& file, Mode mode, std::optional<std::uintmax_t> split_bytes)
    : file_(file), split_bytes_(split_bytes) {
  const std::vector<fs::path> files = EventLogFiles(file);
  if (mode == Mode::kNew && (files.size() > 1 || fs::exists(file))) {
    throw InputError("event log " + files.back().string() + " exists already");
  }
  number_ = static_cast<int>(files.size()) - 1;
  Reopen();
}

EventLog::~EventLog() {
  if (log_ && std::fflush(log_->f) != 0) {
    spdlog::error("cannot write {}: {}", Current().string(), std::strerror(errno));
  }
}

void EventLog::Close::operator()(lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }

fs::path EventLog::Current() const { return EventLogFile(file_, number_); }

void EventLog::Write(const ReceivedMessage& message) {
  if (!log_) throw std::runtime_error("event log " + Current().string() + " is not open");
  if (split_bytes_ && bytes_ >= *split_bytes_) BeginNextFile();
  // LCM only reads what these pointers point to.
  lcm_eventlog_event_t event = {};
  event.timestamp = message.utime;
  event.channellen = static_cast<std::int32_t>(message.channel.size());
  event.datalen = static_cast<std::int32_t>(message.bytes.size());
  event.channel = const_cast<char*>(message.channel.data());
  event.data = const_cast<std::uint8_t*>(message.bytes.data());
  if (lcm_eventlog_write_event(log_.get(), &event) != 0) Fail();
  constexpr std::uintmax_t kHeaderBytes = 28;
  bytes_ += kHeaderBytes + message.channel.size() + message.bytes.size();
}

void EventLog::BeginNextFile() {
  Flush();
  const fs::path next = EventLogFile(file_, number_ + 1);
  std::unique_ptr<lcm_eventlog_t, Close> log(lcm_eventlog_create(next.c_str(), "a"));
  if (!log) throw CannotOpen(next);
  log->eventcount = log_->eventcount;
  log_ = std::move(log);
  ++number_;
  bytes_ = 0;
}

void EventLog::Flush() {
  if (!log_) return;
  if (std::fflush(log_->f) != 0) Fail();
}

void EventLog::Reopen() {
  // First closed: what it still holds is torn.
  log_.reset();
  const EventLogExtent extent = PrepareToAppend(Current());
  std::int64_t next_number = extent.next_number;
  for (int before = number_; next_number == 0 && before > 0;) {
    next_number = Scan(EventLogFile(file_, --before)).next_number;
  }
  log_.reset(lcm_eventlog_create(Current().c_str(), "a"));
  if (!log_) throw CannotOpen(Current());
  log_->eventcount = next_number;  // LCM would begin at 0 again
  bytes_ = extent.bytes;
}

void EventLog::Fail() const {
  throw std::runtime_error("cannot write event log " + Current().string() + ": " +
                           std::strerror(errno));
}

}  // namespace planbench
