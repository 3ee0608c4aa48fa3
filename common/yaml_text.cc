#include "common/yaml_text.h"

#include <fmt/format.h>

#include <regex>

namespace planbench {

std::string YamlText(const std::string& text) {
  static const std::regex kPlain(R"([A-Za-z_][A-Za-z0-9_./-]*)");
  static const std::regex kReserved("true|false|yes|no|on|off|y|n|null|inf|nan", std::regex::icase);
  if (std::regex_match(text, kPlain) && !std::regex_match(text, kReserved)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string YamlNumber(double value) { return fmt::format("{}", value + 0.0); }

}  // namespace planbench
