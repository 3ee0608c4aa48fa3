#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/error.h"
#include "messaging/channels.h"

/// What the value of a field may be, beyond what its type says. A rule of a value has Ok(value) and
/// What(value), which says what is wrong; it holds for every element of a list. A rule of a list
/// has FindFault(list).
namespace planbench::rules {

struct Anything {
  template <typename Value>
  static bool Ok(const Value&) {
    return true;
  }
  template <typename Value>
  static std::string What(const Value&) {
    return "";
  }
};

/// What every number must be that no other rule is given for.
struct Finite {
  static bool Ok(double value) { return std::isfinite(value); }
  static std::string What(double value) { return fmt::format("{} is not a finite number", value); }
};

struct NonNegative {
  static bool Ok(double value) { return std::isfinite(value) && value >= 0; }
  static std::string What(double value) {
    return Finite::Ok(value) ? fmt::format("{} is negative", value) : Finite::What(value);
  }
};

/// A duration: no run lasts 30 years.
struct Seconds {
  static constexpr double kMost = 1e9;
  static bool Ok(double value) { return NonNegative::Ok(value) && value <= kMost; }
  static std::string What(double value) {
    return NonNegative::Ok(value) ? fmt::format("{} s is more than {}", value, kMost)
                                  : NonNegative::What(value);
  }
};

/// MiB of memory: no machine has a PiB.
struct Memory {
  static constexpr double kMost = 1e9;
  static bool Ok(double value) { return NonNegative::Ok(value) && value <= kMost; }
  static std::string What(double value) {
    return NonNegative::Ok(value) ? fmt::format("{} MiB is more than {}", value, kMost)
                                  : NonNegative::What(value);
  }
};

/// A proven bound of a cost over the optimum, which is never above it; 0: none.
struct Bound {
  static bool Ok(double value) { return std::isfinite(value) && (value == 0 || value >= 1); }
  static std::string What(double value) {
    return Finite::Ok(value) ? fmt::format("{} is no bound: 0 (none) or at least 1", value)
                             : Finite::What(value);
  }
};

/// A number of things.
struct Count {
  static bool Ok(double value) { return NonNegative::Ok(value) && std::floor(value) == value; }
  static std::string What(double value) {
    return NonNegative::Ok(value) ? fmt::format("{} is no whole number", value)
                                  : NonNegative::What(value);
  }
};

struct Positive {
  static bool Ok(double value) { return std::isfinite(value) && value > 0; }
  static std::string What(double value) {
    return Finite::Ok(value) ? fmt::format("{} is not greater than 0", value) : Finite::What(value);
  }
};

struct Fraction {
  static bool Ok(double value) { return value >= 0 && value <= 1; }
  static std::string What(double value) { return fmt::format("{} is not in [0, 1]", value); }
};

/// Finite, or infinite where there is nothing to measure the distance to.
struct Distance {
  static bool Ok(double value) {
    return std::isfinite(value) || value == std::numeric_limits<double>::infinity();
  }
  static std::string What(double value) { return Finite::What(value); }
};

template <std::int64_t kMinimum>
struct AtLeast {
  static bool Ok(std::int64_t value) { return value >= kMinimum; }
  static std::string What(std::int64_t value) {
    return fmt::format("{} is less than {}", value, kMinimum);
  }
};

struct Boolean {
  static bool Ok(std::int8_t value) { return value == 0 || value == 1; }
  static std::string What(std::int8_t value) {
    return fmt::format("{} is no boolean", static_cast<int>(value));
  }
};

/// Bytes of a text. What is longer is nobody's name, setting or command, be it of a session that
/// was merged of a thousand, and would be in every record and on every page.
inline constexpr std::size_t kLongestField = 10'000'000;

/// Why something is so, for people to read: cut beyond so many bytes.
struct Reason : Anything {
  static constexpr std::size_t kMost = 4000;
};

struct NotEmpty {
  static bool Ok(const std::string& text) { return !text.empty(); }
  static std::string What(const std::string&) { return "is empty"; }
};

/// Not empty, unless the message stands inside another: a run's record holds a result also where
/// there was none.
struct Id : NotEmpty {};

struct NodeName {
  static bool Ok(const std::string& name) { return IsNodeName(name); }
  static std::string What(const std::string& name) {
    return fmt::format("'{}' cannot name a node: {}", name, kNodeNameRule);
  }
};

/// What is wrong with a list; no index: with all of it.
struct ListFault {
  std::optional<std::size_t> index;
  std::string what;
};

/// Texts, none of them empty, no two equal.
struct Names {
  template <typename List>
  static std::optional<ListFault> FindFault(const List& names) {
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!NotEmpty::Ok(names[i])) return ListFault{i, NotEmpty::What(names[i])};
      if (!seen.insert(names[i]).second) return ListFault{i, Twice(names[i])};
    }
    return std::nullopt;
  }
  static std::string Twice(const std::string& name) {
    return fmt::format("'{}' occurs twice", name);
  }
};

/// Numbers from 0 upwards, each greater than the one before.
struct Ascending {
  template <typename List>
  static std::optional<ListFault> FindFault(const List& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!AtLeast<0>::Ok(numbers[i])) return ListFault{i, AtLeast<0>::What(numbers[i])};
      if (i > 0 && numbers[i] <= numbers[i - 1]) {
        return ListFault{i, fmt::format("{} is not ascending", numbers[i])};
      }
    }
    return std::nullopt;
  }
};

/// The components of a vector of length 1.
struct UnitLength {
  static constexpr double kTolerance = 1e-6;
  template <typename List>
  static std::optional<ListFault> FindFault(const List& components) {
    double square = 0;
    for (const double component : components) square += component * component;
    if (std::abs(std::sqrt(square) - 1) <= kTolerance) return std::nullopt;
    return ListFault{std::nullopt, fmt::format("length {} instead of 1", std::sqrt(square))};
  }
};

template <typename Rule, typename List>
concept OfList = requires(const List& list) {
  Rule::FindFault(list);
};

// The rule where none is given.
template <typename Value>
using Default = std::conditional_t<std::is_floating_point_v<Value>, Finite, Anything>;

}  // namespace planbench::rules

namespace planbench {

inline constexpr rules::NonNegative kNonNegative;
inline constexpr rules::Seconds kSeconds;
inline constexpr rules::Memory kMemory;
inline constexpr rules::Bound kBound;
inline constexpr rules::Positive kPositive;
inline constexpr rules::Fraction kFraction;
inline constexpr rules::Distance kDistance;
template <std::int64_t kMinimum>
inline constexpr rules::AtLeast<kMinimum> kAtLeast;
inline constexpr rules::Boolean kBoolean;
inline constexpr rules::Reason kReason;
inline constexpr rules::NotEmpty kNotEmpty;
inline constexpr rules::Id kId;
inline constexpr rules::NodeName kNodeName;
inline constexpr rules::Names kNames;
inline constexpr rules::Ascending kAscending;
inline constexpr rules::UnitLength kUnitLength;

}  // namespace planbench
