#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/enum_names.h"
#include "common/utime.h"
#include "messaging/field_rules.h"
#include "messaging/fields.h"

namespace planbench {

/// The archive (fields.h) that fills an lcmt_ struct. Values that are not const are moved from.
/// Throws std::logic_error for lists that must be of one length and are not.
class Encoder {
 public:
  static constexpr bool kReads = false;

  void Utime(std::int64_t& wire) { wire = NowUtime(); }

  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char* /*name*/, Value& value, Wire& wire, Rule = {}) {
    Write(value, wire);
  }

  template <typename Values, typename Wire, typename Rule = rules::Anything>
  void List(const char* name, Values& values, std::vector<Wire>& wires, std::int32_t& count,
            Rule = {}) {
    if (values.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw std::logic_error(fmt::format("{} is too long for a message", name));
    }
    count = static_cast<std::int32_t>(values.size());
    if constexpr (std::is_same_v<std::remove_const_t<Values>, std::vector<Wire>>) {
      Write(values, wires);
    } else {
      wires.resize(values.size());
      auto wire = wires.begin();
      for (auto& value : values) Write(value, *wire++);
    }
  }

  template <typename Values, typename Wire, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, std::vector<Wire>& wires, std::int32_t& count,
              Rule = {}) {
    RequireSize(name, values.size(), count);
    List(name, values, wires, count);
  }

  template <typename Values, typename Wire>
  void Rows(const char* name, Values& rows, std::vector<Wire>& wires, std::int32_t& count,
            const std::int32_t& width) {
    for (const auto& row : rows) RequireSize(name, row.size(), width);
    List(name, rows, wires, count);
  }

  template <typename Value, typename Wire>
  void Optional(const char* /*name*/, Value& value, Wire& wire, const char* /*flag_name*/,
                std::int8_t& flag) {
    flag = value.has_value();
    if (value) Write(*value, wire);
  }

  template <typename... Args>
  void Require(bool /*ok*/, const char* /*name*/, const char* /*what*/, const Args&...) {}

 private:
  // The generated encoder reads as many elements as the counts say.
  static void RequireSize(const char* name, std::size_t size, std::int32_t expected) {
    if (size != static_cast<std::size_t>(expected)) {
      throw std::logic_error(fmt::format("{}: {} instead of {}", name, size, expected));
    }
  }

  template <typename Value, typename Wire>
  void Write(Value& value, Wire& wire) {
    using Plain = std::remove_const_t<Value>;
    if constexpr (HasFields<Plain>) {
      Fields<Plain>::List(*this, value, wire);
    } else if constexpr (std::is_array_v<Wire>) {
      std::copy(value.begin(), value.end(), wire);
    } else if constexpr (std::is_enum_v<Plain> && std::is_same_v<Wire, std::string>) {
      wire = EnumName(value);
    } else if constexpr (std::is_enum_v<Plain> || std::is_arithmetic_v<Plain>) {
      wire = static_cast<Wire>(value);
    } else if constexpr (requires { value.has_value(); }) {
      if (value) Write(*value, wire);
    } else if constexpr (std::is_const_v<Value>) {
      wire = value;
    } else {
      wire = std::move(value);
    }
  }
};

}  // namespace planbench
