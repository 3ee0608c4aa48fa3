#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/enum_names.h"
#include "messaging/field_rules.h"
#include "messaging/fields.h"

namespace planbench {

/// The archive (fields.h) that writes an lcmt_ struct as text, as it came: one field a line,
/// `name: value`, structs indented under their name, numbers exactly, texts in quotes with control
/// characters escaped.
class Printer {
 public:
  static constexpr bool kReads = false;

  const std::string& text() const { return text_; }

  void Utime(const std::int64_t& wire) { Line("utime", fmt::format("{}", wire)); }

  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char* name, Value& value, const Wire& wire, Rule = {}) {
    if constexpr (HasFields<Value>) {
      Struct(name, value, wire);
    } else if constexpr (std::is_array_v<Wire>) {
      Line(name, TextOfAll(wire));
    } else if constexpr (std::is_enum_v<std::remove_const_t<Value>> && std::is_integral_v<Wire>) {
      using Enum = std::remove_const_t<Value>;
      const bool named = wire >= 0 && wire < kNumEnumValues<Enum>;
      Line(name, named ? std::string(EnumName(static_cast<Enum>(wire))) : TextOf(wire));
    } else {
      Line(name, TextOf(wire));
    }
  }

  template <typename Values, typename Wire, typename Rule = rules::Anything>
  void List(const char* name, Values& /*values*/, const std::vector<Wire>& wires,
            const std::int32_t& /*count*/, Rule = {}) {
    if constexpr (HasFields<ElementOf<Values>>) {
      for (std::size_t i = 0; i < wires.size(); ++i) {
        ElementOf<Values> value;
        Struct(fmt::format("{}[{}]", name, i), value, wires[i]);
      }
    } else {
      Line(name, TextOfAll(wires));
    }
  }

  template <typename Values, typename Wire, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, const std::vector<Wire>& wires,
              const std::int32_t& count, Rule = {}) {
    List(name, values, wires, count);
  }

  template <typename Values, typename Wire>
  void Rows(const char* name, Values& /*rows*/, const std::vector<Wire>& wires,
            const std::int32_t& /*count*/, const std::int32_t& /*width*/) {
    for (std::size_t i = 0; i < wires.size(); ++i) {
      Line(fmt::format("{}[{}]", name, i), TextOfAll(wires[i]));
    }
  }

  template <typename Value, typename Wire>
  void Optional(const char* name, Value& /*value*/, const Wire& wire, const char* /*flag_name*/,
                const std::int8_t& flag) {
    typename std::remove_const_t<Value>::value_type value;
    if (flag != 0) Struct(name, value, wire);
  }

  template <typename... Args>
  void Require(bool /*ok*/, const char* /*name*/, const char* /*what*/, const Args&...) {}

 private:
  static std::string TextOf(const std::string& text);
  template <typename Number>
  static std::string TextOf(const Number& number) {
    if constexpr (sizeof(Number) == 1)
      return fmt::format("{}", static_cast<int>(number));
    else
      return fmt::format("{}", number);
  }
  template <typename Values>
  static std::string TextOfAll(const Values& values) {
    std::vector<std::string> texts;
    for (const auto& value : values) texts.push_back(TextOf(value));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }

  void Line(std::string_view name, const std::string& text) {
    text_ += fmt::format("{:{}}{}: {}\n", "", 2 * depth_, name, text);
  }
  template <typename Value, typename Wire>
  void Struct(std::string_view name, Value& value, const Wire& wire) {
    text_ += fmt::format("{:{}}{}:\n", "", 2 * depth_, name);
    ++depth_;
    Fields<std::remove_const_t<Value>>::List(*this, value, wire);
    --depth_;
  }

  std::string text_;
  int depth_ = 0;
};

}  // namespace planbench
