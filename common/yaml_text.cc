#include "common/yaml_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <regex>
#include <string_view>

#include "common/text.h"

namespace planbench {
namespace {

/// A character of UTF-8, of at most 3 bytes, as an escape.
std::string YamlEscape(std::string_view character) {
  std::uint32_t code = static_cast<unsigned char>(character[0]);
  if (character.size() > 1) code &= character.size() == 2 ? 0x1fU : 0xfU;
  for (const char c : character.substr(1)) {
    code = code << 6 | (static_cast<unsigned char>(c) & 0x3fU);
  }
  return code < 0x100 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
}

}  // namespace

std::string YamlText(const std::string& text) {
  static const std::regex kPlain(R"([A-Za-z_][A-Za-z0-9_./-]*)");
  static const std::regex kReserved("true|false|yes|no|on|off|y|n|null|inf|nan", std::regex::icase);
  if (std::regex_match(text, kPlain) && !std::regex_match(text, kReserved)) return text;
  std::string quoted = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = std::string_view(text).substr(at);
    if (const std::size_t length = ControlLength(rest); length > 0) {
      quoted += YamlEscape(rest.substr(0, length));
      at += length;
      continue;
    }
    if (rest[0] == '"' || rest[0] == '\\') quoted += '\\';
    quoted += rest[0];
    ++at;
  }
  return quoted + '"';
}

std::string YamlNumber(double value) { return fmt::format("{}", value + 0.0); }

}  // namespace planbench
