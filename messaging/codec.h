#pragma once

#include <cstdint>
#include <span>
#include <string>
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
  /// The request_id of the message, if it could be read that far; else empty. Lets a server refuse
  /// by id.
  const std::string& request_id() const { return request_id_; }

 private:
  std::string request_id_;
};

/// Wire form of a message (any type of messages.h, and PlanRequest); sets utime to now where it is
/// not part of the value. Throws std::logic_error for values that have no wire form (lists that
/// must be of one length and are not), InputError if a scene's mesh cannot be stored (see
/// mesh_store.h).
template <typename Message>
std::vector<std::uint8_t> Encode(const Message& message);

/// Reads a message and checks every count, enum, float (NaN, infinity) and size. Throws
/// MessageError.
template <typename Message>
Message Decode(std::span<const std::uint8_t> bytes, const std::string& channel);

// The messages there are; any other type does not link.
template <>
std::vector<std::uint8_t> Encode(const DiscoverMessage& message);
template <>
DiscoverMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const NodeStatusMessage& message);
template <>
NodeStatusMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const ProblemSetsMessage& message);
template <>
ProblemSetsMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const ProblemRequestMessage& message);
template <>
ProblemRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const ProblemMessage& message);
template <>
ProblemMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const SceneRequestMessage& message);
template <>
SceneRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const SceneMessage& message);
template <>
SceneMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PlanRequest& message);
template <>
PlanRequest Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PlanAckMessage& message);
template <>
PlanAckMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PlanProgressMessage& message);
template <>
PlanProgressMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PlanResultMessage& message);
template <>
PlanResultMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PlanCancelMessage& message);
template <>
PlanCancelMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const AckMessage& message);
template <>
AckMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const CollisionRequestMessage& message);
template <>
CollisionRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const CollisionReplyMessage& message);
template <>
CollisionReplyMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PathCheckRequestMessage& message);
template <>
PathCheckRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const PathCheckReplyMessage& message);
template <>
PathCheckReplyMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const SessionMessage& message);
template <>
SessionMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);
template <>
std::vector<std::uint8_t> Encode(const RunRecordMessage& message);
template <>
RunRecordMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel);

/// us since the Unix epoch.
std::int64_t NowUtime();

}  // namespace planbench
