#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/enum_names.h"
#include "common/text.h"
#include "messaging/field_rules.h"
#include "messaging/fields.h"

namespace planbench {

/// The archive (fields.h) that checks an lcmt_ struct and fills a value from it; it moves lists and
/// texts out of the struct. Throws MessageError (codec.h) for the first field that breaks a rule.
/// In texts, which get printed and stored, control characters and what is no UTF-8 are escaped;
/// reasons are cut (rules::Reason), other texts refused if they are too long.
///
/// One Decoder stands for a message or for a struct inside it; a chain on the stack, from which the
/// place is read when something is wrong.
class Decoder {
 public:
  static constexpr bool kReads = true;

  /// For the message itself. `request_id` is for errors.
  Decoder(const std::string& channel, const std::string& request_id)
      : channel_(channel), request_id_(request_id) {}

  void Utime(const std::int64_t& /*wire*/) {}

  template <typename Value, typename Wire, typename Rule = rules::Default<Value>>
  void Field(const char* name, Value& value, Wire& wire, Rule = {}) {
    if constexpr (HasFields<Value>) {
      Decoder inside(*this, name, std::nullopt);
      Fields<Value>::List(inside, value, wire);
    } else if constexpr (std::is_array_v<Wire>) {
      Check<Rule>(name, wire);
      std::copy(std::begin(wire), std::end(wire), value.begin());
    } else {
      if constexpr (std::is_same_v<Wire, std::string>) TakeText<Rule>(name, {}, &wire);
      const bool waived = std::is_same_v<Rule, rules::Id> && parent_ != nullptr;
      if (!waived && !Rule::Ok(wire)) Fail(name, {}, Rule::What(wire));
      Read(name, value, wire);
    }
  }

  template <typename Values, typename Wire, typename Rule = rules::Default<Wire>>
  void List(const char* name, Values& values, std::vector<Wire>& wires,
            const std::int32_t& /*count*/, Rule = {}) {
    if constexpr (std::is_same_v<Values, std::vector<Wire>>) {
      if constexpr (std::is_same_v<Wire, std::string>) {
        for (std::size_t i = 0; i < wires.size(); ++i) TakeText<Rule>(name, {i}, &wires[i]);
      }
      Check<Rule>(name, wires);
      values = std::move(wires);
    } else {
      ReadStructs(name, values, wires);
    }
  }

  template <typename Values, typename Wire, typename Rule = rules::Default<Wire>>
  void Beside(const char* name, Values& values, std::vector<Wire>& wires, const std::int32_t& count,
              Rule rule = {}) {
    List(name, values, wires, count, rule);
  }

  template <typename Row>
  void Rows(const char* name, std::vector<Row>& rows, std::vector<Row>& wires,
            const std::int32_t& /*count*/, const std::int32_t& /*width*/) {
    for (std::size_t i = 0; i < wires.size(); ++i) {
      for (std::size_t j = 0; j < wires[i].size(); ++j) {
        const auto& number = wires[i][j];
        if (!rules::Finite::Ok(number)) Fail(name, {i, j}, rules::Finite::What(number));
      }
    }
    rows = std::move(wires);
  }

  template <typename Value, typename Wire>
  void Optional(const char* name, std::optional<Value>& value, Wire& wire, const char* flag_name,
                const std::int8_t& flag) {
    Decoder inside(*this, name, std::nullopt);
    bool is_set = false;
    inside.Field(flag_name, is_set, flag);
    if (is_set) Fields<Value>::List(inside, value.emplace(), wire);
  }

  template <typename... Args>
  void Require(bool ok, const char* name, fmt::format_string<Args...> what, Args&&... args) {
    if (!ok) Fail(name, {}, fmt::format(what, std::forward<Args>(args)...));
  }

  /// Throws MessageError "<channel>: path.to.name[3]: what".
  [[noreturn]] void Fail(const char* name, std::initializer_list<std::size_t> indices,
                         const std::string& what) const;

 private:
  Decoder(const Decoder& parent, const char* name, std::optional<std::size_t> index)
      : channel_(parent.channel_),
        request_id_(parent.request_id_),
        parent_(&parent),
        name_(name),
        index_(index) {}

