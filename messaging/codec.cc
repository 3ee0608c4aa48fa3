#include "messaging/codec.h"

#include "common/text.h"
#include "messaging/decoder.h"
#include "messaging/encoder.h"
#include "messaging/message_fields.h"
#include "messaging/printer.h"
#include "messaging/wire.h"

namespace planbench {

std::string Decoder::Path() const {
  if (parent_ == nullptr) return "";
  std::string path = parent_->Path() + name_;
  if (index_) path += fmt::format("[{}]", *index_);
  return path + ".";
}

void Decoder::Fail(const char* name, std::initializer_list<std::size_t> indices,
                   const std::string& what) const {
  std::string path = Path() + name;
  for (const std::size_t index : indices) path += fmt::format("[{}]", index);
  // It may quote a text of megabytes, and is logged, remembered and sent back.
  throw MessageError(
      fmt::format("{}: {}: {}", channel_, path, Abridged(what, rules::Reason::kMost)), request_id_);
}

std::string Printer::TextOf(const std::string& text) {
  std::string quotable;
  for (const char c : text) {
    if (c == '"' || c == '\\') quotable += '\\';
    quotable += c;
  }
  return '"' + Escaped(quotable) + '"';
}

template <typename Message>
std::vector<std::uint8_t> Codec<Message>::Encode(const Message& message) {
  typename Fields<Message>::Wire wire{};
  Encoder encoder;
  Fields<Message>::List(encoder, message, wire);
  return wire::Pack(wire);
}

template <typename Message>
Message Codec<Message>::Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  auto wire = wire::Unpack<typename Fields<Message>::Wire>(bytes, channel);
  const std::string request_id = wire::RequestIdOf(wire);
  Decoder decoder(channel, request_id);
  Message message;
  Fields<Message>::List(decoder, message, wire);
  return message;
}

template <typename Message>
std::string Codec<Message>::Print(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<typename Fields<Message>::Wire>(bytes, channel);
  Printer printer;
  Message unused;
  Fields<Message>::List(printer, unused, wire);
  return printer.text();
}

template struct Codec<DiscoverMessage>;
template struct Codec<NodeStatusMessage>;
template struct Codec<ProblemSetsMessage>;
template struct Codec<ProblemRequestMessage>;
template struct Codec<ProblemMessage>;
template struct Codec<SceneRequestMessage>;
template struct Codec<SceneMessage>;
template struct Codec<PlanRequest>;
template struct Codec<PlanAckMessage>;
template struct Codec<PlanProgressMessage>;
template struct Codec<PlanResultMessage>;
template struct Codec<PlanCancelMessage>;
template struct Codec<AckMessage>;
template struct Codec<CollisionRequestMessage>;
template struct Codec<CollisionReplyMessage>;
template struct Codec<PathCheckRequestMessage>;
template struct Codec<PathCheckReplyMessage>;
template struct Codec<SessionMessage>;
template struct Codec<RunRecordMessage>;

}  // namespace planbench
