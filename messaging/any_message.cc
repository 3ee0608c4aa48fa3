#include "messaging/any_message.h"

#include <vector>

#include "messaging/codec.h"
#include "messaging/message_fields.h"

namespace planbench {
namespace {

struct Type {
  std::int64_t fingerprint;
  std::string name;
  std::string (*print)(std::span<const std::uint8_t>, const std::string&);
};

template <typename... Messages>
std::vector<Type> TypesOf() {
  return {Type{Fields<Messages>::Wire::getHash(), Fields<Messages>::Wire::getTypeName(),
               &Codec<Messages>::Print}...};
}

const std::vector<Type>& Types() {
  static const std::vector<Type> types =
      TypesOf<DiscoverMessage, NodeStatusMessage, ProblemSetsMessage, ProblemRequestMessage,
              ProblemMessage, SceneRequestMessage, SceneMessage, PlanRequest, PlanAckMessage,
              PlanProgressMessage, PlanResultMessage, PlanCancelMessage, AckMessage,
              CollisionRequestMessage, CollisionReplyMessage, PathCheckRequestMessage,
              PathCheckReplyMessage, SessionMessage, RunRecordMessage>();
  return types;
}

}  // namespace

std::optional<PrintedMessage> PrintAny(std::span<const std::uint8_t> bytes,
                                       const std::string& channel) {
  if (bytes.size() < sizeof(std::int64_t)) return std::nullopt;
  std::uint64_t fingerprint = 0;
  for (std::size_t i = 0; i < sizeof(fingerprint); ++i) fingerprint = fingerprint << 8 | bytes[i];
  for (const Type& type : Types()) {
    if (static_cast<std::uint64_t>(type.fingerprint) != fingerprint) continue;
    return PrintedMessage{type.name, type.print(bytes, channel)};
  }
  return std::nullopt;
}

}  // namespace planbench