  template <typename Rule>
  void TakeText(const char* name, std::initializer_list<std::size_t> indices,
                std::string* text) const {
    *text = Escaped(*text);
    if constexpr (std::is_same_v<Rule, rules::Reason>) {
      *text = Abridged(std::move(*text), rules::Reason::kMost);
    } else if (text->size() > rules::kLongestField) {
      Fail(name, indices,
           fmt::format("{} bytes; a text holds at most {}", text->size(), rules::kLongestField));
    }
  }

  template <typename Rule, typename Wires>
  void Check(const char* name, const Wires& wires) const {
    if constexpr (rules::OfList<Rule, Wires>) {
      Check<rules::Default<std::decay_t<decltype(*std::begin(wires))>>>(name, wires);
      if (const std::optional<rules::ListFault> fault = Rule::FindFault(wires)) {
        if (fault->index) Fail(name, {*fault->index}, fault->what);
        Fail(name, {}, fault->what);
      }
    } else {
      for (std::size_t i = 0; i < std::size(wires); ++i) {
        if (!Rule::Ok(wires[i])) Fail(name, {i}, Rule::What(wires[i]));
      }
    }
  }

  template <typename Value, typename Wire>
  void ReadStructs(const char* name, std::vector<Value>& values, std::vector<Wire>& wires) const {
    values.reserve(wires.size());
    std::set<std::string_view> keys;
    for (std::size_t i = 0; i < wires.size(); ++i) {
      Decoder inside(*this, name, i);
      Value& value = values.emplace_back();
      Fields<Value>::List(inside, value, wires[i]);
      if constexpr (HasKey<Value>) {
        const std::string& key = Fields<Value>::Key(value);
        if (!keys.insert(key).second) {
          inside.Fail(Fields<Value>::kKey, {}, rules::Names::Twice(key));
        }
      }
    }
  }

  template <typename Value, typename Wire>
  void ReadStructs(const char* name, std::map<std::string, Value>& values,
                   std::vector<Wire>& wires) const {
    using Entry = std::pair<std::string, Value>;
    for (std::size_t i = 0; i < wires.size(); ++i) {
      Decoder inside(*this, name, i);
      Entry entry;
      Fields<Entry>::List(inside, entry, wires[i]);
      const auto [place, is_new] = values.insert(std::move(entry));
      if (!is_new) inside.Fail(Fields<Entry>::kKey, {}, rules::Names::Twice(place->first));
    }
  }

  template <typename Value, typename Wire>
  void Read(const char* name, Value& value, Wire& wire) const {
    if constexpr (std::is_same_v<Value, bool>) {
      if (!rules::Boolean::Ok(wire)) Fail(name, {}, rules::Boolean::What(wire));
      value = wire != 0;
    } else if constexpr (std::is_enum_v<Value>) {
      value = ReadEnum<Value>(name, wire);
    } else if constexpr (requires { typename Value::value_type; } &&
                         std::is_same_v<Wire, std::string> && !std::is_same_v<Value, Wire>) {
      if (!wire.empty()) value = ReadEnum<typename Value::value_type>(name, wire);
    } else if constexpr (std::is_same_v<Value, std::optional<Wire>>) {
      if (wire != 0) value = wire;
    } else if constexpr (std::is_arithmetic_v<Value>) {
      value = static_cast<Value>(wire);
    } else {
      value = std::move(wire);
    }
  }

  template <typename Enum>
  Enum ReadEnum(const char* name, const std::string& text) const {
    const std::optional<Enum> value = ParseEnum<Enum>(text);
    if (!value) Fail(name, {}, "expected " + EnumChoices<Enum>() + ", found '" + text + "'");
    return *value;
  }
  template <typename Enum>
  Enum ReadEnum(const char* name, std::int8_t number) const {
    if (number < 0 || number >= kNumEnumValues<Enum>) {
      Fail(name, {}, "no such value: " + std::to_string(number));
    }
    return static_cast<Enum>(number);
  }

  std::string Path() const;

  const std::string& channel_;
  const std::string& request_id_;
  const Decoder* parent_ = nullptr;
  const char* name_ = nullptr;
  std::optional<std::size_t> index_;
};

}  // namespace planbench
