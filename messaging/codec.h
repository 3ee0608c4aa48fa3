#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/error.h"
#include "messaging/messages.h"

namespace planbench {

/// A message that cannot be used: truncated, of another type or version, or with a value out of range. The text
/// names the channel and the field.
class MessageError : public InputError {
 public:
  MessageError(const std::string& message, std::string request_id)
      : InputError(message), request_id_(std::move(request_id)) {}
  /// The request_id of the message, if it could be read that far; else empty. Lets a server refuse by id.
  const std::string& request_id() const { return request_id_; }

 private:
  std::string request_id_;
};

/// Wire form of a message (any type of messages.h, and PlanRequest); sets utime to now where it is not part of the
/// value.
template <typename Message>
std::vector<std::uint8_t> Encode(const Message& message);

/// Reads a message and checks every count, enum, float (NaN, infinity) and size. Throws MessageError.
template <typename Message>
Message Decode(std::span<const std::uint8_t> bytes, const std::string& channel);

/// us since the Unix epoch.
std::int64_t NowUtime();

}  // namespace planbench
