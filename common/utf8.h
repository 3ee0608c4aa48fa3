#pragma once

#include <cstddef>
#include <string>

namespace planbench {

/// At most so many characters of UTF-8 text, from its beginning.
inline std::string FirstCharacters(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (std::size_t seen = 0; end < text.size(); ++end) {
    const bool begins = (static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U;
    if (begins && seen++ == count) break;
  }
  return text.substr(0, end);
}

}  // namespace planbench
