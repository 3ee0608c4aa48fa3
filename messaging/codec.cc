#include "messaging/codec.h"

#include <algorithm>

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
  throw MessageError(fmt::format("{}: {}: {}", channel_, path, what), request_id_);
}

void Decoder::Escape(std::string* text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::size_t bad = FindInvalidUtf8(*text).value_or(text->size());
  if (bad == text->size() && std::none_of(text->begin(), text->end(), is_control)) return;
  std::string escaped;
  for (std::size_t i = 0; i < text->size(); ++i) {
    const std::string_view one = std::string_view(*text).substr(i, 1);
    escaped += i == bad || is_control(one[0]) ? Printable(one) : std::string(one);
    if (i < bad) continue;
    const auto next = FindInvalidUtf8(std::string_view(*text).substr(i + 1));
    bad = next ? i + 1 + *next : text->size();
  }
  *text = std::move(escaped);
}

std::string Printer::TextOf(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    const auto code = static_cast<unsigned char>(c);
    quoted += code < 0x20 || code == 0x7f ? fmt::format("\\x{:02x}", code) : std::string(1, c);
  }
  return quoted + '"';
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
