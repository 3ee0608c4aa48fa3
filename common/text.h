#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace planbench {

/// Offset of the first byte that cannot be UTF-8; nothing if all can.
std::optional<std::size_t> FindInvalidUtf8(std::string_view text);

/// Bytes of the control character that `text` begins with, 0 if it begins with another. Beside
/// those that move a terminal's cursor these are Unicode's that end a line or turn the direction of
/// what is written: a name that holds them looks like another.
std::size_t ControlLength(std::string_view text);
/// Whether a control character is in `text` that is not one of the bytes of `allowed`.
bool HasControl(std::string_view text, std::string_view allowed = "");

/// Refuses UTF-16, with or without a byte order mark: InputError that names `file` and how to
/// convert it.
void RefuseUtf16(std::string_view text, const std::string& file);

/// `text` with control characters and bytes that are no UTF-8 escaped, byte by byte (\n, \x1b).
std::string Escaped(std::string_view text);

/// `text` if it is of `most` bytes (100 at least) or fewer, else its beginning, cut between two
/// characters, and how many bytes are left out, which are no more than `most` either.
std::string Abridged(std::string text, std::size_t most);

/// What Printable leaves of a text: bytes between spaces, and in all.
inline constexpr std::size_t kLongestWord = 200;
inline constexpr std::size_t kLongestText = 1000;

/// `text` as it may be printed in one line: Escaped, what runs on for longer than kLongestWord
/// shortened, all cut at kLongestText.
std::string Printable(std::string_view text);

/// Why messages cannot carry `name` as it is ("must be one line without tabs"), nothing if they
/// can.
std::optional<std::string> FindNameFault(std::string_view name);

/// The known name that `name` was probably meant to be: equal but for case and punctuation, a few
/// letters off, or the beginning of the other. Empty if none is near.
std::string NearestName(std::string_view name, std::span<const std::string_view> known);

}  // namespace planbench
