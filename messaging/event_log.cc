#include "messaging/event_log.h"

#include <lcm/eventlog.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "common/error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

InputError CannotOpen(const fs::path& file) {
  return InputError("cannot open event log " + file.string() + ": " + std::strerror(errno));
}

struct Extent {
  std::int64_t next_number = 0;
  std::uintmax_t bytes = 0;  ///< Up to the end of the last whole event.
};

Extent Scan(const fs::path& file) {
  lcm_eventlog_t* log = lcm_eventlog_create(file.c_str(), "r");
  if (log == nullptr) throw CannotOpen(file);
  Extent extent;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    extent.next_number = std::max(extent.next_number, event->eventnum + 1);
    extent.bytes = static_cast<std::uintmax_t>(ftello(log->f));
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
  return extent;
}

/// Cuts off a torn last event; the number of the event to come.
std::int64_t PrepareToAppend(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size == 0) return 0;
  const Extent extent = Scan(file);
  if (extent.bytes < size) {
    spdlog::warn("{}: {} bytes after the last whole event cut off", file.string(),
                 size - extent.bytes);
    fs::resize_file(file, extent.bytes, error);
    if (error) throw InputError("cannot shorten " + file.string() + ": " + error.message());
  }
  return extent.next_number;
}

}  // namespace

EventLog::EventLog(const fs::path& file, Mode mode) : file_(file) {
  if (mode == Mode::kNew && fs::exists(file)) {
    throw InputError("event log " + file.string() + " exists already");
  }
  const std::int64_t next_number = mode == Mode::kAppend ? PrepareToAppend(file) : 0;
  log_.reset(lcm_eventlog_create(file.c_str(), mode == Mode::kNew ? "w" : "a"));
  if (!log_) throw CannotOpen(file);
  log_->eventcount = next_number;  // LCM would begin at 0 again
}

EventLog::~EventLog() {
  if (log_ && std::fflush(log_->f) != 0) {
    spdlog::error("cannot write {}: {}", file_.string(), std::strerror(errno));
  }
}

void EventLog::Close::operator()(lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }

void EventLog::Write(const ReceivedMessage& message) {
  if (!log_) throw std::runtime_error("event log " + file_.string() + " is not open");
  // LCM only reads what these pointers point to.
  lcm_eventlog_event_t event = {};
  event.timestamp = message.utime;
  event.channellen = static_cast<std::int32_t>(message.channel.size());
  event.datalen = static_cast<std::int32_t>(message.bytes.size());
  event.channel = const_cast<char*>(message.channel.data());
  event.data = const_cast<std::uint8_t*>(message.bytes.data());
  if (lcm_eventlog_write_event(log_.get(), &event) != 0) Fail();
}

void EventLog::Flush() {
  if (!log_) return;
  if (std::fflush(log_->f) != 0) Fail();
}

void EventLog::Reopen() {
  // First closed: what it still holds is torn.
  log_.reset();
  const std::int64_t next_number = PrepareToAppend(file_);
  log_.reset(lcm_eventlog_create(file_.c_str(), "a"));
  if (!log_) throw CannotOpen(file_);
  log_->eventcount = next_number;
}

void EventLog::Fail() const {
  throw std::runtime_error("cannot write event log " + file_.string() + ": " +
                           std::strerror(errno));
}

}  // namespace planbench
