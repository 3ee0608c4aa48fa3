#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// The names of an enum whose values are 0, 1, ..., in the order of the values. Specialised beside
/// the enum, and nowhere else is a name or the number of values written:
///
///   template <>
///   struct EnumNames<Direction> {
///     static constexpr auto kNames = std::to_array<std::string_view>({"forward", "backward"});
///   };
template <typename Enum>
struct EnumNames;

/// Number of values.
template <typename Enum>
inline constexpr int kNumEnumValues = static_cast<int>(EnumNames<Enum>::kNames.size());

/// Throws std::out_of_range for what is no value of the enum.
template <typename Enum>
constexpr std::string_view EnumName(Enum value) {
  return EnumNames<Enum>::kNames.at(static_cast<std::size_t>(value));
}

/// Nothing for what is no name, letter for letter.
template <typename Enum>
constexpr std::optional<Enum> ParseEnum(std::string_view name) {
  for (int i = 0; i < kNumEnumValues<Enum>; ++i) {
    if (EnumNames<Enum>::kNames[static_cast<std::size_t>(i)] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

template <typename Enum>
std::vector<Enum> EnumValues() {
  std::vector<Enum> values;
  for (int i = 0; i < kNumEnumValues<Enum>; ++i) values.push_back(static_cast<Enum>(i));
  return values;
}

/// For messages: "spheres, voxels or meshes".
template <typename Enum>
std::string EnumChoices() {
  constexpr auto& kNames = EnumNames<Enum>::kNames;
  std::string text;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (i > 0) text += i + 1 < kNames.size() ? ", " : " or ";
    text += kNames[i];
  }
  return text;
}

}  // namespace planbench
