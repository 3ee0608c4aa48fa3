#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace planbench {

/// A message of whatever type as text.
struct PrintedMessage {
  std::string type;  ///< "lcmt_plan_request"
  std::string text;  ///< One field a line (printer.h).
};

/// Knows the type by the fingerprint that the bytes begin with; nothing if no message of this
/// version has it. Throws MessageError, naming the channel, for bytes that are damaged.
std::optional<PrintedMessage> PrintAny(std::span<const std::uint8_t> bytes,
                                       const std::string& channel);

}  // namespace planbench
