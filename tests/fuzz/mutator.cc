#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace planbench {
namespace {

constexpr std::size_t kMaxBytes = 1 << 16;

constexpr std::array<std::string_view, 34> kWords = {
    "0",      "-1",       "1e308",     "-1e308",     "1e-320",
    ".nan",   ".inf",     "nan",       "2147483648", "-9223372036854775809",
    "1e999",  "",         "~",         "null",       "[]",
    "{}",     "[[[[[[[[", "{{{{{{{{",  "*a",         "&a ",
    "<<: *a", "!!int ",   "!degrees ", "\t",         "\n",
    "\r\n",   ": ",       "- ",        "\"",         "'",
    "<",      "/>",       "&#0;",      "\xff\xfe"};

std::size_t Below(std::size_t bound, std::mt19937_64* random) {
  return bound == 0 ? 0 : static_cast<std::size_t>((*random)() % bound);
}

struct Piece {
  std::size_t begin, end;
};
Piece AnyPiece(const Bytes& bytes, std::mt19937_64* random) {
  const std::size_t begin = Below(bytes.size() + 1, random);
  const std::size_t longest = std::min<std::size_t>(bytes.size() - begin, 64);
  return {begin, begin + Below(longest + 1, random)};
}

// A number of a text, or the word there.
Piece AnyToken(const Bytes& bytes, std::mt19937_64* random) {
  const auto is_part = [](std::uint8_t byte) {
    return std::isalnum(byte) != 0 || byte == '.' || byte == '-' || byte == '_';
  };
  std::size_t at = Below(bytes.size() + 1, random);
  while (at < bytes.size() && !is_part(bytes[at])) ++at;
  Piece piece{at, at};
  while (piece.begin > 0 && is_part(bytes[piece.begin - 1])) --piece.begin;
  while (piece.end < bytes.size() && is_part(bytes[piece.end])) ++piece.end;
  return piece;
}

template <typename Text>
void Replace(Bytes* bytes, const Piece& piece, const Text& text) {
  const Bytes copy(text.begin(), text.end());  // It may be part of `bytes`.
  const auto at = [&](std::size_t i) { return bytes->begin() + static_cast<std::ptrdiff_t>(i); };
  bytes->erase(at(piece.begin), at(piece.end));
  bytes->insert(at(piece.begin), copy.begin(), copy.end());
}

void Change(Bytes* bytes, const std::vector<Bytes>& seeds, std::mt19937_64* random) {
  const auto word = [&] { return kWords[Below(kWords.size(), random)]; };
  switch (Below(8, random)) {
    case 0:
      if (!bytes->empty()) {
        (*bytes)[Below(bytes->size(), random)] ^= static_cast<std::uint8_t>(1u << Below(8, random));
      }
      break;
    case 1:
      if (!bytes->empty()) {
        constexpr std::array<std::uint8_t, 6> kExtremes = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
        (*bytes)[Below(bytes->size(), random)] = kExtremes[Below(kExtremes.size(), random)];
      }
      break;
    case 2:
      Replace(bytes, AnyPiece(*bytes, random), std::string_view());
      break;
    case 3: {
      const Piece piece = AnyPiece(*bytes, random);
      Replace(bytes, {piece.end, piece.end},
              std::span(*bytes).subspan(piece.begin, piece.end - piece.begin));
      break;
    }
    case 4: {
      const Bytes& other = seeds[Below(seeds.size(), random)];
      const Piece from = AnyPiece(other, random);
      Replace(bytes, AnyPiece(*bytes, random),
              std::span(other).subspan(from.begin, from.end - from.begin));
      break;
    }
    case 5:
      Replace(bytes, AnyToken(*bytes, random), word());
      break;
    case 6: {
      const std::size_t at = Below(bytes->size() + 1, random);
      Replace(bytes, {at, at}, word());
      break;
    }
    default:
      bytes->resize(Below(bytes->size() + 1, random));
  }
}

}  // namespace

Bytes Mutated(const std::vector<Bytes>& seeds, std::mt19937_64* random) {
  Bytes bytes = seeds[Below(seeds.size(), random)];
  const std::size_t num_changes = 1 + Below(6, random);
  for (std::size_t i = 0; i < num_changes; ++i) Change(&bytes, seeds, random);
  if (bytes.size() > kMaxBytes) bytes.resize(kMaxBytes);
  return bytes;
}

}  // namespace planbench
