#include "common/text.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <vector>

#include "common/error.h"

namespace planbench {
namespace {

constexpr std::size_t kWordKept = 60;

bool IsContinuation(unsigned char byte) { return (byte & 0xc0) == 0x80; }

// Length in bytes of the UTF-8 character at the beginning of `text` (not empty), 0 if there is
// none: overlong forms, surrogates and numbers beyond Unicode are no characters.
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!IsContinuation(byte(i))) return 0;
  }
  const unsigned char second = byte(1);
  const bool possible = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second < 0xa0) &&
                        (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second < 0x90);
  return possible ? length : 0;
}

std::string EscapeOf(unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  if (byte == '\r') return "\\r";
  return {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

// At most `size` bytes of `text`, cut between two characters.
std::string_view Beginning(std::string_view text, std::size_t size) {
  if (text.size() <= size) return text;
  while (size > 0 && IsContinuation(static_cast<unsigned char>(text[size]))) --size;
  return text.substr(0, size);
}

std::string WithoutLongWords(const std::string& text) {
  std::string shortened;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    if (word.size() > kLongestWord) {
      shortened += std::string(Beginning(word, kWordKept)) + "...(" + std::to_string(word.size()) +
                   " bytes)";
    } else {
      shortened += word;
    }
    if (end < text.size()) shortened += ' ';
    begin = end + 1;
  }
  return shortened;
}

// Lower case, letters and digits only.
std::string Bare(std::string_view name) {
  std::string bare;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte)) bare += static_cast<char>(std::tolower(byte));
  }
  return bare;
}

// Least number of letters inserted, removed, replaced or swapped with their neighbour.
int EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        distance[i][j] = static_cast<int>(i + j);
        continue;
      }
      const int replaced = distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      distance[i][j] = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
      }
    }
  }
  return distance[a.size()][b.size()];
}

// What iconv calls the UTF-16 that `text` is in; "" if it is in none. Without a mark, text that
// begins with ASCII characters has every other byte 0.
std::string Utf16Name(std::string_view text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return "UTF-16";
  if (text.size() < 4) return "";
  const auto is_zero = [&](std::size_t i) { return text[i] == '\0'; };
  if (is_zero(0) == is_zero(1) || is_zero(0) != is_zero(2) || is_zero(1) != is_zero(3)) return "";
  return is_zero(1) ? "UTF-16LE" : "UTF-16BE";
}

}  // namespace

std::optional<std::size_t> FindInvalidUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = CharacterLength(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return std::nullopt;
}

std::size_t ControlLength(std::string_view text) {
  const auto begins = [&](std::string_view before, unsigned char first, unsigned char last) {
    if (text.size() <= before.size() || !text.starts_with(before)) return false;
    const auto byte = static_cast<unsigned char>(text[before.size()]);
    return first <= byte && byte <= last;
  };
  if (begins("", 0, 0x1f) || begins("", 0x7f, 0x7f)) return 1;
  if (begins("\xc2", 0x80, 0x9f) || begins("\xd8", 0x9c, 0x9c)) return 2;
  const bool is_mark = begins("\xe2\x80", 0x8e, 0x8f) || begins("\xe2\x80", 0xa8, 0xae) ||
                       begins("\xe2\x81", 0xa6, 0xa9);
  return is_mark ? 3 : 0;
}

bool HasControl(std::string_view text, std::string_view allowed) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (ControlLength(text.substr(at)) > 0 && allowed.find(text[at]) == allowed.npos) return true;
  }
  return false;
}

void RefuseUtf16(std::string_view text, const std::string& file) {
  const std::string name = Utf16Name(text);
  if (name.empty()) return;
  throw InputError(file + ": is UTF-16 text; it must be UTF-8: iconv -f " + name + " -t UTF-8 " +
                   file + " > " + file + ".utf8");
}

std::string Escaped(std::string_view text) {
  // So are almost all texts of messages, every one of which is looked at.
  const auto is_plain = [](char c) { return ' ' <= c && c <= '~'; };
  if (std::all_of(text.begin(), text.end(), is_plain)) return std::string(text);
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    const std::size_t length = CharacterLength(rest);
    const std::size_t escaped = length == 0 ? 1 : ControlLength(rest);
    for (const char c : rest.substr(0, escaped)) line += EscapeOf(static_cast<unsigned char>(c));
    if (escaped == 0) line += rest.substr(0, length);
    at += std::max(escaped, length);
  }
  return line;
}

std::string Abridged(std::string text, std::size_t most) {
  constexpr std::size_t kNote = 40;  // Room for it.
  if (text.size() <= most) return text;
  const std::string_view kept = Beginning(text, most - kNote);
  return std::string(kept) + "...(" + std::to_string(text.size() - kept.size()) + " bytes more)";
}

std::string Printable(std::string_view text) {
  const std::string line = WithoutLongWords(Escaped(text));
  return line.size() <= kLongestText ? line : std::string(Beginning(line, kLongestText)) + "...";
}

std::optional<std::string> FindNameFault(std::string_view name) {
  if (FindInvalidUtf8(name)) return "is no UTF-8 text";
  if (HasControl(name)) {
    return "must be one line without tabs and other control characters";
  }
  return std::nullopt;
}

std::string NearestName(std::string_view name, std::span<const std::string_view> known) {
  const std::string wanted = Bare(name);
  std::string nearest;
  int least = static_cast<int>(wanted.size()) / 3 + 1;
  for (const std::string_view candidate : known) {
    const int distance = EditDistance(wanted, Bare(candidate));
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  if (!nearest.empty() || wanted.size() < 3) return nearest;
  for (const std::string_view candidate : known) {
    const std::string bare = Bare(candidate);
    const bool begins = bare.starts_with(wanted) || (bare.size() > 2 && wanted.starts_with(bare));
    if (begins && (nearest.empty() || candidate.size() < nearest.size())) nearest = candidate;
  }
  return nearest;
}

}  // namespace planbench
