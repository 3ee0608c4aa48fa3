#pragma once

#include <string>

#include "logger/message_queue.h"
#include "messaging/codec.h"
#include "messaging/messages.h"

namespace planbench {

/// A session "session-1" on the set "shelf" as it begins.
SessionMessage SampleSession();
/// The same at its end.
SessionMessage FinishedSession();
/// A solved and judged run of session-1 with every field set, each to a value of its own.
RunRecordMessage SampleRecord(const std::string& request_id = "request-1");
/// A run the planner never answered.
RunRecordMessage UnansweredRecord(const std::string& request_id = "request-2");

/// A message as it comes off the bus.
template <typename Message>
ReceivedMessage Received(const std::string& channel, const Message& message,
                         std::int64_t utime = 1'700'000'000'000'000) {
  return {channel, Encode(message), utime};
}

}  // namespace planbench
