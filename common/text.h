#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace planbench {

/// Offset of the first byte that cannot be UTF-8; nothing if all can.
std::optional<std::size_t> FindInvalidUtf8(std::string_view text);

/// Refuses UTF-16, with or without a byte order mark: InputError that names `file` and how to
/// convert it.
void RefuseUtf16(std::string_view text, const std::string& file);

/// What Printable leaves of a text: bytes between spaces, and in all.
inline constexpr std::size_t kLongestWord = 200;
inline constexpr std::size_t kLongestText = 1000;

/// `text` as it may be printed in one line: control characters and bytes that are no UTF-8 escaped
/// (\n, \x1b), what runs on for longer than kLongestWord shortened, all cut at kLongestText.
std::string Printable(std::string_view text);

/// Why messages cannot carry `name` as it is ("must be one line without tabs"), nothing if they
/// can.
std::optional<std::string> FindNameFault(std::string_view name);

/// The known name that `name` was probably meant to be: equal but for case and punctuation, a few
/// letters off, or the beginning of the other. Empty if none is near.
std::string NearestName(std::string_view name, std::span<const std::string_view> known);

}  // namespace planbench
