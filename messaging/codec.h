#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "messaging/messages.h"

namespace planbench {

/// A message that cannot be used: truncated, of another type or version, or with a value out of
/// range. The text names the channel and the field.
class MessageError : public InputError {
 public:
  MessageError(const std::string& message, std::string request_id)
      : InputError(message), request_id_(std::move(request_id)) {}
  /// The request_id of the message, of a session its run_id, if it could be read that far; else
  /// empty. Lets a server refuse by id.
  const std::string& request_id() const { return request_id_; }

 private:
  std::string request_id_;
};

/// Between the messages of messages.h, and PlanRequest, and their bytes on the bus. The fields are
/// listed in message_fields.h; codec.cc names the messages there are, any other does not link.
template <typename Message>
struct Codec {
  static std::vector<std::uint8_t> Encode(const Message& message);
  static Message Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
  static std::string Print(std::span<const std::uint8_t> bytes, const std::string& channel);
};

/// Wire form of a message; sets utime to now where it is not part of the value. Throws
/// std::logic_error for values that have no wire form (lists that must be of one length and are
/// not), InputError if a scene's mesh cannot be stored (see mesh_store.h).
template <typename Message>
std::vector<std::uint8_t> Encode(const Message& message) {
  return Codec<Message>::Encode(message);
}

/// Reads a message and checks every count, enum, float (NaN, infinity) and size. Throws
/// MessageError.
template <typename Message>
Message Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  return Codec<Message>::Decode(bytes, channel);
}

/// A message as text (printer.h), values out of range and all. Throws MessageError for bytes that
/// are no such message.
template <typename Message>
std::string Print(std::span<const std::uint8_t> bytes, const std::string& channel) {
  return Codec<Message>::Print(bytes, channel);
}

}  // namespace planbench
